// SPDX-License-Identifier: Apache-2.0
// glTF's first animation, as far as it moves nodes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "gltf_file.hpp"
#include "raw.hpp"

namespace kage::scene {

/// Refers to what it is made of.
class GltfAnimation {
 public:
  /// Channels that nothing is drawn of.
  struct Counts {
    std::size_t morphs = 0;    ///< of morph targets that the node's mesh does not have
    std::size_t blinking = 0;  ///< of visibility
    std::size_t pointed = 0;   ///< of what else KHR_animation_pointer reaches
    std::size_t unknown = 0;   ///< of no kind that is known
    std::size_t matrices = 0;  ///< nodes that have a matrix, which the animation replaces
  };
  using NodeNumbers = std::map<std::uint64_t, std::uint32_t>;  ///< file's node -> ours

  GltfAnimation(GltfFile& file, RawScene& scene) : file_(&file), scene_(&scene) {}

  /// Appends its tracks to the scene's.
  void read(const NodeNumbers& node_of);

  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  using Json = GltfJson::Json;

  void read_channel(const Json& animation, const Json& channel, const NodeNumbers& node_of, const std::string& place);
  bool is_drawn_path(const Json& target, const std::string& path, bool has_node, const std::string& place);

  GltfFile* file_;
  RawScene* scene_;
  Counts counts_;
  std::map<std::pair<std::uint64_t, std::string>, std::string> channel_of_;  // node of the file and path -> its place
};

}  // namespace kage::scene
