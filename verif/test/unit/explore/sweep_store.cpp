// SPDX-License-Identifier: Apache-2.0
// The store of a sweep: what is kept stays, whenever its program is killed; what is no store is refused and left alone.
#include "explore/sweep_store.hpp"

#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <string>

#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/pictures.hpp"

using namespace kage;
using namespace kage::explore;

namespace {

std::string refused(const std::filesystem::path& file) {
  try {
    const SweepStore store(file);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// Changes a store as another program would.
void run_sql(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* db = nullptr;
  REQUIRE(sqlite3_open(file.c_str(), &db) == SQLITE_OK);
  CHECK(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
  sqlite3_close(db);
}

const MadeOf kMade{.build = "build", .scene = "faces", .tools = "tools"};

/// A row that shows whether it is whole.
std::string row(int number) { return std::string(20000, static_cast<char>('a' + number % 26)); }

}  // namespace

TEST_CASE("what is kept is there when the store is opened again") {
  const verif::TempFolder folder("sweep-store");
  const auto file = folder.path / "a.sqlite";
  {
    SweepStore store(file);
    CHECK_FALSE(store.run("1"));
    store.keep_run("1", "courtyard", "point", kMade, "{}");
    store.keep_clocks("1", {.cycles = 1ULL << 40, .foretold = 3, .seconds = 0.5});
  }
  SweepStore store(file);
  CHECK(store.run("1") == "{}");
  CHECK(store.clocks("1")->cycles == 1ULL << 40);
  CHECK(store.clocks("1")->seconds == 0.5);
  CHECK_FALSE(store.clocks("2"));
  // Another store's rows; those that are here stay.
  {
    SweepStore other(folder.path / "b.sqlite");
    other.keep_run("1", "courtyard", "point", kMade, "another");
    other.keep_run("2", "courtyard", "point", kMade, "[]");
  }
  CHECK(store.absorb(folder.path / "b.sqlite") == 1);
  CHECK(store.run("1") == "{}");
  CHECK(store.run("2") == "[]");
  CHECK(store.runs() == 2);
  CHECK_THROWS_AS(store.absorb(folder.path / "none.sqlite"), Error);
}

TEST_CASE("a program that is killed loses at most the run under way") {
  const verif::TempFolder folder("sweep-killed");
  const auto file = folder.path / "a.sqlite";
  for (int round = 0; round < 8; ++round) {
    std::array<int, 2> told{};
    REQUIRE(pipe(told.data()) == 0);
    const pid_t child = fork();
    if (child == 0) {
      // The child says each number once its row is kept.
      SweepStore store(file);
      for (int n = 1000 * round;; ++n) {
        store.keep_run(std::to_string(n), "scene", "point", kMade, row(n));
        if (::write(told[1], &n, sizeof n) != sizeof n) _exit(1);
      }
    }
    int last = -1;
    for (int i = 0; i < 5 + 3 * round; ++i) REQUIRE(::read(told[0], &last, sizeof last) == sizeof last);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(told[1]);
    for (int n = 0; ::read(told[0], &n, sizeof n) == sizeof n;) last = n;
    close(told[0]);
    SweepStore store(file);
    for (int n = 1000 * round; n <= last; ++n) {
      CAPTURE(round, n);
      CHECK((store.run(std::to_string(n)) == row(n)));
    }
    const auto next = store.run(std::to_string(last + 1));
    CHECK((!next || *next == row(last + 1)));
    CHECK_FALSE(store.run(std::to_string(last + 2)));
  }
}

TEST_CASE("what is no store is refused, and left as it is") {
  using Catch::Matchers::ContainsSubstring;
  const verif::TempFolder folder("sweep-refused");
  const auto file = folder.path / "a.sqlite";
  {
    SweepStore store(file);
    for (int n = 0; n < 20; ++n) store.keep_run(std::to_string(n), "scene", "point", kMade, row(n));
  }
  const std::string good = read_file(file);
  REQUIRE(refused(file).empty());

  const auto check = [&](const std::string& bytes, const std::string& text) {
    write(file, bytes);
    CHECK_THAT(refused(file), ContainsSubstring(file.string() + ": ") && ContainsSubstring(text));
    CHECK((read_file(file) == bytes));
  };
  check(std::string(5000, 'x'), "no store of kage sweep: it is no SQLite file");
  std::string other = good;
  other[63] = 4;  // the version, in SQLite's header
  check(other, "a store of version 4, and this kage has 3");
  other = good;
  other[68] = 0;  // the application
  check(other, "no store of kage sweep, though an SQLite file");
  std::string damaged = good;
  for (std::size_t i = 4096; i < std::size_t{3} * 4096; ++i) damaged[i] = static_cast<char>(i * 7);
  check(damaged, "");
  CHECK_THAT(refused(file), !ContainsSubstring("***"));
  check(good.substr(0, good.size() / 2), "the store is damaged, so begin another: ");
  CHECK(refused(folder.path / "no/such/a.sqlite") == (folder.path / "no/such/a.sqlite: no such folder").string());
  CHECK(refused(folder.path) == folder.path.string() + ": a folder, and no store");
}

TEST_CASE("what SQLite cannot do is told in words of kage's own, in one line") {
  using Catch::Matchers::ContainsSubstring;
  const verif::TempFolder folder("sweep-causes");
  const auto file = folder.path / "a.sqlite";
  // Pages that no table has: quick_check puts a headline above what it found.
  {
    SweepStore store(file);
    for (int n = 0; n < 200; ++n) store.keep_run(std::to_string(n), "scene", "point", kMade, row(n));
  }
  run_sql(file, "DELETE FROM run");
  std::string bytes = read_file(file);
  for (std::size_t i = 36; i < 40; ++i) bytes[i] = 0;  // how many free pages there are
  for (std::size_t i = 32; i < 36; ++i) bytes[i] = 0;  // and the first
  write(file, bytes);
  const std::string found = refused(file);
  CHECK_THAT(found, ContainsSubstring(file.string() + ": the store is damaged, so begin another: ") &&
                        !ContainsSubstring("***") && !ContainsSubstring("\n"));
  // A store whose file is gone can no longer be written.
  std::filesystem::remove(file);
  SweepStore store(file);
  std::filesystem::remove(file);
  try {
    store.keep_run("1", "scene", "point", kMade, row(1));
    FAIL("it is written");
  } catch (const Error& e) {
    CHECK_THAT(e.what(),
               ContainsSubstring(file.string() + ": the store cannot be ") && ContainsSubstring(" (SQLite: "));
  }
}

TEST_CASE("a row that is not what was kept is told by file and row, by whoever reads it") {
  const verif::TempFolder folder("sweep-row");
  const auto file = folder.path / "a.sqlite";
  const ClockSample sample{.cycles = 12345678, .foretold = 3, .seconds = 0.5};
  // Whatever column changes, even to another of the right form: SQLite itself sees nothing.
  for (const std::string change :
       {"run SET row = '{\"a\":2}'", "run SET row = '{'", "run SET row = x'00'", "run SET scene = 'glass'",
        "run SET point = 'b'", "run SET build = 'b'", "run SET faces = 'b'", "run SET tools = 'b'", "run SET sum = 'b'",
        "clocks SET cycles = 12345679", "clocks SET foretold = 4", "clocks SET seconds = 0.25",
        "clocks SET seconds = 'x'", "clocks SET sum = ''"}) {
    CAPTURE(change);
    std::filesystem::remove(file);
    {
      SweepStore store(file);
      store.keep_run("cafe", "courtyard", "point", kMade, "{\"a\":1}");
      store.keep_clocks("cafe", sample);
    }
    run_sql(file, "UPDATE " + change);
    const std::string table = change.substr(0, change.find(' '));
    const std::string text = file.string() + ": the store is damaged, so begin another: table " + table + ", row cafe";
    SweepStore store(file);
    const auto said = [&](auto read) {
      try {
        read();
      } catch (const Error& e) {
        return std::string(e.what());
      }
      return std::string();
    };
    CHECK_THAT(said([&] { table == "run" ? (void)store.run("cafe") : (void)store.clocks("cafe"); }),
               Catch::Matchers::ContainsSubstring(text));
    SweepStore whole(folder.path / "whole.sqlite");
    CHECK_THAT(said([&] { whole.absorb(file); }), Catch::Matchers::ContainsSubstring(text));
    CHECK(whole.runs() == 0);
  }
}

TEST_CASE("a store with a view, a trigger or a table that kage does not make is refused, and ends") {
  const verif::TempFolder folder("sweep-schema");
  const auto file = folder.path / "a.sqlite";
  const std::string endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT ";
  for (const auto& [sql, text] : std::vector<std::pair<std::string, std::string>>{
           {"DROP TABLE run; CREATE VIEW run AS " + endless +
                "'k' AS key, 's' AS scene, 'p' AS point, '{}' AS row, 'b' AS build, 'f' AS faces, 't' AS tools, "
                "'' AS sum, '' AS made FROM n",
            "run is not the table that kage makes"},
           {"DROP TABLE clocks; CREATE VIEW clocks AS " + endless +
                "'k' AS key, i AS cycles, i AS foretold, 1.0 AS seconds, '' AS sum FROM n",
            "clocks is not the table that kage makes"},
           {"DROP TABLE clocks", "clocks is not the table that kage makes"},
           {"CREATE TRIGGER z AFTER INSERT ON run BEGIN DELETE FROM run; END", "it has z, which kage does not make"},
           {"CREATE TABLE z (a)", "it has z, which kage does not make"},
           {"CREATE TABLE \"z\n::error::\" (a)", "it has z?::error::, which kage does not make"}}) {
    CAPTURE(sql);
    std::filesystem::remove(file);
    { const SweepStore store(file); }
    run_sql(file, sql);
    CHECK_THAT(refused(file), Catch::Matchers::ContainsSubstring(text));
    SweepStore whole(folder.path / "whole.sqlite");
    CHECK_THROWS_AS(whole.absorb(file), Error);
  }
  std::filesystem::remove(file);
  {
    SweepStore store(file);
    store.keep_run("1", "courtyard", "point", kMade, "{}");
  }
  run_sql(file, "ANALYZE");
  CHECK(SweepStore(file).run("1") == "{}");
}

TEST_CASE("a file that rows are to be taken of is asked whether it is a store, and none is made of it") {
  const verif::TempFolder folder("sweep-check");
  const auto file = folder.path / "a.sqlite";
  const auto checked = [&] {
    try {
      SweepStore::check(file);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(checked() == file.string() + ": no such file");
  CHECK_FALSE(std::filesystem::exists(file));
  write(file, "");
  CHECK(checked() == file.string() + ": no store of kage sweep: it is empty");
  CHECK(std::filesystem::file_size(file) == 0);
  write(file, "text");
  CHECK(checked() == file.string() + ": no store of kage sweep: it is no SQLite file");
  std::filesystem::remove(file);
  { const SweepStore store(file); }
  CHECK(checked().empty());
}

TEST_CASE("a row that is of no use now says why, by what it has most in common") {
  const verif::TempFolder folder("sweep-store-old");
  SweepStore store(folder.path / "a.sqlite");
  CHECK(store.old("courtyard", "point", kMade).empty());
  store.keep_run("1", "courtyard", "point", {"earlier", "faces", "tools"}, "{}");
  CHECK(store.old("courtyard", "point", kMade) == "another build of kage");
  CHECK(store.old("courtyard", "another point", kMade).empty());
  CHECK(store.old("glass", "point", kMade).empty());
  store.keep_run("2", "courtyard", "point", {"build", "changed", "tools"}, "{}");
  CHECK(store.old("courtyard", "point", kMade) == "another scene of this name");
  store.keep_run("3", "courtyard", "point", {"build", "faces", "older"}, "{}");
  CHECK_THAT(store.old("courtyard", "point", kMade), Catch::Matchers::ContainsSubstring("other tools"));
  store.keep_run("4", "courtyard", "point", kMade, "{}");
  CHECK(store.old("courtyard", "point", kMade).empty());
}
