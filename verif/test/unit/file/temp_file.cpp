// SPDX-License-Identifier: Apache-2.0
// Files that get their names at the end, where the names have come to be something else meanwhile: what kage did not
// make stays, and is neither replaced nor removed.
#include "file/temp_file.hpp"

#include <sys/stat.h>

#include <fstream>
#include <functional>
#include <string>

#include "file/inputs.hpp"
#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/temp_directory.hpp"

namespace fs = std::filesystem;
using namespace kage;

namespace {

void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

std::string said(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& e) {
    return e.what();
  }
  return "done";
}

/// An intruder: it takes the output's name while a run is under way, and knows whether it is still there.
struct Intruder {
  const char* name;
  std::function<void(const fs::path&)> come;
  std::function<bool(const fs::path&)> is_there;
};

const Intruder kIntruders[] = {
    {"a folder with a file",
     [](const fs::path& p) {
       fs::create_directory(p);
       put(p / "mine", "mine");
     },
     [](const fs::path& p) { return read_file(p / "mine") == "mine"; }},
    {"an empty folder", [](const fs::path& p) { fs::create_directory(p); },
     [](const fs::path& p) { return fs::is_directory(p); }},
    {"a link to a file",
     [](const fs::path& p) {
       put(p.parent_path() / "else", "mine");
       fs::create_symlink("else", p);
     },
     [](const fs::path& p) { return fs::is_symlink(p) && read_file(p) == "mine"; }},
    {"a link to nowhere", [](const fs::path& p) { fs::create_symlink("nowhere", p); },
     [](const fs::path& p) { return fs::is_symlink(p); }},
    {"a pipe", [](const fs::path& p) { REQUIRE(mkfifo(p.c_str(), 0600) == 0); },
     [](const fs::path& p) { return fs::is_fifo(p); }},
};

}  // namespace

TEST_CASE("what takes an output's name during the run is not replaced, and the others are as they were") {
  for (const Intruder& intruder : kIntruders)
    for (const bool was_there : {false, true}) {
      CAPTURE(intruder.name, was_there);
      const test::TempDirectory folder;
      const fs::path first = folder.path() / "a.json";
      const fs::path second = folder.path() / "b.png";
      put(first, "old");
      if (was_there) put(second, "old");
      {
        TempFiles files;
        write_text(files, first.string(), "new");
        write_text(files, second.string(), "new");
        fs::remove(second);
        intruder.come(second);
        CHECK(said([&] { files.commit(); }) == second.string() + ": exists and is not a file");
      }
      CHECK(intruder.is_there(second));
      CHECK(read_file(first) == "old");
      CHECK_FALSE(fs::exists(folder.path() / "nowhere"));
    }
}

TEST_CASE("what takes the name of a file that is to go stays") {
  for (const Intruder& intruder : kIntruders) {
    CAPTURE(intruder.name);
    const test::TempDirectory folder;
    const fs::path old = folder.path() / "old.png";
    put(old, "old");
    {
      TempFiles files;
      files.remove(old);
      fs::remove(old);
      intruder.come(old);
      CHECK(said([&] { files.commit(); }) == old.string() + ": exists and is not a file");
    }
    CHECK(intruder.is_there(old));
  }
}

TEST_CASE("what takes the name of a file that is put back stays") {
  for (const Intruder& intruder : kIntruders)
    for (const bool was_there : {false, true}) {
      CAPTURE(intruder.name, was_there);
      const test::TempDirectory folder;
      const fs::path file = folder.path() / "a.json";
      if (was_there) put(file, "old");
      {
        TempFiles files;
        write_text(files, file.string(), "new");
        files.place();
        CHECK(read_file(file) == "new");
        fs::remove(file);
        intruder.come(file);
      }  // no settle(): what was there comes back, where its name is free
      CHECK(intruder.is_there(file));
    }
}

TEST_CASE("an output that is a link becomes the file that the link leads to, there or not") {
  const test::TempDirectory folder;
  fs::create_directory(folder.path() / "sub");
  fs::create_symlink("sub/a.json", folder.path() / "link");
  for (const char* text : {"first", "second"}) {
    TempFiles files;
    write_text(files, (folder.path() / "link").string(), text);
    files.commit();
    CHECK(fs::is_symlink(folder.path() / "link"));
    CHECK(read_file(folder.path() / "sub/a.json") == text);
  }
  fs::create_symlink("none/a.json", folder.path() / "far");
  const std::string far = (folder.path() / "far").string();
  CHECK(said([&] { TempFiles().add(far); }) == far + ": cannot be written: no such folder");
  CHECK(fs::is_symlink(far));
  fs::create_symlink("round", folder.path() / "round");
  const std::string round = (folder.path() / "round").string();
  CHECK(said([&] { TempFiles().add(round); }) == round + ": cannot be written: a link that leads nowhere");
}

TEST_CASE("no output replaces or removes an input, under whatever name, and whenever it came to be one") {
  const test::TempDirectory folder;
  const fs::path input = folder.path() / "scene.bin";
  const fs::path link = folder.path() / "link.png";
  const fs::path dots = folder.path() / "." / "scene.bin";
  put(input, "mine");
  fs::create_symlink("scene.bin", link);
  const auto refusal = [](const fs::path& name) { return name.string() + ": this output would overwrite an input"; };
  {
    TempFiles early;
    write_text(early, link.string(), "new");
    TempFiles going;
    going.remove(input);
    keep_input(dots);
    CHECK(said([&] { early.commit(); }) == refusal(link));
    CHECK(said([&] { going.commit(); }) == refusal(input));
  }
  for (const fs::path& name : {input, link, dots}) {
    CHECK(said([&] { TempFiles().add(name); }) == refusal(name));
    CHECK(said([&] { TempFiles().remove(name); }) == refusal(name));
  }
  CHECK(read_file(input) == "mine");
  keep_input(folder.path() / "none");  // no file, so an output may become it
  keep_input(folder.path());
  TempFiles files;
  write_text(files, (folder.path() / "none").string(), "new");
  files.commit();
  CHECK(read_file(folder.path() / "none") == "new");
}
