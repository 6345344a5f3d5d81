// SPDX-License-Identifier: Apache-2.0
// Accuracy of a sweep's point, of pictures that are made wrong on purpose; and what each source of error does alone.
#include "trade/sweep_accuracy.hpp"

#include <cmath>
#include <memory>

#include "kage/light.hpp"
#include "plan/widths.hpp"
#include "test/support/catch.hpp"
#include "trade/sweep_run.hpp"

using namespace kage;
using namespace kage::trade;

namespace {

struct Swept {
  SweepPoint base;
  std::unique_ptr<SweepScene> scene;

  explicit Swept(const std::string& name) {
    const auto loaded = std::make_shared<const Scene>(Scene::load(name));
    const DrawOptions draw{.width = 64, .height = 48, .frames = 1, .threads = 1, .name = name};
    base.config = choose_config(*loaded, draw).config;
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
  CHECK(good.visible_wrong == 0);
  CHECK(good.gross_wrong == 0);
  CHECK(good.ray_pixels == 64 * 48);
  // A face that is elsewhere on the screen: the one of the first pixel that shows another than this one.
  DrawnFrame wrong = right;
  int changed = 0;
  for (std::size_t i = 5 * 64; i < right.face.size() && changed < 7; i += 97) {
    if (right.face[i] == kNothing) continue;
    wrong.face[i] = kNothing;
    ++changed;
  }
  REQUIRE(changed == 7);
  const PointAccuracy bad = s.accuracy(s.base, wrong);
  CHECK(bad.visible_wrong == 7);
  CHECK(bad.gross_wrong == 7);
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
  CHECK(bad.shadow_wrong == good.shadow_wrong + turned);
  CHECK(bad.gross_wrong > turned / 2);  // near an edge of a shadow both may be possible
  CHECK(bad.gross_wrong <= turned);
  CHECK(std::abs(bad.z_error_max_lsb - 1000) < 1);
  CHECK(*psnr(bad.all.squares, bad.all.pixels) < *psnr(good.all.squares, good.all.pixels));
  CHECK(bad.flip > good.flip);
  CHECK(*psnr(3.0 * 100, 100) == Approx(20 * std::log10(255.0)));
  CHECK_FALSE(psnr(0, 100));
}

TEST_CASE("the error of a point that differs from the finest in one source is that source's alone") {
  for (const char* name : {"courtyard", "penumbra", "glass"}) {
    Swept s(name);
    SweepPoint coarse = s.base;
    coarse = with(with(with(coarse, "SUB_BITS", "4"), "Z_BITS", "9"), "SHADE_FRAC", "3");
    if (samples_of(coarse) > 1) coarse = with(coarse, "SAMPLES", "3");
    coarse = with(coarse, "ORDER", "submission");
    for (const ErrorSource source : kErrorSources) {
      const SweepPoint one = s.scene->alone(coarse, source);
      CAPTURE(name, name_of(source));
      const PointAccuracy a = s.accuracy(one, s.drawn(one));
      for (const ErrorSource other : kErrorSources) {
        const auto e = s.scene->error_of(0, one, other);
        CHECK(e->squares == (other == source ? a.all.squares : 0));
        CHECK(e->visible_wrong == (other == source ? a.all.visible_wrong : 0));
        CHECK(e->shadow == (other == source ? a.all.shadow : 0));
      }
    }
    // Each of these shows, where the scene has what it is about.
    CHECK(s.scene->error_of(0, coarse, ErrorSource::snapping)->visible_wrong > 0);
    CHECK(s.scene->error_of(0, coarse, ErrorSource::color)->squares > 0);
    CHECK((s.scene->error_of(0, coarse, ErrorSource::samples)->shadow > 0) == (std::string(name) == "penumbra"));
    CHECK((s.scene->error_of(0, coarse, ErrorSource::order)->squares > 0) == (std::string(name) == "glass"));
  }
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
  const auto row = [](const char* scene, double wrong, double square, double cycles, double luts) {
    return Json{{"scene", scene},
                {"look", {{"width", 64}, {"height", 48}}},
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
