// SPDX-License-Identifier: Apache-2.0
// The materials that an OBJ file names: libraries (mtllib) and what is in them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "scene/plain/mtl_file.hpp"
#include "scene/side_files.hpp"

namespace kage::scene {

class ObjLibraries {
 public:
  /// `file`: the OBJ file. `name` is how messages call it.
  ObjLibraries(std::filesystem::path file, std::string name, bool allow_outside);

  /// Read what an mtllib statement names: one file, blanks in its name, or several. Throws Error where one is there and
  /// must not be read (side_files.hpp). One that is not there is looked for in the OBJ file's folder.
  void add(std::string_view names, std::vector<std::string>& notes);

  /// The material of a name, to be asked for once each, when all statements were read; nullptr if no library has it.
  /// The comment that may be in the name is tried as part of it and as none.
  const MtlMaterial* find(const std::string& name);

  /// Sentences on libraries that are not there, and materials that find() was asked for and did not find.
  void note_missing(std::vector<std::string>& notes) const;

  /// Takes the library of the OBJ file's own name where none that it names is there.
  void fall_back(std::vector<std::string>& notes);

  /// The libraries that are there, and the textures that they name.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  void read(const SideFiles::Found& file, std::vector<std::string>& notes);

  std::filesystem::path file_;
  std::string name_;
  SideFiles side_files_;
  MtlMaterials materials_;
  std::set<std::string> read_;        // paths of libraries
  std::vector<std::string> missing_;  // libraries, each once
  std::vector<std::string> unknown_;  // materials, each once
  std::string instead_;               // the library of the file's own name that was taken
};

}  // namespace kage::scene
