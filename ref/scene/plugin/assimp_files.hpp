// SPDX-License-Identifier: Apache-2.0
//
// All files that Assimp sees: the scene's own and those of its folder (side_files.hpp), to read.
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <string>

#include "scene/side_files.hpp"

namespace kage::scene::mesh_plugin {

class AssimpFiles : public Assimp::DefaultIOSystem {
 public:
  /// `path`: the scene's own file.
  AssimpFiles(std::string path, bool allow_outside);

  bool Exists(const char* file) const override;
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  bool CreateDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

  /// The first file that was asked for, exists and was refused, or "". Readers try names that they make up, so one that
  /// does not exist is no more than missing.
  [[nodiscard]] const std::string& refused() const { return refused_; }
  /// A texture, by the name that a material has for it.
  void note_texture(const std::string& name) const { side_files_.note_texture(name); }
  /// The files that were asked for and are there, and the textures.
  [[nodiscard]] std::vector<std::string> files() const { return side_files_.files(); }

 private:
  std::string found(const char* name) const;

  std::string path_;
  SideFiles side_files_;
  mutable std::string refused_;
};

}  // namespace kage::scene::mesh_plugin
