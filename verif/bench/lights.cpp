// SPDX-License-Identifier: Apache-2.0
// How far the light of pictures, as kage render draws them, is from the reference (verif/oracle/light_reference.hpp).
// 320x240; errors in LSB of a channel: mean and worst over pixels in some shadow, then over those of faces that are in
// none. Then the same pixels in shadow by the steps to the truth that a core may take; what the last of these, light
// after light, gains and costs; and what dicing does.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "bench/light_steps.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr std::array kMaxShading{0, 4, 2, 1};

/// The same scenes with each of the steps that can have their lights, all with smooth colour.
void step_errors() {
  fmt::print("{:17}", "mean and worst");
  for (const LightStep& s : kLightSteps) fmt::print(" {:>15}", s.name);
  fmt::print("\n");
  for (const LitScene& lit : lit_scenes()) {
    const SceneFrame f = Scene::from(lit.parts).frame(0, 1);
    const RayScene rays(f);
    const auto reference =
        reference_picture(LightReference(f, rays, sampled_points(f, {}), kWidth, kHeight), kWidth, kHeight);
    fmt::print("{:17}", lit.name);
    Config plain;
    plain.shade_frac = 16;
    for (const LightStep& s : kLightSteps) {
      const std::optional<Config> c = config_of(s, f, plain);
      if (!c) {
        fmt::print(" {:>15}", "");
        continue;
      }
      Look look;
      look.darkening = s.darkening;
      const LightError e = compare_light(draw(make_geometry(f, *c, kWidth, kHeight, {.look = look}), *c), reference);
      fmt::print(" {:>15}", fmt::format("{:.2f}, {:.1f}", e.mean(), e.worst));
    }
    fmt::print("\n");
  }
}

void print_heading(std::string_view of) {
  fmt::print("{:17} {:13} {:>5} {:>8} {:>6} {:>6} {:>6} {:>6} {:>6}\n", of, "configuration", "ties", "shadowed", "mean",
             "worst", "else", "worst", "dB");
}

/// In thousands, rounded.
std::uint64_t thousands(std::uint64_t n) { return (n + 500) / 1000; }

/// The default choice beside light after light in a core of as many lanes and counters.
void light_after_light(const std::string& name, const Scene& scene) {
  const NamedConfig chosen = choose_config(scene, {.width = kWidth, .height = kHeight});
  const JudgedFrame of(scene, kWidth, kHeight);
  Config c = chosen.config;
  const auto print = [](const TakenFrame& t) {
    fmt::print(" {:6.2f} {:5.1f} {:5.1f} {:6} {:7}", t.error.mean(), t.error.worst, t.error.psnr(),
               thousands(4 * t.words), thousands(t.clocks));
  };
  fmt::print("{:17} {:13}", name, chosen.name);
  print(taken(of, c, {}));
  c.linear_bits = 12;
  c.smooth = c.lights = c.class_bits = 1;
  const auto& lights = of.drawn.lights;
  if (std::ranges::all_of(lights, [](const Light& l) { return l.shape == LightShape::point; })) c.count_bits = 0;
  if (c.count_bits > 0) c.count_bits = 4;
  c.color_frac = std::max(c.color_frac, 8);
  print(taken(of, c, {}));
  fmt::print("\n");
}

/// Each error of shading that is allowed, with what it leaves and what it takes.
void dicing(const std::string& name, const Scene& scene) {
  const NamedConfig chosen = choose_config(scene, {.width = kWidth, .height = kHeight});
  const Config& c = chosen.config;
  if (c.smooth == 0) return;
  const JudgedFrame of(scene, kWidth, kHeight);
  fmt::print("{:17} {:13}", name, chosen.name);
  for (const int most : kMaxShading) {
    Look look;
    look.max_shading = most;
    const TakenFrame t = taken(of, c, look);
    fmt::print(" {:6.1f} {:5} {:5}", t.error.psnr(), thousands(4 * t.words), thousands(t.clocks));
  }
  fmt::print("\n");
}

/// The default choice.
void reference_errors(const std::string& name, const Scene& scene) {
  const NamedConfig chosen = choose_config(scene, {.width = kWidth, .height = kHeight});
  const JudgedFrame of(scene, kWidth, kHeight);
  const FrameGeometry g = make_geometry(of.drawn, chosen.config, kWidth, kHeight);
  const LightError e = compare_light(draw(g, chosen.config), of.reference);
  fmt::print("{:17} {:13} {:5} {:8} {:6.2f} {:6.1f} {:6.2f} {:6.1f} {:6.1f}\n", name, chosen.name, e.ties, e.shadowed,
             e.mean(), e.worst, e.lit_mean(), e.lit_worst, e.psnr());
}

}  // namespace

int main(int argc, char** argv) {
  const std::string which = argc > 1 ? argv[1] : "";
  if (which.empty() || which == "light") {
    print_heading("scene");
    for (const LitScene& lit : lit_scenes()) reference_errors(lit.name, Scene::from(lit.parts));
  }
  if (which.empty() || which == "built-in") {
    print_heading("built-in scene");
    for (const std::string& name : builtin_scenes()) reference_errors(name, Scene::load(name));
  }
  if (which.empty() || which == "steps") step_errors();
  if (which.empty() || which == "passes") {
    fmt::print("{:31}{:>34}{:>34}\n", "steps, dB, kB", "default choice", "light after light");
    constexpr std::string_view kColumns = "   mean worst    dB     kB kclocks";
    fmt::print("{:17} {:13}{}{}\n", "", "configuration", kColumns, kColumns);
    for (const LitScene& lit : lit_scenes()) light_after_light(lit.name, Scene::from(lit.parts));
    for (const std::string& name : builtin_scenes()) light_after_light(name, Scene::load(name));
  }
  if (which.empty() || which == "dicing") {
    fmt::print("{:17} {:13}", "dB, kB, kclocks", "configuration");
    for (const int most : kMaxShading) fmt::print(" {:>18}", fmt::format("--max-shading {}", most));
    fmt::print("\n");
    for (const LitScene& lit : lit_scenes()) dicing(lit.name, Scene::from(lit.parts));
    for (const std::string& name : builtin_scenes()) dicing(name, Scene::load(name));
  }
}
