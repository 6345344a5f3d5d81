// SPDX-License-Identifier: Apache-2.0
// The record of a run: what it writes it reads again, bit by bit, and what is not of its form it names.
#include "cosim/report/run_record.hpp"

#include <cctype>
#include <string>

#include "kage/error.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using report::Json;

namespace {

report::DifferenceRecord some_difference(int frame) {
  report::DifferenceRecord d{.frame = frame,
                             .line = 3,
                             .x = std::nullopt,
                             .field = "red",
                             .expected = -7,
                             .actual = 12,
                             .assertion = "rtl/frame_control.sv:312",
                             .waveform = "out/x.fst",
                             .text = "frame 4, \"quoted\" <b>",
                             .searched = true,
                             .no_divergence = std::nullopt,
                             .divergence = std::nullopt};
  d.divergence = {.frame = frame,
                  .line = 3,
                  .x = 9,
                  .module = "pixel_banked",
                  .what = "state of a pixel",
                  .field = "z",
                  .expected = "1",
                  .actual = "2",
                  .cycle = 123456789012,
                  .token = 5,
                  .token_text = "SP [12, 40)",
                  .source = std::nullopt,
                  .waits = "a for b",
                  .save_file = "out/x.gtkw",
                  .initial_state = true,
                  .text = "frame 4, line 3"};
  return d;
}

report::SceneRecord some_scene(const std::string& name) {
  report::SceneRecord s;
  s.scene = name;
  s.same = false;
  s.frames = 2;
  s.total_frames = 9;
  s.first_frame = 1;
  s.frame_step = 3;
  s.shard = {2, 3};
  s.golden_seconds = 0.1 + 0.2;
  s.rtl_seconds = 1e-9;
  s.again = "kage cosim 'a b'";
  s.folder = "/x";
  s.rtl = "/y/rtl";
  s.versions = {"kage 0.1.0", "Verilator"};
  s.page = "out/report.html";
  s.page_crc32 = "00c0ffee";
  s.ways = {{.object = "gem", .component = 2, .components = 3, .unit_frames = 1, .span_frames = 1, .why = "no room"}};
  s.first_difference = some_difference(4);
  s.options = {.fault = "wrong_compare",
               .netlist = "ecp5",
               .front_end = "rtl",
               .idle = 20,
               .stages = true,
               .order = "exact",
               .alpha = 1.0 / 3,
               .samples = 4,
               .classes = 16,
               .max_shading = 5,
               .sub_bits = 6};
  s.config_name = "default";
  s.config.lanes = 4;
  s.seed = ~std::uint64_t{0};
  s.width = 64;
  s.height = 48;
  s.sizes_vary = true;
  s.own_sizes = true;
  s.pixels_compared = 6144;
  s.spans = 77;
  s.span_pixels = 777;
  s.segments = 7;
  s.units = 1;
  s.cycles = 99999;
  s.stalls = {5, 6};
  s.frame_seconds = {0.125, 1.0 / 7};
  report::FrameRecord f{.frame = 1, .taken = true, .cycles = 50000, .stalls = {3, 4}, .spans = 40, .words = 12};
  f.phase_stalls.front() = {1, 0};
  f.phase_stalls.back() = {2, 4};
  s.each = {f, f};
  s.each.back().frame = 4;
  s.each.back().same = false;
  s.verdicts = {.cached = true, .taken_frames = {1}, .kept = 1, .trouble = "no room"};
  s.build_seconds = 33.25;
  s.degraded = {"colours that vary"};
  s.pictures = {"out/a_0000.png"};
  s.kept = report::KeptRecord{.file = "out/f.kage",
                              .ahead = true,
                              .alone = true,
                              .takes = "time",
                              .in_place = true,
                              .lines = 1,
                              .tokens = 3,
                              .width = 2,
                              .words = 9,
                              .again = "x"};
  s.notes = {"a note"};
  s.coverage = report::CoverageRecord{.frames = 2, .points = {{"token", "OP", 1}, {"token", "SP", 0}}};
  return s;
}

/// The record of a shard that has no frame of this scene.
report::SceneRecord no_frames() {
  report::SceneRecord s;
  s.scene = "other";
  s.total_frames = 1;
  return s;
}

report::SceneRecord some_joined() {
  report::SceneRecord s = some_scene("courtyard");
  s.joined = true;
  s.shard.reset();
  s.frame_seconds = {0.5, std::nullopt, 0.25};
  s.coverage.reset();
  report::ShardRecord shard;
  static_cast<report::PartRecord&>(shard) = static_cast<const report::PartRecord&>(s);
  shard.number = {1, 2};
  shard.file = "1.json";
  s.shards = {shard, shard};
  s.shards[1].same = true;
  s.shards[1].first_difference.reset();
  return s;
}

/// JSON, read and written again, as text: order of keys and every digit.
void holds(const report::RunRecord& record, const std::string& schema) {
  const std::string text = to_json(record).dump(1);
  const report::RunRecord again = report::RunRecord::from_json(Json::parse(text));
  CHECK(to_json(again).dump(1) == text);
  CHECK(to_json(report::RunRecord::from_json(to_json(record))).dump(1) == text);  // numbers as C++ has them
  CHECK(Json::parse(text).begin().key() == "schema");
  CHECK(Json::parse(text)["schema"] == schema);
}

std::string refused(const Json& json) {
  try {
    (void)report::RunRecord::from_json(json);
  } catch (const Error& e) {
    return e.what();
  }
  return "taken";
}

}  // namespace

TEST_CASE("a record is read as it was written") {
  report::RunRecord one;
  one.scenes = {some_scene("courtyard")};
  holds(one, "kage.cosim/1");

  report::RunRecord several;
  several.several = true;
  several.scenes = {no_frames(), some_scene("a"), some_scene("b")};
  several.page = "out/report.html";
  holds(several, "kage.cosim/1");
  CHECK(to_json(several)["first_difference"]["scene"] == "a");

  report::RunRecord merged;
  merged.merged = true;
  merged.scenes = {some_joined()};
  holds(merged, "kage.merge/1");
  merged.several = true;
  merged.scenes.push_back(some_joined());
  holds(merged, "kage.merge/1");

  report::RunRecord regress;
  regress.several = true;
  regress.scenes = {some_scene("random.glass.0")};
  regress.page = "out/report.html";
  regress.regress = {.again = "kage regress",
                     .rounds = 1,
                     .seed = 5,
                     .seconds = 0.75,
                     .build_seconds = 2,
                     .interrupted = true,
                     .trouble = std::nullopt};
  holds(regress, "kage.regress/1");
  regress.regress->trouble = "random.glass.1 (configuration glass): out of memory";
  holds(regress, "kage.regress/1");
}

TEST_CASE("what is not of its form is named by its place") {
  report::RunRecord record;
  record.scenes = {some_scene("courtyard")};
  const Json good = to_json(record);
  REQUIRE(refused(good) == "taken");
  Json more = good;
  more["later"] = 1;
  CHECK(refused(more) == "taken");

  // Every key of every object is needed, in its type.
  const Json flat = good.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    const Json::json_pointer at(pointer);
    Json other = good;
    other[at] = value.is_boolean() ? Json("yes") : Json(true);
    CAPTURE(pointer);
    const bool follows = pointer.ends_with("/stage") || pointer == "/first_difference/cycle" ||
                         pointer == "/first_difference/divergence/file" || pointer == "/verdicts/taken";
    CHECK((refused(other) == "taken") == follows);
    if (follows || pointer == "/schema") continue;
    // The last name of the place: of a value in a list the list's own.
    std::string name = pointer.substr(1);
    while (name.find_last_of('/') != std::string::npos && std::isdigit(name[name.find_last_of('/') + 1]) != 0)
      name.resize(name.find_last_of('/'));
    const std::size_t slash = name.rfind('/');
    const std::string within = slash == std::string::npos ? "" : " (" + name + ")";
    CHECK(refused(other) == name.substr(within.empty() ? 0 : slash + 1) + " is not what it should be" + within);
  }
  for (const char* key : {"same", "each", "config", "first_difference", "notes"}) {
    Json other = good;
    other.erase(key);
    CHECK(refused(other) == std::string(key) + " is missing");
  }
  Json j = good;
  j["first_difference"]["divergence"].erase("text");
  CHECK(refused(j) == "text is missing (first_difference/divergence/text)");
  j = good;
  j["frames"] = -1;
  CHECK(refused(j) == "frames is not what it should be");
  j = good;
  j["cycles"] = std::uint64_t{1} << 43;
  CHECK(refused(j) == "cycles is not what it should be");

  j = good;
  j["schema"] = "kage.cosim/2";
  CHECK(refused(j) == "schema is \"kage.cosim/2\", and this kage reads kage.cosim/1, kage.merge/1 and kage.regress/1");
  j.erase("schema");
  CHECK(refused(j) == "it names no schema");
  CHECK(refused(Json::array()) == "it is no object");
}

// The promise of docs/schema/README.md about a schema's number.
TEST_CASE("a report of an earlier or a later kage is read as far as its keys go") {
  report::RunRecord record;
  record.scenes = {some_scene("courtyard")};
  record.scenes[0].config.lanes = 2 * Config{}.lanes;
  const Json good = to_json(record);
  // An earlier one: a parameter that came since has its default.
  Json j = good;
  REQUIRE(j["config"].erase("LANES") == 1);
  const report::RunRecord earlier = report::RunRecord::from_json(j);
  CHECK(earlier.any().config.lanes == Config{}.lanes);
  j["config"] = Json::object();
  CHECK(report::RunRecord::from_json(j).any().config == Config{});
  j = good;
  j.erase("coverage");
  CHECK_FALSE(report::RunRecord::from_json(j).any().coverage);

  // A later one: keys and phases that are not known are passed over, wherever they are. A parameter decides the words.
  for (const char* place : {"", "/first_difference", "/first_difference/divergence", "/each/0", "/verdicts", "/shard",
                            "/options", "/kept", "/coverage/points/0", "/polyhedra/0", "/stalled"}) {
    j = good;
    j[Json::json_pointer(place)]["later"] = {{"x", 1}};
    CAPTURE(place);
    CHECK(to_json(report::RunRecord::from_json(j)) == good);
  }
  j = good;
  j["each"][0]["stalled_by_phase"]["later"] = 5;
  CHECK(to_json(report::RunRecord::from_json(j)) == good);
  j = good;
  j["config"]["LATER"] = 1;
  CHECK(refused(j) == "LATER is no parameter of this kage (config/LATER)");
  j = good;
  j["config"]["Z_BITS"] = 99;
  CHECK(refused(j).starts_with("config: Z_BITS is 99, legal are "));
}
