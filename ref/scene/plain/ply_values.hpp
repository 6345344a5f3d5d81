// SPDX-License-Identifier: Apache-2.0
// The values of a PLY file behind its header, one after the other, in any of the three forms.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "scene/plain/ply_header.hpp"

namespace kage::scene {

class PlyValues {
 public:
  /// Reads the file whose header `lines`, which must stay, has just read.
  PlyValues(TextLines& lines, PlyHeader::Form form);

  /// Goes to an element, the `number`-th of its kind; in text, to the next line that is not blank. Throws Error where
  /// the file ends.
  void begin(const PlyElement& element, std::uint64_t number);

  /// The next value of the element: a whole number for a whole type, within its range. Throws Error where it is none or
  /// is not there.
  double value(PlyType type);
  /// The same, finite.
  double finite(PlyType type);
  /// The length of a list whose values have the given type; the file has room for all of them.
  std::uint64_t length(PlyType type, PlyType of_values);

  /// In text, throws Error where the line has more.
  void end() const;

  /// Whether anything but blanks and empty lines stands behind the last element.
  bool has_more();

  /// Throws Error with the line, or in a binary file with the element.
  [[noreturn]] void fail(const std::string& cause) const;

  /// Throws Error where a binary file is too short for all elements of a kind.
  void check_room(const PlyElement& element) const;

 private:
  double text_value(PlyType type);
  double binary_value(PlyType type);

  TextLines& lines_;
  PlyHeader::Form form_;
  std::string_view left_;  // of the line, or of a binary file
  const PlyElement* element_ = nullptr;
  std::uint64_t number_ = 0;
};

}  // namespace kage::scene
