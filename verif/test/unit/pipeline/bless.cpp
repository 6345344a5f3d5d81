// SPDX-License-Identifier: Apache-2.0
// A folder of pictures made like another.
#include "kage/bless.hpp"

#include <fstream>
#include <limits>
#include <map>

#include "kage/diff.hpp"
#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/pictures.hpp"

namespace kage::verif {
namespace {

namespace fs = std::filesystem;
using What = BlessEntry::What;

void picture(const fs::path& path, int value) {
  fs::create_directories(path.parent_path());
  Image image(3, 2, 1);
  image.data[4] = static_cast<std::uint8_t>(value);
  save_image(path, image);
}

void text(const fs::path& path) { std::ofstream(path) << "text\n"; }

/// All files of a folder, hidden ones too, and what is in them.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) all[entry.path().lexically_relative(folder).string()] = bytes_of(entry.path());
  return all;
}

std::map<std::string, What> whats(const std::vector<BlessEntry>& plan) {
  std::map<std::string, What> all;
  for (const BlessEntry& entry : plan) all[entry.name] = entry.what;
  return all;
}

}  // namespace

TEST_CASE("blessing copies what is new or differs, and touches nothing else") {
  const TempFolder folder("bless");
  const fs::path fresh = folder.path / "fresh";
  const fs::path reference = folder.path / "reference";
  picture(fresh / "same.png", 1);
  picture(fresh / "changed.png", 2);
  picture(fresh / "sub/added.png", 3);
  picture(fresh / "broken.png", 4);
  picture(reference / "same.png", 1);
  std::ofstream(reference / "same.png", std::ios::app) << "trailing";  // other bytes, the same picture
  picture(reference / "changed.png", 1);
  picture(reference / "missing.png", 5);
  text(reference / "broken.png");
  text(reference / "README");
  const auto before = contents(reference);

  const auto plan = plan_bless(fresh, reference);
  CHECK(contents(reference) == before);
  CHECK(whats(plan) == std::map<std::string, What>{{"same.png", What::same},
                                                   {"changed.png", What::changed},
                                                   {"broken.png", What::changed},
                                                   {"sub/added.png", What::added},
                                                   {"README", What::missing},
                                                   {"missing.png", What::missing}});
  bless(fresh, reference, plan, false);
  auto expected = before;
  for (const char* name : {"changed.png", "broken.png", "sub/added.png"}) expected[name] = bytes_of(fresh / name);
  CHECK(contents(reference) == expected);
  // Now all but the missing one are the same, and there is nothing more to do.
  const auto again = plan_bless(fresh, reference);
  for (const BlessEntry& entry : again)
    CHECK(entry.what == (entry.name == "missing.png" || entry.name == "README" ? What::missing : What::same));
  bless(fresh, reference, again, true);
  expected.erase("missing.png");
  CHECK(contents(reference) == expected);
}

TEST_CASE("folders that hold each other and links in the reference are refused") {
  const TempFolder folder("bless");
  const fs::path outer = folder.path / "outer";
  const fs::path inner = outer / "inner";
  picture(outer / "a.png", 1);
  picture(inner / "a.png", 2);
  const auto before = contents(folder.path);
  CHECK_THROWS_WITH(plan_bless(outer, inner), Catch::Matchers::ContainsSubstring("lies in"));
  CHECK_THROWS_WITH(plan_bless(inner, outer), Catch::Matchers::ContainsSubstring("lies in"));
  CHECK_THROWS_WITH(plan_bless(inner, inner / "."), Catch::Matchers::ContainsSubstring("one folder"));
  // Two names of which one is the beginning of the other are apart.
  picture(folder.path / "outer2/a.png", 1);
  CHECK(whats(plan_bless(inner, folder.path / "outer2")) == std::map<std::string, What>{{"a.png", What::changed}});
  fs::create_symlink("../outer/a.png", folder.path / "outer2/b.png");
  CHECK_THROWS_WITH(plan_bless(inner, folder.path / "outer2"), Catch::Matchers::ContainsSubstring("b.png: is a link"));
  for (const auto& [name, bytes] : before) CHECK(bytes_of(folder.path / name) == bytes);
}

TEST_CASE("a NaN, a broken or no picture is never blessed, and nothing is changed then") {
  const TempFolder folder("bless");
  const fs::path fresh = folder.path / "fresh";
  const fs::path reference = folder.path / "reference";
  picture(fresh / "a.png", 2);
  picture(reference / "a.png", 1);
  const auto before = contents(reference);
  const auto refused = [&](const std::string& name) {
    CHECK_THROWS_WITH(plan_bless(fresh, reference), Catch::Matchers::ContainsSubstring(name));
    CHECK(contents(reference) == before);
  };
  write_floats(fresh / "z.exr", 2, 1, {1.0F, std::numeric_limits<float>::quiet_NaN()});
  refused("z.exr");
  text(fresh / "z.exr");
  refused("z.exr");
  fs::remove(fresh / "z.exr");
  fs::remove(fresh / "a.png");
  refused("fresh");

  // A copy that fails half-way: no picture of the reference has changed, and no folder is left.
  picture(fresh / "a.png", 2);
  picture(fresh / "sub/b.png", 2);
  const auto plan = plan_bless(fresh, reference);
  fs::remove(fresh / "sub/b.png");
  CHECK_THROWS_AS(bless(fresh, reference, plan, true), Error);
  CHECK(contents(reference) == before);
  CHECK_FALSE(fs::exists(reference / "sub"));
}

TEST_CASE("what fails when some files have their names already puts all back") {
  const TempFolder folder("bless");
  const fs::path fresh = folder.path / "fresh";
  const fs::path reference = folder.path / "reference";
  picture(fresh / "a.png", 2);
  picture(fresh / "new/n.png", 2);
  picture(fresh / "z.png", 2);
  picture(reference / "a.png", 1);
  picture(reference / "old.png", 1);
  picture(reference / "z.png", 1);
  const auto before = contents(reference);
  auto plan = plan_bless(fresh, reference);
  std::map<std::string, std::string> seen;
  const auto stop = [&] {
    seen = contents(reference);
    throw Error("stop");
  };
  CHECK_THROWS_WITH(bless(fresh, reference, plan, true, stop), "stop");
  CHECK(seen.at("a.png") == bytes_of(fresh / "a.png"));
  CHECK(seen.count("new/n.png") == 1);
  CHECK(seen.count("old.png") == 0);
  CHECK(contents(reference) == before);
  CHECK_FALSE(fs::exists(reference / "new"));
  // The last of them cannot be removed, as it is gone.
  plan.push_back({"gone.png", What::missing, ""});
  CHECK_THROWS_WITH(bless(fresh, reference, plan, true), Catch::Matchers::ContainsSubstring("gone.png"));
  CHECK(contents(reference) == before);
  CHECK_FALSE(fs::exists(reference / "new"));
  plan.pop_back();
  bless(fresh, reference, plan, true);
  CHECK(contents(reference) == contents(fresh));
}

}  // namespace kage::verif
