// SPDX-License-Identifier: Apache-2.0
#include "scene/plugin/assimp_files.hpp"

#include <cstring>
#include <utility>

namespace kage::scene::mesh_plugin {

AssimpFiles::AssimpFiles(std::string path, bool allow_outside)
    : path_(std::move(path)), side_files_(path_, allow_outside) {}

bool AssimpFiles::Exists(const char* file) const { return file == path_ || !found(file).empty(); }

Assimp::IOStream* AssimpFiles::Open(const char* file, const char* mode) {
  if (mode != nullptr && std::strchr(mode, 'r') == nullptr) return nullptr;
  if (file == path_) return DefaultIOSystem::Open(file, mode);
  const std::string other = found(file);
  return other.empty() ? nullptr : DefaultIOSystem::Open(other.c_str(), mode);
}

std::string AssimpFiles::found(const char* name) const {
  const SideFiles::Found file = side_files_.find(name);
  if (!file.exists) return {};
  if (!file.refused) return file.path.string();
  if (refused_.empty()) refused_ = name;
  return {};
}

}  // namespace kage::scene::mesh_plugin
