// SPDX-License-Identifier: Apache-2.0
// A co-simulation as a library: scenes, jobs, shards, interruptions, files, and scenes that a program makes. Golden
// cores stand for the RTL, one of which may be wrong.
#include "cosim/session/session.hpp"

#include <filesystem>
#include <set>

#include "cosim/report/shards.hpp"
#include "cosim/session/command_lines.hpp"
#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/fake_cores.hpp"
#include "test/support/temp_directory.hpp"

using namespace kage;
using namespace kage::cosim;
using test::FakeCores;
using test::TempDirectory;
namespace fs = std::filesystem;

namespace {

constexpr int kFrames = 6;

CosimOptions small(const std::string& input = "courtyard") {
  CosimOptions o;
  o.input = input;
  o.size = {32, 24};
  o.frames = kFrames;
  o.config = "full";
  o.threads = 1;
  o.no_divergence = true;  // there is no RTL to look into
  return o;
}

report::RunRecord go(const CosimOptions& o, Host& host, Cores& cores) {
  TempFiles files;
  Session session(o, host, cores);
  session.compare();
  report::RunRecord record = session.finish(files);
  files.place();
  files.settle();
  return record;
}

/// Two triangles before the eye, lit from another side in each frame.
std::shared_ptr<const Scene> own_scene() {
  SceneParts parts;
  parts.name = "mine";
  SceneObject o;
  o.name = "square";
  o.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  o.triangles = {{0, 1, 2}, {0, 2, 3}};
  parts.objects = {o};
  Camera camera;
  camera.eye = {0, 0, 4};
  parts.cameras = {camera};
  for (const double x : {-1.0, 0.0, 1.0}) {
    Light light;
    light.direction = {x, 0, -1};
    parts.lights.push_back({light});
  }
  return std::make_shared<const Scene>(Scene::from(parts));
}

/// Ends a run after so many questions, and listens.
class Listening final : public Host {
 public:
  explicit Listening(int questions = -1) : left_(questions) {}
  void check() override {
    if (left_ >= 0 && asked_++ >= left_) throw Interrupted{};
  }
  void say(const std::string& text) override { said += text; }
  std::string said;
  [[nodiscard]] int asked() const { return asked_; }

 private:
  int left_;
  std::atomic<int> asked_{0};
};

}  // namespace

TEST_CASE("the record is that of one job, whatever the jobs") {
  Host host;
  for (const int wrong : {-1, 0, 2, kFrames - 1}) {
    FakeCores cores;
    cores.wrong = wrong;
    std::optional<report::RunRecord> first;
    for (const int jobs : {1, 2, 3, kFrames + 2}) {
      CosimOptions o = small();
      o.jobs = jobs;
      const report::RunRecord r = go(o, host, cores);
      REQUIRE(r.scenes.size() == 1);
      const report::SceneRecord& s = r.scenes[0];
      REQUIRE(s.same == (wrong < 0));
      REQUIRE(s.frames == (wrong < 0 ? kFrames : wrong + 1));
      if (wrong >= 0) {
        REQUIRE(s.first_difference->frame == wrong);
        REQUIRE(s.first_difference->line == 0);
        REQUIRE(s.first_difference->x == 0);
      }
      if (!first) first = r;
      REQUIRE(s.pixels_compared == first->scenes[0].pixels_compared);
      REQUIRE(s.spans == first->scenes[0].spans);
    }
  }
}

TEST_CASE("a difference ends its scene, and not the others") {
  Host host;
  FakeCores cores;
  cores.wrong = 1;
  CosimOptions o = small();
  o.inputs = {"courtyard", "glass", "knot"};
  const report::RunRecord r = go(o, host, cores);
  REQUIRE(r.several);
  REQUIRE(r.scenes.size() == 3);
  for (const report::SceneRecord& s : r.scenes) REQUIRE(s.frames == 2);
  o.inputs = {"glass", "glass"};
  REQUIRE_THROWS_WITH(go(o, host, cores), "glass: a scene called glass is there already: glass");
}

TEST_CASE("shards have all frames once") {
  Host host;
  FakeCores cores;
  CosimOptions o = small();
  o.inputs = {"courtyard", "glass"};
  o.shard.given = true;
  o.shard.count = 5;
  std::multiset<std::pair<std::string, int>> seen;
  for (o.shard.index = 1; o.shard.index <= o.shard.count; ++o.shard.index)
    for (const report::SceneRecord& s : go(o, host, cores).scenes)
      for (int i = 0; i < s.frames; ++i) seen.emplace(s.scene, s.first_frame + i * s.frame_step);
  REQUIRE(seen.size() == std::size_t{2} * kFrames);
  REQUIRE(std::set(seen.begin(), seen.end()).size() == std::size_t{2} * kFrames);
  o.shard = {.index = 14, .count = 14, .given = true};
  REQUIRE_THROWS_WITH(go(o, host, cores), "--shard 14/14: the scenes have only 12 frames");
}

TEST_CASE("the record of joined shards is that of the whole run") {
  Host host;
  for (const int wrong : {-1, 4}) {
    FakeCores cores;
    cores.wrong = wrong;
    CosimOptions o = small();
    o.inputs = {"courtyard", "glass"};
    o.coverage = true;
    const report::RunRecord whole = go(o, host, cores);
    const TempDirectory dir;
    std::vector<std::string> files;
    o.shard.given = true;
    o.shard.count = 5;
    for (o.shard.index = 1; o.shard.index <= o.shard.count; ++o.shard.index)
      files.push_back(dir.write(std::to_string(o.shard.index), report::to_json(go(o, host, cores)).dump()));
    const report::RunRecord joined = report::joined_record(report::read_shards(files, [] {}));
    REQUIRE(joined.scenes.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      const report::SceneRecord& a = whole.scenes[i];
      const report::SceneRecord& b = joined.scenes[i];
      REQUIRE(a.scene == b.scene);
      REQUIRE(a.same == b.same);
      REQUIRE(a.total_frames == b.total_frames);
      if (wrong >= 0) {
        REQUIRE(a.first_difference->frame == b.first_difference->frame);
        REQUIRE(b.frames == kFrames);  // the other shards go on behind it: with 5 for 6 frames none is
        continue;
      }
      REQUIRE(a.frames == b.frames);
      REQUIRE(a.pixels_compared == b.pixels_compared);
      REQUIRE(a.spans == b.spans);
      REQUIRE(a.coverage->frames == b.coverage->frames);
      for (std::size_t f = 0; f < a.each.size(); ++f) REQUIRE(a.each[f].frame == b.each[f].frame);
    }
    files.pop_back();
    REQUIRE_THROWS_WITH(report::read_shards(files, [] {}), "shard 5/5 is missing");
  }
}

TEST_CASE("an interruption before the verdict is thrown, and leaves no file") {
  FakeCores cores;
  const TempDirectory dir;
  Listening all;
  CosimOptions o = small();
  o.out = dir.path().string();
  o.jobs = 1;
  (void)go(o, all, cores);
  REQUIRE(fs::exists(dir.path() / "report.html"));
  REQUIRE(all.asked() == 0);  // it counts none unless it is to end
  for (const int questions : {0, 1, 2, 5, 9, 14, 20}) {
    const TempDirectory none;
    o.out = none.path().string();
    Listening host(questions);
    FakeCores own;
    REQUIRE_THROWS_AS(go(o, host, own), Interrupted);
    REQUIRE(fs::is_empty(none.path()));
  }
}

TEST_CASE("trouble with a core is told, and no difference") {
  Host host;
  FakeCores cores;
  cores.before_core = [] { throw Error("there is none"); };
  REQUIRE_THROWS_WITH(go(small(), host, cores), "there is none");
}

TEST_CASE("enough ends a scene where it is") {
  Host host;
  FakeCores cores;
  CosimOptions o = small();
  o.jobs = 1;
  int asked = 0;
  o.enough = [&] { return ++asked == 3; };
  const report::RunRecord r = go(o, host, cores);
  REQUIRE(r.scenes[0].same);
  REQUIRE(r.scenes[0].frames == 3);
}

TEST_CASE("files appear with a folder, and none without") {
  Host host;
  FakeCores cores;
  cores.wrong = 3;
  const TempDirectory dir;
  CosimOptions o = small();
  o.out = (dir.path() / "out").string();
  fs::create_directory(o.out);
  const report::RunRecord r = go(o, host, cores);
  for (const char* name : {"courtyard_0000.png", "courtyard_0003_expected.png", "courtyard_0003_actual.png",
                           "courtyard_0003_difference.png", "report.html"})
    CHECK(fs::exists(fs::path(o.out) / name));
  REQUIRE(r.scenes[0].page == (fs::path(o.out) / "report.html").string());
  o.out.clear();
  REQUIRE(go(o, host, cores).scenes[0].pictures.empty());
}

TEST_CASE("a verdict that an earlier run has kept takes no core") {
  const TempDirectory cache;
  setenv("XDG_CACHE_HOME", cache.path().c_str(), 1);
  Host host;
  FakeCores cores;
  CosimOptions o = small();
  o.cache_verdicts = true;
  o.jobs = 1;
  REQUIRE(go(o, host, cores).scenes[0].verdicts.kept == kFrames);
  const int made = cores.cores;
  const report::RunRecord again = go(o, host, cores);
  REQUIRE(again.scenes[0].same);
  REQUIRE(again.scenes[0].verdicts.taken_frames.size() == kFrames);
  REQUIRE(cores.cores == made);
  o.seed = 2;  // of the stalls
  REQUIRE(go(o, host, cores).scenes[0].verdicts.taken_frames.empty());
}

TEST_CASE("a scene of the program's own, with lights that change") {
  Host host;
  FakeCores cores;
  CosimOptions o = small("");
  o.scene = own_scene();
  o.frames = 0;
  o.config.clear();
  const TempDirectory dir;
  o.out = dir.path().string();
  report::RunRecord r = go(o, host, cores);
  REQUIRE(r.scenes[0].scene == "mine");
  REQUIRE(r.scenes[0].frames == 3);
  REQUIRE(r.scenes[0].same);
  REQUIRE(r.scenes[0].again.empty());  // no command line has the scene
  REQUIRE(fs::exists(dir.path() / "mine_0002.png"));
  cores.wrong = 2;
  r = go(o, host, cores);
  REQUIRE(r.scenes[0].first_difference->frame == 2);
  o.config = "tiny";
  REQUIRE_THROWS_WITH(go(o, host, cores),
                      "mine: configuration tiny lacks shadows (DSF_BITS > 0), several volumes (FSF)");
}

TEST_CASE("parameters stand in place of a configuration's name") {
  Host host;
  FakeCores cores;
  CosimOptions o = small();
  o.config.clear();
  o.parameters = load_config("full").config;
  o.parameters->z_bits = 20;
  report::RunRecord r = go(o, host, cores);
  REQUIRE(r.scenes[0].config.z_bits == 20);
  REQUIRE(r.scenes[0].config_name == "given");
  o.parameters->z_bits = 99;
  REQUIRE_THROWS_AS(go(o, host, cores), Error);
}

TEST_CASE("command lines say what the options say") {
  CosimOptions o;
  o.input = "my scene.obj";
  CHECK(command_lines(o).again == "kage cosim 'my scene.obj' --seed 1");
  o.size = {32, 24};  // as a program sets it
  o.level = Level::polygons;
  CHECK(command_lines(o).again == "kage cosim 'my scene.obj' --size 32x24 --seed 1 --front-end rtl");
  o.config = "full";
  o.size = {160, 120};
  o.size_given = true;
  o.frames = 4;
  o.order = TranslucentWay::centroid;
  o.alpha = 0.5;
  o.seed = 7;
  o.jobs = 1;
  o.out = "out";
  o.level = Level::polygons;
  o.level_option = "--front-end rtl";
  o.rtl = {.fault = "stuck_flag", .netlist = "", .mutant = 3, .idle = 20, .backpressure = 0};
  const CommandLines lines = command_lines(o);
  const std::string pictures = "--config full --size 160x120 --frames 4 --order centroid --alpha 0.5 --seed 7";
  CHECK(lines.again == "kage cosim 'my scene.obj' --out out " + pictures +
                           " --front-end rtl --idle 20 --fault stuck_flag --mutant 3 --jobs 1");
  CHECK(lines.in_place ==
        "kage cosim 'my scene.obj' " + pictures + " --front-end rtl --idle 20 --fault stuck_flag --mutant 3");
  CHECK(lines.rtl == "--fault stuck_flag --mutant 3 --idle 20");
  CHECK(lines.explain == pictures + " --front-end rtl");
}
