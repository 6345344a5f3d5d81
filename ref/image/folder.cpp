// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>

#include "file/extension.hpp"
#include "file/plain_io.hpp"
#include "file/regular_file.hpp"
#include "kage/diff.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

namespace fs = std::filesystem;

// Our own list: what OpenImageIO reads depends on its version and its plug-ins, and a reference folder must not.
constexpr std::array<std::string_view, 19> kExtensions{".bmp", ".dpx", ".exr", ".gif",  ".hdr", ".jp2", ".jpeg",
                                                       ".jpg", ".pbm", ".pfm", ".pgm",  ".png", ".pnm", ".ppm",
                                                       ".sgi", ".tga", ".tif", ".tiff", ".webp"};

FolderEntry::Sort sort_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".kage") return FolderEntry::Sort::stream;
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end() ? FolderEntry::Sort::picture
                                                                                           : FolderEntry::Sort::other;
}

bool excluded(const std::string& name, const std::vector<std::string>& patterns) {
  const std::string last = fs::path(name).filename().string();
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), name.c_str(), 0) == 0 || fnmatch(pattern.c_str(), last.c_str(), 0) == 0;
  });
}

/// Calls `found` with the name of each file in the folder and those in it, `left_out` with those that are hidden.
template <typename Found, typename LeftOut>
void list(const fs::path& folder, Found found, LeftOut left_out) {
  std::error_code ec;
  if (!fs::is_directory(folder, ec)) throw Error(fmt::format("{}: no such folder", folder.string()));
  fs::recursive_directory_iterator it(folder, ec);
  for (; !ec && it != fs::end(it); it.increment(ec)) {
    const fs::path& path = it->path();
    std::error_code ignored;
    const bool is_folder = it->is_directory(ignored);
    if (path.filename().string().front() == '.') {
      left_out(path.lexically_relative(folder).generic_string() + (is_folder ? "/" : ""));
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

FolderPair pair_folders(const fs::path& a, const fs::path& b, const std::vector<std::string>& exclude) {
  std::map<std::string, FolderEntry> files;
  std::set<std::string> left_out;
  const auto gather = [&](const fs::path& folder, bool FolderEntry::*here) {
    const auto hidden = [&](const std::string& name) { left_out.insert(name); };
    const auto found = [&](const std::string& name) {
      if (excluded(name, exclude)) {
        left_out.insert(name);
        return;
      }
      FolderEntry& entry = files[name];
      entry.name = name;
      entry.sort = sort_of(name);
      entry.*here = true;
    };
    list(folder, found, hidden);
  };
  gather(a, &FolderEntry::in_a);
  gather(b, &FolderEntry::in_b);
  FolderPair pair;
  for (const auto& [name, entry] : files) pair.files.push_back(entry);
  pair.left_out.assign(left_out.begin(), left_out.end());
  return pair;
}

std::string diff_bytes(const fs::path& a, const fs::path& b) {
  check_regular(a);
  check_regular(b);
  const ReadOnly in_a(a);
  const ReadOnly in_b(b);
  std::vector<char> part_a(std::size_t{1} << 16);
  std::vector<char> part_b(part_a.size());
  // A piece is shorter than the others at the file's end alone.
  const auto read = [](const ReadOnly& in, std::vector<char>& part) {
    std::size_t size = 0;
    while (const std::size_t n = in.read(part.data() + size, part.size() - size)) size += n;
    return static_cast<std::ptrdiff_t>(size);
  };
  for (std::uint64_t at = 0;; at += part_a.size()) {
    const std::ptrdiff_t size_a = read(in_a, part_a);
    const std::ptrdiff_t size_b = read(in_b, part_b);
    const auto [stop, other] =
        std::mismatch(part_a.begin(), part_a.begin() + size_a, part_b.begin(), part_b.begin() + size_b);
    const auto same = static_cast<std::uint64_t>(stop - part_a.begin());
    if (stop - part_a.begin() != size_a && other - part_b.begin() != size_b)
      return fmt::format("byte {} differs", at + same);
    if (size_a != size_b) return fmt::format("{} ends at byte {}", size_a < size_b ? "A" : "B", at + same);
    if (size_a < static_cast<std::ptrdiff_t>(part_a.size())) return "";
  }
}

}  // namespace kage
