// SPDX-License-Identifier: Apache-2.0
// The cost of a light's samples: geometry, front end and golden core, at 640x480.
#include <fmt/format.h>

#include <algorithm>

#include "bench/timer.hpp"
#include "oracle/light_truth.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

void sample_costs(const Scene& scene) {
  fmt::print("{}: golden core by samples, 640x480, least of 5 runs\n", scene.name());
  const SceneFrame f = scene.frame(0, scene.frame_count());
  for (const int samples : {1, 2, 4, 8, 16, 32, 64, 128, 255}) {
    Config c = config_for_lights(f, 255);
    Look look;
    look.samples = samples;
    bench::Timer timer;
    const FrameGeometry g = make_geometry(f, c, 640, 480, {.look = look});
    const double geometry = timer.seconds();
    std::vector<std::uint32_t> words;
    timer = {};
    make_frame(g, c, 0, words, {.threads = 1});
    const double front_end = timer.seconds();
    const TokenCounts counts = check_frame(c, words, "frame", 0);
    GoldenCore core(c);
    double best = 1e9;
    for (int r = 0; r < 5; ++r) {
      timer = {};
      (void)core.frame(words, [](int, std::span<const std::uint8_t>) {});
      best = std::min(best, timer.seconds());
    }
    const double pixels = 640.0 * 480;
    fmt::print(
        "  {:3} samples: geometry {:7.2f} ms, front end {:7.2f} ms, {:8} spans, {:6.1f} span pixels a pixel, golden "
        "{:7.2f} ns a pixel, {:5.2f} a sample\n",
        samples, geometry * 1e3, front_end * 1e3, counts.spans, static_cast<double>(counts.span_pixels) / pixels,
        best * 1e9 / pixels, best * 1e9 / pixels / samples);
  }
}

}  // namespace

int main() { sample_costs(Scene::load("penumbra")); }
