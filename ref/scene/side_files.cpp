// SPDX-License-Identifier: Apache-2.0
#include "side_files.hpp"

#include <algorithm>
#include <system_error>

#include "notes.hpp"

namespace kage::scene {
namespace {

namespace fs = std::filesystem;

/// Both without links and dots.
bool is_below(const fs::path& path, const fs::path& folder) {
  const auto differs = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return differs.first == folder.end();
}

}  // namespace

SideFiles::SideFiles(const fs::path& file, bool allow_outside)
    : folder_(file.has_parent_path() ? file.parent_path() : "."), allow_outside_(allow_outside) {
  std::error_code error;
  real_ = fs::canonical(folder_, error);
}

SideFiles::Found SideFiles::find(const fs::path& path) const {
  Found found;
  // Opening would end the name at its first zero byte, and so open another file than the one that was looked at.
  if (path.native().find('\0') != std::string::npos) return found;
  std::error_code error;
  found.path = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) return found;  // links that go round, or a folder that may not be read
  found.exists = fs::is_regular_file(found.path, error);
  found.refused = !allow_outside_ && (real_.empty() || !is_below(found.path, real_));
  return found;
}

SideFiles::Found SideFiles::find_named(const std::string& name) const { return find(folder_ / name); }

std::string SideFiles::refusal(const std::string& name) {
  return "'" + one_line(name, 120) + "' lies outside the file's folder; --allow-outside reads it";
}

}  // namespace kage::scene
