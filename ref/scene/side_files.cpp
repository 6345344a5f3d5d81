// SPDX-License-Identifier: Apache-2.0
#include "side_files.hpp"

#include <algorithm>
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
  if (found.exists) files_.insert(found.path.string());
  return found;
}

SideFiles::Found SideFiles::find_named(const std::string& name) const { return find(folder_ / name); }

SideFiles::Found SideFiles::find_moved(const std::string& name) const {
  std::string plain = name;
  std::replace(plain.begin(), plain.end(), '\\', '/');
  const std::string last = plain.substr(plain.find_last_of('/') + 1);
  std::vector<std::string> tries{name, plain, last};
  if (name.starts_with('/')) tries = {last, name};
  for (const std::string& path : tries) {
    Found found = path.empty() ? Found{} : find_named(path);
    if (found.exists) return found;
  }
  return {};
}

// Options, of which some take numbers, cannot be told from a name with blanks: the longest end that is a file is meant.
// No name of a file is longer than kLongest, and a file of millions of words must not be looked for word by word.
void SideFiles::note_texture(std::string_view words) const {
  constexpr std::size_t kLongest = 4096;
  constexpr int kMostLookups = 20000;
  if (words.size() > kLongest) return;
  for (std::size_t at = 0; at != std::string_view::npos && texture_lookups_ < kMostLookups; ++texture_lookups_) {
    words.remove_prefix(at);
    if (find_moved(std::string(words)).exists) return;
    at = words.find_first_not_of(' ', words.find(' '));
  }
}

std::string SideFiles::refusal(const std::string& name) {
  return "'" + one_line(name, 120) + "' lies outside the file's folder; --allow-outside reads it";
}

}  // namespace kage::scene
