// SPDX-License-Identifier: Apache-2.0
// The reports of shards, read again: a report that is spoilt, or is not of the others' run, is refused with its file
// and the cause.
#include "cosim/report/shards.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>

#include "cosim/session/session.hpp"
#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/fake_cores.hpp"
#include "test/support/temp_directory.hpp"

using namespace kage;
using namespace kage::cosim;
using report::Json;
using test::FakeCores;
using test::TempDirectory;
using Change = std::function<void(Json&)>;

namespace {

constexpr int kShards = 3;

/// The reports of a run of five frames in three shards; `wrong`: the frame that differs, of none if negative.
std::array<Json, kShards> reports(int wrong = -1) {
  std::array<Json, kShards> all;
  for (int i = 0; i < kShards; ++i) {
    Host host;
    FakeCores cores;
    cores.wrong = wrong;
    CosimOptions o;
    o.input = "courtyard";
    o.size = {32, 24};
    o.frames = 5;
    o.config = "full";
    o.threads = 1;
    o.no_divergence = true;
    o.shard = {.index = i + 1, .count = kShards, .given = true};
    TempFiles files;
    Session session(o, host, cores);
    session.compare();
    all[static_cast<std::size_t>(i)] = report::to_json(session.finish(files));
  }
  return all;
}

/// The refusal by read_shards() of these texts, as files 1.json, 2.json ...; empty if it takes them.
std::string said(const std::vector<std::string>& texts) {
  const TempDirectory dir;
  std::vector<std::string> files;
  for (const std::string& text : texts) files.push_back(dir.write(fmt::format("{}.json", files.size() + 1), text));
  try {
    (void)report::read_shards(files, [] {});
    return "";
  } catch (const Error& e) {
    std::string text = e.what();
    const std::string folder = dir.path().string() + "/";
    for (std::size_t at = 0; (at = text.find(folder)) != std::string::npos;) text.erase(at, folder.size());
    return text;
  }
}

/// The same with the first report changed.
std::string said_of(std::array<Json, kShards> j, const Change& change) {
  change(j[0]);
  return said({j[0].dump(), j[1].dump(), j[2].dump()});
}

}  // namespace

TEST_CASE("a spoilt report is refused, with its file and the place") {
  const std::array<Json, kShards> good = reports();
  REQUIRE(said_of(good, [](Json&) {}).empty());
  // Keys of a later kage are passed over.
  REQUIRE(said_of(good, [](Json& j) { j["later"] = j["stalled"]["later"] = {{"x", 1}}; }).empty());

  const std::string no_report = "1.json: no report of kage cosim: ";
  const std::string claims = "1.json: shard 1/3 of 5 frames cannot have the {} that it claims";
  const std::vector<std::pair<Change, std::string>> cases = {
      {[](Json& j) { j.clear(); }, "it names no schema"},
      {[](Json& j) { j["frames"] = -2; }, no_report + "frames is not what it should be"},
      {[](Json& j) { j["frames"] = 1; }, fmt::format(fmt::runtime(claims), 1)},
      {[](Json& j) { j["frames"] = 3; }, fmt::format(fmt::runtime(claims), 3)},
      {[](Json& j) { j["frame_seconds"] = {1}; }, fmt::format(fmt::runtime(claims), 2)},
      {[](Json& j) {
         j["frame_seconds"] = {"a", "b"};
       },
       "frame_seconds is not what it should be"},
      {[](Json& j) { j["total_frames"] = 1000000000; }, no_report + "total_frames is not what it should be"},
      {[](Json& j) { j["shard"]["index"] = 4; }, "index is not what it should be"},
      {[](Json& j) { j["shard"]["count"] = std::int64_t{1} << 40; }, "count is not what it should be"},
      {[](Json& j) { j["config"]["Z_BITS"] = 99; }, no_report + "config: Z_BITS is 99, legal are"},
      {[](Json& j) { j["config"]["Z_BITS"] = (std::int64_t{1} << 32) + 24; }, "Z_BITS is not what it should be"},
      {[](Json& j) { j["same"] = false; }, "first_difference is not what it should be"},
      {[](Json& j) { j["first_difference"] = Json::object(); }, "first_difference is not what it should be"},
      {[](Json& j) { j["stalled"] = Json::object(); }, "input_starved is missing (stalled/input_starved)"},
      {[](Json& j) { j["shard"].erase("count"); }, no_report + "count is missing (shard/count)"},
      {[](Json& j) { j["config"]["LATER"] = 1; }, "LATER is no parameter of this kage (config/LATER)"},
  };
  for (const auto& [change, text] : cases) {
    CAPTURE(text);
    CHECK_THAT(said_of(good, change),
               Catch::Matchers::StartsWith("1.json: ") && Catch::Matchers::ContainsSubstring(text));
  }
  CHECK(said({"[[[", good[1].dump()}).starts_with("1.json: line 1, column "));
  CHECK(said({"[1]"}).starts_with("1.json: no report of kage cosim"));
}

TEST_CASE("reports of different runs are refused") {
  const std::array<Json, kShards> good = reports();
  const std::vector<std::pair<Change, std::string>> cases = {
      {[](Json& j) { j["seed"] = 2; }, "2.json: its seed is not that of 1.json"},
      {[](Json& j) { j["width"] = 65; }, "2.json: its width is not that of 1.json"},
      {[](Json& j) { j["config"]["LANES"] = 4; }, "2.json: its config is not that of 1.json"},
      {[](Json& j) { j["scene"] = "x"; }, "2.json: its scene is not that of 1.json"},
      {[](Json& j) { j["options"]["idle"] = 1; }, "2.json: its option idle is 0, that of 1.json is 1"},
  };
  for (const auto& [change, text] : cases) CHECK(said_of(good, change) == text);
  CHECK(said({good[0].dump(), good[2].dump()}) == "shard 2/3 is missing");
  CHECK(said({good[1].dump()}) == "shard 1/3 is missing");
  CHECK(said({good[0].dump(), good[1].dump(), good[0].dump()}) == "3.json: shard 1/3 once more, as 1.json");
  Json other = good[0];
  other["shard"]["count"] = 4;
  CHECK(said({good[1].dump(), good[2].dump(), other.dump()}) == "3.json: one of 4 shards, 1.json one of 3");
  Json whole = good[0];
  whole["shard"] = nullptr;
  CHECK(said({whole.dump(), good[1].dump(), good[2].dump()}) ==
        "1.json: the report of all frames, not of a shard (--shard)");
}

TEST_CASE("a shard that ends with a difference has the frames up to it") {
  std::array<Json, kShards> j = reports(3);  // the second of shard 1
  REQUIRE(said({j[0].dump(), j[1].dump(), j[2].dump()}).empty());
  REQUIRE(j[0]["first_difference"]["frame"] == 3);
  j[0]["first_difference"]["frame"] = 4;
  CHECK(said({j[0].dump(), j[1].dump(), j[2].dump()}) ==
        "1.json: shard 1/3 of 5 frames cannot have the 2 that it claims");
}
