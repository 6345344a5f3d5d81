// SPDX-License-Identifier: Apache-2.0
//
// Uses of accessors in glTF, the types of numbers that each use may have, and the treatment of other types.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace kage::scene {

/// Use of an accessor's values.
enum class GltfUse : std::uint8_t {
  position,
  normal,
  color,
  joints,
  weights,
  indices,
  times,
  vectors,        ///< keys of translations and scales
  rotations,      ///< keys
  morph_weights,  ///< keys
  matrices,
};

/// A use's own facts.
struct GltfUseFacts {
  const char* name;   ///< as messages have it
  std::size_t least;  ///< components
  std::size_t most;
  bool of_vertices;  ///< only these may lie interleaved, by a bufferView's byteStride
};

const GltfUseFacts& facts_of(GltfUse use);

/// An accessor's componentType with its name, "5121 (unsigned byte)".
std::string type_name(int type);

/// How numbers of a type become values.
struct GltfReading {
  bool allowed = true;  ///< false: this use cannot have them
  bool normalized = false;
};

/// Sentences on accessors that are not as the format has them and are drawn all the same.
class GltfRemarks {
 public:
  /// How accessor `index`, of the given type, is read. `quantized`: the file uses KHR_mesh_quantization.
  GltfReading reading(std::uint64_t index, GltfUse use, int type, bool normalized, bool quantized);

  /// Something about a numbered thing: "accessors", POSITION, "is ...".
  void add(const char* what, std::uint64_t index, std::string of, std::string remark) {
    found_[{what, std::move(of), std::move(remark)}].insert(index);
  }
  /// A sentence about the file as a whole.
  void add(std::string sentence) { sentences_.push_back(std::move(sentence)); }

  void note(std::vector<std::string>& notes) const;

 private:
  using Key = std::tuple<std::string, std::string, std::string>;
  std::map<Key, std::set<std::uint64_t>> found_;
  std::vector<std::string> sentences_;
};

}  // namespace kage::scene
