// SPDX-License-Identifier: Apache-2.0
// One program at a time has a lock, whether its file is removed meanwhile or not.
#include "cosim/model/lock.hpp"

#include <optional>

#include "test/support/catch.hpp"
#include "test/support/temp_directory.hpp"

using kage::cosim::Lock;

TEST_CASE("who waits for a lock whose file is removed waits for the one that has the name") {
  const kage::test::TempDirectory folder;
  const std::filesystem::path path = folder.path() / "a.lock";
  std::optional<Lock> first(path);
  REQUIRE(first->try_lock());
  Lock waiting(path);
  CHECK_FALSE(waiting.try_lock());
  std::filesystem::remove(path);  // by who has it
  first.reset();
  std::optional<Lock> next(path);
  REQUIRE(next->try_lock());
  CHECK_FALSE(waiting.try_lock());
  next.reset();
  CHECK(waiting.try_lock());
  Lock last(path);
  CHECK_FALSE(last.try_lock());
}

TEST_CASE("a lock whose file is removed and not made anew is taken by one") {
  const kage::test::TempDirectory folder;
  const std::filesystem::path path = folder.path() / "a.lock";
  Lock a(path);
  Lock b(path);
  std::filesystem::remove(path);
  CHECK(a.try_lock());
  CHECK_FALSE(b.try_lock());
}

TEST_CASE("a folder is locked, and one that is gone is an error") {
  const kage::test::TempDirectory folder;
  Lock a(folder.path(), O_RDONLY | O_DIRECTORY);
  CHECK(a.try_lock());
  Lock b(folder.path(), O_RDONLY | O_DIRECTORY);
  CHECK_FALSE(b.try_lock());
  const auto sub = folder.path() / "sub";
  std::filesystem::create_directory(sub);
  Lock c(sub, O_RDONLY | O_DIRECTORY);
  std::filesystem::remove(sub);
  CHECK_THROWS_AS(c.try_lock(), kage::Error);
}
