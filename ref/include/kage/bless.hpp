// SPDX-License-Identifier: Apache-2.0

/// @file
/// Taking over new pictures and streams into a reference folder; docs/diff.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kage/diff.hpp"

namespace kage {

/// Outcome for a file of a reference folder.
struct BlessEntry {
  /// How the new file stands to the reference.
  enum class What : std::uint8_t {
    same,     ///< it stays
    changed,  ///< it is replaced
    added,    ///< it comes into the reference
    missing,  ///< the reference alone has it
  };
  std::string name;                                     ///< by '/' from the folder
  What what{};                                          ///< how the new file stands to it
  std::string reason;                                   ///< changed: how, in words
  FolderEntry::Sort sort = FolderEntry::Sort::picture;  ///< what it is

  /// A file that is neither picture nor stream always stays.
  /// @return whether the reference's file may be removed: the new folder lacks it, and it is a picture or a stream
  [[nodiscard]] bool prunable() const { return what == What::missing && sort != FolderEntry::Sort::other; }
};

/// Compares all files of a folder with those of a reference folder, exactly, and changes nothing. A reference that
/// cannot be read counts as changed. Throws Error if a file of `fresh` cannot be read or holds a NaN, if there is none,
/// if one folder lies in the other, or if what would be replaced is a link.
/// @param fresh the new files
/// @param reference the folder that they may go to
/// @param each is called before each file with its name; what it throws goes through
/// @param exclude as in pair_folders()
/// @return what becomes of each file of either folder, sorted by name
std::vector<BlessEntry> plan_bless(const std::filesystem::path& fresh, const std::filesystem::path& reference,
                                   const std::function<void(const std::string& name)>& each = {},
                                   const std::vector<std::string>& exclude = {});

/// Does what was planned: copies what is `changed` or `added` over, byte by byte. Files that are `same` are not
/// touched. All copies are written under other names before the first one gets its own. Where that fails half-way, or
/// `done` throws, all is put back as it was. Throws Error that names the file.
/// @param fresh the new files
/// @param reference the folder that they go to
/// @param plan what plan_bless() said of the two
/// @param prune removes what is prunable()
/// @param done is called once everything is in place
void bless(const std::filesystem::path& fresh, const std::filesystem::path& reference,
           const std::vector<BlessEntry>& plan, bool prune, const std::function<void()>& done = {});

}  // namespace kage
