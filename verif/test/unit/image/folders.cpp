// SPDX-License-Identifier: Apache-2.0
// Folders of pictures, matched by name.
#include "kage/diff.hpp"
#include "test/support/catch.hpp"
#include "test/support/pictures.hpp"

namespace kage::verif {
namespace {

namespace fs = std::filesystem;

/// A file whose name is all that matters.
void file(const fs::path& path) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << "text\n";
}

}  // namespace

TEST_CASE("pictures of two folders are matched by name, in subfolders too") {
  const TempFolder folder("image-folders");
  const fs::path a = folder.path / "a";
  const fs::path b = folder.path / "b";
  file(a / "both.png");
  file(b / "both.png");
  file(a / "sub/deep/left.PNG.png");
  file(b / "right.exr");
  file(b / ".hidden.png");
  file(b / ".git/x.png");
  file(a / "notes.txt");
  file(b / "report.json");
  const FolderPair pair = pair_folders(a, b);
  REQUIRE(pair.files.size() == 5);
  const auto is = [&](std::size_t i, const std::string& name, FolderEntry::Sort sort, bool in_a, bool in_b) {
    const FolderEntry& entry = pair.files[i];
    return entry.name == name && entry.sort == sort && entry.in_a == in_a && entry.in_b == in_b;
  };
  CHECK(is(0, "both.png", FolderEntry::Sort::picture, true, true));
  CHECK(is(1, "notes.txt", FolderEntry::Sort::other, true, false));
  CHECK(is(2, "report.json", FolderEntry::Sort::other, false, true));
  CHECK(is(3, "right.exr", FolderEntry::Sort::picture, false, true));
  CHECK(is(4, "sub/deep/left.PNG.png", FolderEntry::Sort::picture, true, false));
  CHECK(pair.left_out == std::vector<std::string>{".git/", ".hidden.png"});
  const FolderPair less = pair_folders(a, b, {"*.png", "sub/*", "note?.txt"});
  CHECK(less.files.size() == 2);
  CHECK(less.left_out ==
        std::vector<std::string>{".git/", ".hidden.png", "both.png", "notes.txt", "sub/deep/left.PNG.png"});
  CHECK_THROWS_WITH(pair_folders(a, folder.path / "none"), Catch::Matchers::ContainsSubstring("none"));
  fs::create_directory_symlink(a, b / "link");
  CHECK_THROWS_WITH(pair_folders(a, b), Catch::Matchers::ContainsSubstring("link"));
}

}  // namespace kage::verif
