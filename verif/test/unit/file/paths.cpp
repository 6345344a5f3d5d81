// SPDX-License-Identifier: Apache-2.0
#include "kage/paths.hpp"

#include <cstdlib>

#include "file/extension.hpp"
#include "test/support/catch.hpp"

TEST_CASE("the data folder is the source tree in a build, and what KAGE_DATA_DIR says when that is set") {
  unsetenv("KAGE_DATA_DIR");
  CHECK(std::filesystem::exists(kage::data_directory() / "rtl/defs/kage.yaml"));
  setenv("KAGE_DATA_DIR", "/some/where", 1);
  CHECK(kage::data_directory() == "/some/where");
  unsetenv("KAGE_DATA_DIR");
}

TEST_CASE("an extension is compared in lower case, whatever else is in it") {
  CHECK(kage::lower_extension("a.b/c.PnG") == ".png");
  CHECK(kage::lower_extension("A.B/C").empty());
  CHECK(kage::lower_extension(".HIDDEN").empty());
  CHECK(kage::lower_extension("x.\xC3\x89G") == ".\xC3\x89g");
}
