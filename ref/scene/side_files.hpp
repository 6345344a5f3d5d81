// SPDX-License-Identifier: Apache-2.0
//
// Files that a scene's file names: glTF's buffers, an OBJ file's materials, what else Assimp opens, and textures, which
// are not read. A scene from elsewhere must not be able to read whatever lies on the disk, so what is read has to lie
// in the folder of the scene's file or below it, links followed.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace kage::scene {

class SideFiles {
 public:
  /// `file`: the scene's file. `allow_outside`: files may lie anywhere.
  SideFiles(const std::filesystem::path& file, bool allow_outside);

  struct Found {
    std::filesystem::path path;  ///< without links and dots, if the file exists
    bool exists = false;         ///< it is a regular file, or a link to one
    bool refused = false;        ///< it lies outside of the folder, or would if it existed, and that is not allowed
  };

  /// `path` is absolute or counts from the current folder.
  [[nodiscard]] Found find(const std::filesystem::path& path) const;

  /// `name` is as the scene's file has it, absolute or counted from that file's folder.
  [[nodiscard]] Found find_named(const std::string& name) const;

  /// The same, where the name may be that of another machine, with its folders and its way of parting them: then a file
  /// of the name's last part is meant that lies beside the scene's. An absolute name is looked for there first.
  [[nodiscard]] Found find_moved(const std::string& name) const;

  /// Textures are not read, but are the scene's: files() has the one that a statement names, behind options or not.
  void note_texture(std::string_view words) const;

  /// The files that were looked for and are there, each once, from the root.
  [[nodiscard]] std::vector<std::string> files() const { return {files_.begin(), files_.end()}; }

  /// Why a file is refused: the end of a message.
  static std::string refusal(const std::string& name);

 private:
  std::filesystem::path folder_;  // of the scene's file
  std::filesystem::path real_;    // the same without links and dots
  bool allow_outside_;
  mutable std::set<std::string> files_;
  mutable int texture_lookups_ = 0;
};

}  // namespace kage::scene
