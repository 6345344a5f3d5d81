// SPDX-License-Identifier: Apache-2.0
#include "scene/module/assimp_files.hpp"

#include <assimp/MemoryIOWrapper.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <utility>

#include "kage/paths.hpp"
#include "scene/obj_text.hpp"

namespace kage::scene::mesh_module {

AssimpFiles::AssimpFiles(std::string path, const std::string& name, bool allow_outside)
    : path_(std::move(path)), side_files_(path_, allow_outside) {
  if (lower_extension(path_) != ".obj") return;
  std::ifstream in(path_, std::ios::binary);
  text_ = plain_obj(in, name);
}

bool AssimpFiles::Exists(const char* file) const { return file == path_ || !found(file).empty(); }

Assimp::IOStream* AssimpFiles::Open(const char* file, const char* mode) {
  if (mode != nullptr && std::strchr(mode, 'r') == nullptr) return nullptr;
  if (file == path_ && text_)
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_->data()), text_->size());
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

}  // namespace kage::scene::mesh_module
