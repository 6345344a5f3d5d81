// SPDX-License-Identifier: Apache-2.0
//
// All files that Assimp sees: the scene's own, if it is OBJ as plain_obj() has it, and those of its folder
// (side_files.hpp), to read.
#pragma once

#include <assimp/DefaultIOSystem.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/obj_text.hpp"
#include "scene/side_files.hpp"

namespace kage::scene::mesh_module {

class AssimpFiles : public Assimp::DefaultIOSystem {
 public:
  /// `path`: the scene's own file. `name` is how messages call it.
  AssimpFiles(std::string path, const std::string& name, bool allow_outside);

  bool Exists(const char* file) const override;
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  bool CreateDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

  /// The first file that was asked for, exists and was refused, or "". Readers try names that they make up, so one that
  /// does not exist is no more than missing.
  [[nodiscard]] const std::string& refused() const { return refused_; }

  /// What an OBJ file names and does not get: its material libraries that are not there, and of the names `drawn` those
  /// that it asks for and no library has.
  [[nodiscard]] std::vector<std::string> obj_notes(const std::set<std::string>& drawn) const;

 private:
  std::string found(const char* name) const;

  std::string path_;
  SideFiles side_files_;
  std::optional<ObjText> obj_;
  std::set<std::string> opened_;     // libraries of an OBJ file
  std::set<std::string> materials_;  // of these
  mutable std::string refused_;
};

}  // namespace kage::scene::mesh_module
