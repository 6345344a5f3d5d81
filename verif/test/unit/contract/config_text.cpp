// SPDX-License-Identifier: Apache-2.0
// Rules on parameters, and messages on a configuration's text.
#include "contract/config_text.hpp"

#include <algorithm>
#include <string>

#include "kage/error.hpp"
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

TEST_CASE("a message on a configuration is one printable line, whatever its text holds") {
  for (const char* text : {"\"A\\nB\": 1", "\"\\e[31m\": 1", "LANES: \"\\\x1b\"", "LANES: \"\\\x01\"",
                           "\"A\\nB\": {LANES: 1}", "{\"\\r\": 1, \"\\r\": 2}"}) {
    CAPTURE(text);
    std::string message;
    try {
      (void)kage::config_from_text(text, "c.yaml");
    } catch (const kage::Error& e) {
      message = e.what();
    }
    CHECK(message.starts_with("c.yaml: "));
    CHECK(std::none_of(message.begin(), message.end(), [](char c) { return c >= 0 && c < ' '; }));
  }
}
