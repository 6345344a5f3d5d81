// SPDX-License-Identifier: Apache-2.0
#include "kage/paths.hpp"

#include <cstdlib>

#include "catch.hpp"

TEST_CASE("the data folder is the source tree in a build, and what KAGE_DATA_DIR says when that is set") {
  unsetenv("KAGE_DATA_DIR");
  CHECK(std::filesystem::exists(kage::data_directory() / "rtl/defs/kage.yaml"));
  setenv("KAGE_DATA_DIR", "/some/where", 1);
  CHECK(kage::data_directory() == "/some/where");
  unsetenv("KAGE_DATA_DIR");
}
