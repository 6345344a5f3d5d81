// SPDX-License-Identifier: Apache-2.0
//
// The mesh plugin: what needs Assimp. Only the child that reads a file opens it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "plugin/plugin.hpp"
#include "scene/raw.hpp"

namespace kage::scene {

struct MeshPlugin : PluginHead {
  static constexpr const char* kPlugin = "kage_meshes";
  static constexpr const char* kWhatFor = "files other than glTF 2.0, OBJ, PLY, STL and OFF are read with it";
  static std::size_t room() { return 0; }  // it starts no threads, and the child that opens it may end

  /// As import_assimp().
  RawScene (*read)(const std::filesystem::path& path, const std::string& name, bool allow_outside);
};

namespace mesh_plugin {
RawScene read(const std::filesystem::path& path, const std::string& name, bool allow_outside);
}  // namespace mesh_plugin

}  // namespace kage::scene
