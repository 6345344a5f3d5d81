// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string_view>

#include "kage/diff.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

namespace fs = std::filesystem;

// Our own list: what OpenImageIO reads depends on its version and its plug-ins, and a reference folder must not.
constexpr std::array<std::string_view, 19> kExtensions{".bmp", ".dpx", ".exr", ".gif",  ".hdr", ".jp2", ".jpeg",
                                                       ".jpg", ".pbm", ".pfm", ".pgm",  ".png", ".pnm", ".ppm",
                                                       ".sgi", ".tga", ".tif", ".tiff", ".webp"};

bool is_picture(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

/// Calls `found` with the name of each file in the folder and those in it.
template <typename Found>
void list(const fs::path& folder, Found found) {
  std::error_code ec;
  if (!fs::is_directory(folder, ec)) throw Error(fmt::format("{}: no such folder", folder.string()));
  fs::recursive_directory_iterator it(folder, ec);
  for (; !ec && it != fs::end(it); it.increment(ec)) {
    const fs::path& path = it->path();
    std::error_code ignored;
    const bool is_folder = it->is_directory(ignored);
    if (path.filename().string().front() == '.') {
      if (is_folder) it.disable_recursion_pending();
    } else if (!is_folder) {
      found(path.lexically_relative(folder).generic_string());
    } else if (it->is_symlink(ignored)) {
      throw Error(fmt::format("{}: a link to a folder is not followed", path.string()));
    }
  }
  if (ec) throw Error(fmt::format("{}: cannot be read: {}", folder.string(), ec.message()));
}

}  // namespace

FolderPair pair_folders(const fs::path& a, const fs::path& b) {
  std::map<std::string, FolderEntry> pictures;
  std::set<std::string> others;
  const auto gather = [&](const fs::path& folder, bool FolderEntry::*here) {
    list(folder, [&](const std::string& name) {
      if (!is_picture(name)) {
        others.insert(name);
        return;
      }
      FolderEntry& entry = pictures[name];
      entry.name = name;
      entry.*here = true;
    });
  };
  gather(a, &FolderEntry::in_a);
  gather(b, &FolderEntry::in_b);
  FolderPair pair;
  for (const auto& [name, entry] : pictures) pair.pictures.push_back(entry);
  pair.others.assign(others.begin(), others.end());
  return pair;
}

}  // namespace kage
