// SPDX-License-Identifier: Apache-2.0
#include "file/real_path.hpp"

#include "test/support/catch.hpp"
#include "test/support/temp_directory.hpp"

namespace fs = std::filesystem;
using kage::lies_in;
using kage::real_path;

TEST_CASE("all names of a file have one real path, and so has what does not exist yet") {
  const kage::test::TempDirectory folder;
  const fs::path root = fs::canonical(folder.path());
  (void)folder.write("file", "");
  fs::create_directory(root / "sub");
  fs::create_symlink("file", root / "link");
  fs::create_symlink("../sub", root / "sub" / "round");
  const fs::path file = root / "file";
  for (const char* name : {"file", "link", "./sub/../file", "sub/round/../file"}) CHECK(real_path(root / name) == file);
  CHECK(real_path(fs::relative(file)) == file);
  CHECK(real_path(root / "sub" / "round" / "new") == root / "sub" / "new");
  fs::create_symlink("new", root / "first");
  fs::create_symlink("../first", root / "sub" / "second");
  CHECK(real_path(root / "sub" / "second") == root / "new");
  CHECK(real_path("new") == fs::current_path() / "new");
}

TEST_CASE("links that go round have no real path, and nothing lies in them") {
  const kage::test::TempDirectory folder;
  fs::create_symlink("loop", folder.path() / "loop");
  CHECK(real_path(folder.path() / "loop").empty());
  CHECK_FALSE(lies_in("/a", real_path(folder.path() / "loop")));
}

TEST_CASE("a path lies in a folder by whole names of folders") {
  CHECK(lies_in("/a/b", "/a"));
  CHECK(lies_in("/a", "/a"));
  CHECK_FALSE(lies_in("/ab", "/a"));
  CHECK_FALSE(lies_in("/a", "/a/b"));
}
