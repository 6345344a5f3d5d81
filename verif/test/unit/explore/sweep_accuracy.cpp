// SPDX-License-Identifier: Apache-2.0
// Accuracy of a sweep's point, of pictures that are made wrong on purpose; and what each source of error does alone.
#include "explore/sweep_accuracy.hpp"

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>

#include "contract/derived.hpp"
#include "explore/sweep_run.hpp"
#include "kage/light.hpp"
#include "plan/widths.hpp"
#include "test/support/catch.hpp"
#include "test/support/installed.hpp"

using namespace kage;
using namespace kage::explore;

namespace {

struct Swept {
  SweepPoint base;
  std::unique_ptr<SweepScene> scene;

  explicit Swept(const std::string& name, const std::string& config = "") {
    const auto loaded = std::make_shared<const Scene>(Scene::load(name));
    const DrawOptions draw{.width = 64, .height = 48, .frames = 1, .threads = 1, .name = name};
    base.config = config.empty() ? choose_config(*loaded, draw).config : load_config(config).config;
    base.look.fit = true;
    base = with(base, "SIZE", "64x48");
    scene = std::make_unique<SweepScene>(loaded, draw, base, [] {});
  }

  [[nodiscard]] DrawnFrame drawn(const SweepPoint& p) const {
    return draw(scene->frame(0), p.config, scene->draw_options(p));
  }
  PointAccuracy accuracy(const SweepPoint& p, const DrawnFrame& frame) const {
    return accuracy_of(*scene, 0, p, frame, true);
  }
};

}  // namespace

TEST_CASE("a wrong face is counted, and no error excuses it") {
  Swept s("courtyard");
  const DrawnFrame right = s.drawn(s.base);
  const PointAccuracy good = s.accuracy(s.base, right);
  CHECK(good.by_truth.visible_wrong == 0);
  CHECK(good.by_truth.gross_wrong == 0);
  CHECK(good.ray_pixels == std::uint64_t{64} * 48);
  // A face that is elsewhere on the screen: the one of the first pixel that shows another than this one.
  DrawnFrame wrong = right;
  int changed = 0;
  for (std::size_t i = std::size_t{5} * 64; i < right.face.size() && changed < 7; i += 97) {
    if (right.face[i] == kNothing) continue;
    wrong.face[i] = kNothing;
    ++changed;
  }
  REQUIRE(changed == 7);
  const PointAccuracy bad = s.accuracy(s.base, wrong);
  CHECK(bad.by_truth.visible_wrong == 7);
  CHECK(bad.by_truth.gross_wrong == 7);
  CHECK(bad.ray_visible_wrong == good.ray_visible_wrong + 7);
}

TEST_CASE("a wrong shadow, depth and colour are counted") {
  Swept s("courtyard");
  const DrawnFrame right = s.drawn(s.base);
  const PointAccuracy good = s.accuracy(s.base, right);
  const auto truth = s.scene->truth(0, s.base, kMostSubBits);
  DrawnFrame wrong = right;
  std::uint64_t turned = 0;
  std::size_t deep = right.face.size();
  for (std::size_t i = 0; i < right.face.size(); ++i) {
    if (truth->pixels[i].face == kNothing) continue;
    deep = i;
    if (!truth->pixels[i].lit || i % 5 != 0) continue;
    wrong.counts[i][0] = wrong.counts[i][0] > 0 ? 0 : 1;
    ++turned;
  }
  REQUIRE(turned > 20);
  wrong.z[deep] += 1000;
  for (auto& c : wrong.color) c[0] = static_cast<std::uint8_t>(c[0] ^ 16U);
  const PointAccuracy bad = s.accuracy(s.base, wrong);
  CHECK(bad.by_truth.shadow_wrong == good.by_truth.shadow_wrong + turned);
  CHECK(bad.by_truth.gross_wrong > turned / 2);  // near an edge of a shadow both may be possible
  CHECK(bad.by_truth.gross_wrong <= turned);
  CHECK(std::abs(bad.z_error_max_lsb - 1000) < 1);
  CHECK(*psnr(bad.all.squares, bad.all.pixels) < *psnr(good.all.squares, good.all.pixels));
  CHECK(bad.flip > good.flip);
  CHECK(*psnr(3.0 * 100, 100) == Approx(20 * std::log10(255.0)));
  CHECK_FALSE(psnr(0, 100));
}

TEST_CASE("a soft shadow that is off by a sample more than its errors allow is gross") {
  for (const char* name : {"penumbra", "three-lights"}) {
    CAPTURE(name);
    Swept s(name);
    // A depth so coarse that shadows move is excused.
    const SweepPoint coarse = with(s.base, "Z_BITS", "9");
    const PointAccuracy moved = s.accuracy(coarse, s.drawn(coarse));
    CHECK(moved.by_truth.shadow_wrong > 0);
    CHECK(moved.by_truth.gross_wrong == 0);
    const DrawnFrame right = s.drawn(s.base);
    const auto truth = s.scene->truth(0, s.base, kMostSubBits);
    DrawnFrame wrong = right;
    std::uint64_t changed = 0;
    const int samples = samples_of(s.base);
    std::size_t soft = 0;
    while (s.scene->light_samples(0, s.base)[soft] == 1) ++soft;
    for (std::size_t i = 0; i < right.face.size(); ++i) {
      if (!truth->pixels[i].lit || right.counts[i][soft] < 2 || right.counts[i][soft] >= samples) continue;
      --wrong.counts[i][soft];  // some shadow, as before
      ++changed;
    }
    REQUIRE(changed > 10);
    const PointAccuracy bad = s.accuracy(s.base, wrong);
    CHECK(bad.by_truth.gross_wrong > changed * 9 / 10);
    CHECK(bad.by_truth.gross_wrong <= changed);
  }
}

TEST_CASE("rays count the samples of every light") {
  for (const char* name : {"courtyard", "penumbra", "three-lights"}) {
    CAPTURE(name);
    Swept s(name);
    const DrawnFrame right = s.drawn(s.base);
    const PointAccuracy good = s.accuracy(s.base, right);
    CHECK(good.ray_shadow_pixels > 500);
    // The snap moves edges, so that a soft shadow's samples change at some pixels of many.
    CHECK(good.ray_shadow_wrong * 20 < good.ray_shadow_pixels);
    CHECK(good.ray_shadow_share <= static_cast<double>(good.ray_shadow_wrong));
    DrawnFrame wrong = right;
    for (auto& counts : wrong.counts) ++counts.back();  // of no light
    CHECK(s.accuracy(s.base, wrong).ray_shadow_wrong == good.ray_shadow_wrong);
    const std::size_t lights = s.scene->frame(0).lights.size();
    for (auto& counts : wrong.counts)
      for (std::size_t l = 0; l < lights; ++l) counts[l] = static_cast<std::uint8_t>(counts[l] + 100);
    const PointAccuracy bad = s.accuracy(s.base, wrong);
    CHECK(bad.ray_shadow_wrong == good.ray_shadow_pixels);
    CHECK(bad.ray_shadow_share > static_cast<double>(good.ray_shadow_pixels));
  }
}

TEST_CASE("rays tell an order of layers that is wrong") {
  Swept s("glass");
  const auto layers = [&](const char* order) {
    const SweepPoint p = with(s.base, "ORDER", order);
    return s.accuracy(p, s.drawn(p));
  };
  const PointAccuracy exact = layers("exact");
  const PointAccuracy centroid = layers("centroid");
  const PointAccuracy submission = layers("submission");
  CHECK(exact.ray_layer_pixels > 200);
  CHECK(exact.ray_layers_wrong == 0);
  CHECK(centroid.ray_layers_wrong > 0);
  CHECK(submission.ray_layers_wrong > centroid.ray_layers_wrong);
  CHECK(submission.ray_layers_wrong <= submission.ray_layer_pixels);
  // A core that blends nothing has no layers.
  const SweepPoint none = with(s.base, "TRANSLUCENCY", "0");
  CHECK(s.accuracy(none, s.drawn(none)).ray_layer_pixels == 0);
}

TEST_CASE("the error of a point that differs from the finest in one source is that source's alone") {
  using Case = std::pair<std::string, std::string>;
  for (const auto& [name, linear_bits] :
       {Case{"courtyard", "0"}, Case{"courtyard", "10"}, Case{"penumbra", "0"}, Case{"glass", "0"}}) {
    Swept s(name);
    const bool linear = linear_bits != "0";
    SweepPoint coarse = linear ? with(s.base, "LINEAR_BITS", linear_bits) : s.base;
    coarse = with(with(coarse, "SUB_BITS", "4"), "Z_BITS", "9");
    coarse = linear ? with(coarse, "CHANNELS", "1") : with(coarse, "SHADE_FRAC", "3");
    if (samples_of(coarse) > 1) coarse = with(coarse, "SAMPLES", "3");
    coarse = with(coarse, "ORDER", "submission");
    const auto law = s.scene->error_of(0, coarse, ErrorSource::law);
    for (const ErrorSource source : kErrorSources) {
      const SweepPoint one = s.scene->alone(coarse, source);
      CAPTURE(name, linear_bits, name_of(source));
      const bool by_law = source == ErrorSource::law;
      const SweepPoint best = by_law ? s.scene->finest(coarse) : s.scene->finest_of_law(coarse);
      const PictureError all = sum_of(against_picture(s.drawn(best), s.scene->light_samples(0, best), s.drawn(one),
                                                      s.scene->light_samples(0, one)));
      for (const ErrorSource other : kErrorSources) {
        const auto e = s.scene->error_of(0, one, other);
        // A table has the error of its law, whatever else it has.
        const bool has = other == source;
        const bool of_table = other == ErrorSource::law && !linear;
        CHECK(e->squares == (has ? all.squares : of_table ? law->squares : 0));
        CHECK(e->visible_wrong == (has ? all.visible_wrong : 0));
        CHECK(e->shadow == (has ? all.shadow : 0));
      }
    }
    // Each of these shows, where the scene has what it is about.
    CHECK(s.scene->error_of(0, coarse, ErrorSource::snapping)->visible_wrong > 0);
    CHECK(s.scene->error_of(0, coarse, ErrorSource::color)->squares > 0);
    CHECK((s.scene->error_of(0, coarse, ErrorSource::samples)->shadow > 0) == (name == "penumbra"));
    CHECK((s.scene->error_of(0, coarse, ErrorSource::order)->squares > 0) == (name == "glass"));
    CHECK((law->squares > 0) == (s.base.config.dsf_bits > 0));
  }
}

TEST_CASE("the finest picture adds light after light, and a table's law is a source of error") {
  Swept s("three-lights");
  REQUIRE(derived::has_table(s.base.config));
  const PointAccuracy table = s.accuracy(s.base, s.drawn(s.base));
  const SweepPoint linear = with(s.base, "LINEAR_BITS", "12");
  const PointAccuracy added = s.accuracy(linear, s.drawn(linear));
  CHECK(s.scene->finest(s.base).config.linear_bits == kGreatest.linear_bits);
  CHECK(text_of(s.scene->finest(s.base)) == text_of(s.scene->finest(linear)));
  CHECK(table.finest_light.squares == added.finest_light.squares);
  CHECK(added.light.squares < table.light.squares / 3);
  CHECK(added.all.squares < table.all.squares / 4);
  const auto of_table = s.scene->error_of(0, s.base, ErrorSource::law);
  const auto of_added = s.scene->error_of(0, linear, ErrorSource::law);
  CHECK(of_added->squares < of_table->squares / 10);
  // Most of a good table's error is its law.
  CHECK(of_table->squares > table.all.squares / 2);
  CHECK(s.scene->error_of(0, linear, ErrorSource::classes)->squares == 0);
}

TEST_CASE("one share for all shadows is an error by classes, and a table takes most of it away") {
  Swept s("courtyard", "default");
  REQUIRE_FALSE(derived::has_table(s.base.config));
  const SweepPoint table = with(with(s.base, "COUNT_BITS", "1"), "CLASS_BITS", "4");
  const auto one = s.scene->error_of(0, s.base, ErrorSource::classes);
  const auto classes = s.scene->error_of(0, table, ErrorSource::classes);
  CHECK(classes->squares < one->squares / 100);
  CHECK(s.accuracy(table, s.drawn(table)).all.squares < s.accuracy(s.base, s.drawn(s.base)).all.squares / 10);
}

TEST_CASE("light is held against the truth, whatever the finest picture has") {
  Swept one("courtyard", "default");
  Swept s("courtyard");
  const PointAccuracy shade = one.accuracy(one.base, one.drawn(one.base));
  const PointAccuracy table = s.accuracy(s.base, s.drawn(s.base));
  CHECK(table.light.pixels > 1000);
  CHECK(table.light.shadowed > 100);
  CHECK(table.light.squares < shade.light.squares / 10);
  CHECK(table.finest_light.squares <= table.light.squares);
  // A picture whose light is wrong everywhere, and the finest one's error, which stays.
  DrawnFrame dark = s.drawn(s.base);
  for (auto& c : dark.color) c[0] = static_cast<std::uint8_t>(c[0] / 2);
  const PointAccuracy bad = s.accuracy(s.base, dark);
  CHECK(bad.light.lit_sum > 20.0 * static_cast<double>(bad.light.pixels - bad.light.shadowed));
  CHECK(bad.finest_light.squares == table.finest_light.squares);
  // A hole in a face shows no light: pixels that show another face than the ray's are left out.
  DrawnFrame hole = s.drawn(s.base);
  for (std::size_t i = 0; i < hole.face.size(); i += 2) hole.face[i] = kNothing;
  CHECK(s.accuracy(s.base, hole).light.pixels < table.light.pixels * 6 / 10);
  SweepPoint culled = s.base;
  culled.look.cull = true;
  CHECK(s.accuracy(culled, s.drawn(culled)).light.pixels == 0);
}

TEST_CASE("volumes that a core without FSF leaves out are wrong and not gross") {
  for (const char* name : {"courtyard", "three-lights"}) {
    CAPTURE(name);
    Swept s(name, std::string(name) == "courtyard" ? "default" : "");
    const SweepPoint one = with(s.base, "FSF", "0");
    const PointAccuracy a = s.accuracy(one, s.drawn(one));
    CHECK(a.by_truth.shadow_wrong > 100);
    CHECK(a.by_truth.gross_wrong == 0);
  }
}

TEST_CASE("of more lights than a table has the first ones are compared") {
  for (const int lights : {9, 64}) {
    CAPTURE(lights);
    SceneParts parts;
    SceneObject floor;
    floor.positions = {{-3, 0, -3}, {3, 0, -3}, {3, 0, 3}, {-3, 0, 3}};
    floor.triangles = {{0, 2, 1}, {0, 3, 2}};
    SceneObject roof;
    roof.positions = {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}};
    roof.triangles = {{0, 2, 1}, {0, 3, 2}};
    parts.objects = {floor, roof};
    std::vector<Light> all;
    for (int i = 0; i < lights; ++i) {
      Light l;
      l.direction = glm::normalize(glm::dvec3{std::cos(i), -2, std::sin(i)});
      all.push_back(l);
    }
    parts.lights = {all};
    SweepPoint point;
    point.config = load_config("linear").config;
    point.look.fit = true;
    point = with(point, "SIZE", "64x48");
    SweepScene scene(std::make_shared<const Scene>(Scene::from(parts)),
                     {.width = 64, .height = 48, .frames = 1, .threads = 1, .name = "many"}, point, [] {});
    const auto drawn = [&](const SweepPoint& p) { return draw(scene.frame(0), p.config, scene.draw_options(p)); };
    const PointAccuracy a = accuracy_of(scene, 0, point, drawn(point), false);
    CHECK(a.by_truth.visible_wrong + a.by_truth.shadow_wrong == 0);
    CHECK(scene.error_of(0, point, ErrorSource::samples)->shadow_wrong == 0);
    CHECK(scene.error_of(0, point, ErrorSource::depth)->shadow_wrong == 0);
    // A table has no room for the others, which is its law's error.
    SweepPoint table = point;
    table.config = load_config("lights").config;
    table.config.lights = 8;
    table = with(table, "SIZE", "64x48");
    CHECK(scene.finest_of_law(table).config.lights == 8);
    CHECK(scene.error_of(0, table, ErrorSource::law)->squares > 0);
  }
}

TEST_CASE("another scene has another identity") {
  const auto identity = [](const std::function<void(SceneOptions&)>& change) {
    SceneOptions options;
    change(options);
    const auto loaded = std::make_shared<const Scene>(Scene::load("courtyard", options));
    return SweepScene(loaded, {.width = 64, .height = 48, .frames = 1, .name = "courtyard"}, {}, [] {}).identity();
  };
  const std::string plain = identity([](SceneOptions&) {});
  CHECK(identity([](SceneOptions&) {}) == plain);
  CHECK(identity([](SceneOptions& o) { o.alpha = 0.9; }) != plain);
  CHECK(identity([](SceneOptions& o) { o.alpha = 0.9; }) != identity([](SceneOptions& o) { o.alpha = 0.2; }));
}

TEST_CASE("grey faces before a background that is not grey") {
  const std::string mesh = verif::glmark2("horse.3ds");
  if (!verif::present(mesh)) return;
  Swept s(mesh);
  REQUIRE(s.base.config.channels == 3);
  // A finest picture of one channel would have another background than the row's, which no source of error explains.
  const PointAccuracy a = s.accuracy(s.base, s.drawn(s.base));
  double sources = 0;
  for (const ErrorSource source : kErrorSources) sources += s.scene->error_of(0, s.base, source)->squares;
  CHECK(a.all.squares <= 2 * sources);
}

TEST_CASE("depth is within its bound") {
  Swept s("courtyard");
  for (const char* frac : {"0", "3", "7", "16"}) {
    CAPTURE(frac);
    const SweepPoint p = with(s.base, "Z_FRAC", frac);
    const PointWords words = words_of(*s.scene, p);
    const PointAccuracy a = s.accuracy(p, s.drawn(p));
    CHECK(a.z_error_max_lsb > 0);
    CHECK(a.z_error_max_lsb <= plan::depth_error(words.longest_depth, p.config.z_frac, p.width, p.height));
  }
}

TEST_CASE("more samples are nearer the area's share") {
  Swept s("penumbra");
  const auto few = soft_share(s.scene->frame(0), with(s.base, "SAMPLES", "3"));
  const auto many = soft_share(s.scene->frame(0), with(s.base, "SAMPLES", "63"));
  REQUIRE(few);
  REQUIRE(many);
  CHECK(many->rms < few->rms / 3);
  CHECK(few->worst > few->rms);
  CHECK_FALSE(soft_share(Swept("courtyard").scene->frame(0), s.base));
}

TEST_CASE("a row that another beats is not marked") {
  using Json = nlohmann::ordered_json;
  const auto row = [](const char* scene, double wrong, double square, double cycles, double luts, int width = 64,
                      int height = 48) {
    return Json{{"scene", scene},
                {"look", {{"width", width}, {"height", height}}},
                {"accuracy",
                 {{"pixels", 100},
                  {"visible_wrong", wrong},
                  {"shadow_wrong", 0},
                  {"sources", {{"all", {{"mean_square", square}}}}}}},
                {"speed", {{"rtl_cycles_per_pixel", cycles}}},
                {"area", {{"luts", luts}}}};
  };
  CHECK(pareto({row("a", 1, 1, 1, 1), row("a", 1, 1, 2, 1), row("a", 0, 1, 2, 1), row("b", 9, 9, 9, 9),
                row("a", 1, 1, 1, 1)}) == std::vector<bool>{true, false, true, true, true});
  // 64x480 and 644x80 are two sizes, though their digits are the same.
  CHECK(pareto({row("a", 1, 1, 1, 1, 64, 480), row("a", 2, 2, 2, 2, 644, 80)}) == std::vector<bool>{true, true});
}

TEST_CASE("steps are counted between neighbours of one face, beyond those of the finest picture") {
  // Two rows of four pixels; the last column shows another face.
  DrawnFrame finest;
  finest.width = 4;
  finest.height = 2;
  finest.face = {0, 0, 0, 1, 0, 0, 0, 1};
  finest.color = {{{10, 10, 10}}, {{20, 20, 20}}, {{30, 30, 30}}, {{200, 200, 200}},
                  {{10, 10, 10}}, {{20, 20, 20}}, {{30, 30, 30}}, {{200, 200, 200}}};
  DrawnFrame drawn = finest;
  CHECK(steps_of(finest, drawn).seen == 0);
  CHECK(steps_of(finest, drawn).most == 0);
  drawn.color[1] = {22, 20, 20};  // 2 further from pixel 0 and from pixel 5
  CHECK(steps_of(finest, drawn).seen == 0);
  CHECK(steps_of(finest, drawn).most == 2);
  drawn.color[1] = {23, 20, 20};
  CHECK(steps_of(finest, drawn).seen == 2);
  CHECK(steps_of(finest, drawn).most == 3);
  drawn.color[2] = {30, 90, 30};  // 60 further from pixel 1 and from pixel 6; pixel 3 has another face
  CHECK(steps_of(finest, drawn).seen == 4);
  CHECK(steps_of(finest, drawn).most == 60);
  drawn.face[2] = 1;  // other faces than in the finest picture are no step
  CHECK(steps_of(finest, drawn).seen == 2);
}

TEST_CASE("a row names the tools that its figures come from, and no others") {
  Swept s("courtyard");
  std::vector<SweepPoint> points{s.base, with(s.base, "ARRANGEMENT", "systolic")};
  points[1] = with(points[1], "SIZE", "65x48");  // too wide to be built
  const auto text = [&](bool area, bool cosim, std::size_t index, const std::string& yosys, const std::string& model) {
    SweepHow how;
    how.area = area;
    how.cosim = cosim;
    how.tools = {.yosys = yosys, .model = model};
    return SweepRunner(*s.scene, points, how).tools_text(index);
  };
  CHECK(text(true, true, 0, "Yosys 1", "Verilator 1") != text(true, true, 0, "Yosys 2", "Verilator 1"));
  CHECK(text(true, true, 0, "Yosys 1", "Verilator 1") != text(true, true, 0, "Yosys 1", "Verilator 2"));
  CHECK(text(false, true, 0, "Yosys 1", "Verilator 1") == text(false, true, 0, "Yosys 2", "Verilator 1"));
  CHECK(text(true, false, 0, "Yosys 1", "Verilator 1") == text(true, false, 0, "Yosys 1", "Verilator 2"));
  CHECK(text(true, true, 1, "Yosys 1", "Verilator 1").empty());
}
