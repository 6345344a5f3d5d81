// SPDX-License-Identifier: Apache-2.0
// What a rule says of parameters.
#include "contract/config_text.hpp"

#include "test/support/catch.hpp"

using kage::names;

TEST_CASE("a parameter is found by its whole name, wherever it stands") {
  CHECK(names("DX_BITS <= X_BITS", "X_BITS"));
  CHECK(names("DX_BITS <= X_BITS", "DX_BITS"));
  CHECK(names("X_BITS >= DX_BITS", "X_BITS"));
  CHECK_FALSE(names("DX_BITS <= 9", "X_BITS"));
  CHECK_FALSE(names("X_BITS_MORE == 1 || DX_BITS", "X_BITS"));
  CHECK_FALSE(names("", "FSF"));
}
