// SPDX-License-Identifier: Apache-2.0
#include "scene/module/assimp_files.hpp"

#include <assimp/MemoryIOWrapper.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "file/extension.hpp"
#include "scene/notes.hpp"

namespace kage::scene::mesh_module {
namespace {

constexpr std::size_t kNamed = 5;  // so many materials that are not there are named

}  // namespace

AssimpFiles::AssimpFiles(std::string path, const std::string& name, bool allow_outside)
    : path_(std::move(path)), side_files_(path_, allow_outside) {
  if (lower_extension(path_) != ".obj") return;
  std::ifstream in(path_, std::ios::binary);
  obj_ = plain_obj(in, name);
}

bool AssimpFiles::Exists(const char* file) const { return file == path_ || !found(file).empty(); }

Assimp::IOStream* AssimpFiles::Open(const char* file, const char* mode) {
  if (mode != nullptr && std::strchr(mode, 'r') == nullptr) return nullptr;
  if (file == path_ && obj_)
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(obj_->text.data()), obj_->text.size());
  if (file == path_) return DefaultIOSystem::Open(file, mode);
  const std::string other = found(file);
  if (other.empty()) return nullptr;
  if (obj_ && opened_.insert(other).second) {
    std::ifstream in(other, std::ios::binary);
    materials_.merge(material_names(in));
  }
  return DefaultIOSystem::Open(other.c_str(), mode);
}

std::vector<std::string> AssimpFiles::obj_notes(const std::set<std::string>& drawn) const {
  if (!obj_) return {};
  std::vector<std::string> notes;
  for (const std::string& library : obj_->libraries)
    if (!side_files_.find_named(library).exists)
      // Assimp then takes the file that has the scene's name, if there is one.
      notes.push_back(fmt::format(
          "no file {}: {}", one_line(library, 120),
          opened_.empty() ? "its materials are drawn grey"
                          : fmt::format("the materials are those of {}",
                                        one_line(std::filesystem::path(*opened_.begin()).filename().string(), 120))));
  if (!notes.empty() && opened_.empty()) return notes;  // so no material is there, and the notes say it
  std::vector<std::string> missing;
  std::set_difference(drawn.begin(), drawn.end(), materials_.begin(), materials_.end(), std::back_inserter(missing));
  std::erase_if(missing, [&](const std::string& name) { return obj_->materials.count(name) == 0; });
  if (missing.empty()) return notes;
  std::string names;
  for (std::size_t i = 0; i < std::min(missing.size(), kNamed); ++i)
    names += fmt::format("{}'{}'", i == 0 ? "" : ", ", one_line(missing[i], 60));
  if (missing.size() > kNamed) names += fmt::format(" and {} more", missing.size() - kNamed);
  notes.push_back(fmt::format("no material{} {}: drawn grey", missing.size() == 1 ? "" : "s", names));
  return notes;
}

std::string AssimpFiles::found(const char* name) const {
  const SideFiles::Found file = side_files_.find(name);
  if (!file.exists) return {};
  if (!file.refused) return file.path.string();
  if (refused_.empty()) refused_ = name;
  return {};
}

}  // namespace kage::scene::mesh_module
