// SPDX-License-Identifier: Apache-2.0
#include "side_files.hpp"

#include <system_error>

#include "file/real_path.hpp"
#include "notes.hpp"

namespace kage::scene {

namespace fs = std::filesystem;

SideFiles::SideFiles(const fs::path& file, bool allow_outside)
    : folder_(file.has_parent_path() ? file.parent_path() : "."), allow_outside_(allow_outside) {
  std::error_code error;
  real_ = fs::canonical(folder_, error);
}

SideFiles::Found SideFiles::find(const fs::path& path) const {
  Found found;
  // Opening would end the name at its first zero byte, and so open another file than the one that was looked at.
  if (path.native().find('\0') != std::string::npos) return found;
  found.path = real_path(path);
  if (found.path.empty()) return found;
  std::error_code error;
  found.exists = fs::is_regular_file(found.path, error);
  found.refused = !allow_outside_ && !lies_in(found.path, real_);
  if (found.exists && !found.refused) files_.insert(found.path.string());
  return found;
}

SideFiles::Found SideFiles::find_named(const std::string& name) const { return find(folder_ / name); }

std::string SideFiles::refusal(const std::string& name) {
  return "'" + one_line(name, 120) + "' lies outside the file's folder; --allow-outside reads it";
}

}  // namespace kage::scene
