// SPDX-License-Identifier: Apache-2.0
// $KAGE_SHARD: the parts of a list are all of it, each element once unless there are more parts than elements. Anything
// else than I/N is refused.
#include "stimulus/shard.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "test/support/catch.hpp"

using kage::verif::Shard;
using kage::verif::test_shard;

TEST_CASE("each element of a list is in one part, and parts are of a size") {
  for (std::size_t count = 0; count <= 45; ++count)
    for (unsigned of = 1; of <= 20; ++of) {
      std::size_t all = 0;
      std::size_t most = 0;
      std::size_t least = count;
      for (unsigned number = 1; number <= of; ++number) {
        std::size_t size = 0;
        for (std::size_t i = 0; i < count; ++i) size += Shard{number, of}.has(i, count) ? 1 : 0;
        all += size, most = std::max(most, size), least = std::min(least, size);
      }
      CAPTURE(count, of);
      REQUIRE(all == (count == 0 ? 0 : std::max<std::size_t>(count, of)));
      REQUIRE(most - least <= 1);
      REQUIRE((count == 0 || least >= 1));
      for (std::size_t i = 0; i < count; ++i) {
        int parts = 0;
        for (unsigned number = 1; number <= of; ++number) parts += Shard{number, of}.has(i, count) ? 1 : 0;
        REQUIRE((count < of ? parts >= 1 : parts == 1));
      }
    }
}

TEST_CASE("KAGE_SHARD is I/N, or it is refused by name") {
  const auto of = [](const char* value) {
    ::setenv("KAGE_SHARD", value, 1);
    return test_shard();
  };
  CHECK(of("3/20").number == 3);
  CHECK(of("3/20").of == 20);
  CHECK(of("1/1").has(0, 1));
  for (const std::string bad : {"", "3", "3/", "/3", "0/3", "4/3", "1/0", "1/3x", "a/b", "-1/3", "1/3/5"}) {
    CAPTURE(bad);
    CHECK_THROWS_WITH(of(bad.c_str()), "KAGE_SHARD=" + bad + ": not I/N with I from 1 to N");
  }
  ::unsetenv("KAGE_SHARD");
  CHECK(test_shard().of == 1);
}
