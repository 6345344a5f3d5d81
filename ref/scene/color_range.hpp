// SPDX-License-Identifier: Apache-2.0
// Whether a primitive's colours lie from 0 to 1, outside of which mesh.cpp clamps them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "raw.hpp"

namespace kage::scene {

class ColorRange {
 public:
  /// Looks at what is drawn: the material's colour, times those of the vertices where they have some.
  void add(const RawPrimitive& primitive);

  /// Sentences on primitives with colours outside, called `one` or `many`: "primitive has", "primitives have".
  void note(const char* one, const char* many, std::vector<std::string>& notes) const;

 private:
  std::size_t bright_ = 0;  // primitives with a channel above 1
  std::size_t dark_ = 0;    // below 0
};

}  // namespace kage::scene
