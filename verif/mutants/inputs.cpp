// SPDX-License-Identifier: Apache-2.0
#include "mutants/inputs.hpp"

#include <array>

#include "cosim/core.hpp"
#include "stimulus/random_frames.hpp"
#include "stimulus/small_configs.hpp"

namespace kage::verif {
namespace {

// Frames of a sequence: the first are valid, the others damaged.
constexpr int kValid = 12;
constexpr int kDamaged = 36;

}  // namespace

std::vector<Inputs> trial_configurations() {
  std::vector<Inputs> all;
  const auto add = [&](const char* name, auto change) {
    const SmallConfig small = small_config(name, change);
    all.push_back({small.name, small.config, {}});
  };
  add("parity", [](Config& c) { c.shade_frac = 3; });
  add("grey",
      [](Config& c) { c.fsf = 0, c.dsf_bits = 2, c.channels = 1, c.lanes = 8, c.beat_words = 1, c.shade_frac = 2; });
  add("glass", [](Config& c) { c.dsf_bits = 3, c.smooth = 1, c.color_frac = 6, c.translucency = 1, c.beat_words = 2; });
  add("lights", [](Config& c) {
    c.smooth = 1, c.count_bits = 2, c.lights = 3, c.class_bits = 3, c.translucency = 1, c.shade_frac = 4;
  });
  add("linear",
      [](Config& c) { c.linear_bits = 10, c.smooth = 1, c.color_frac = 6, c.count_bits = 2, c.translucency = 1; });
  add("linear_systolic", [](Config& c) {
    c.linear_bits = 12, c.smooth = 1, c.color_frac = 4, c.fsf = 0, c.dsf_bits = 2, c.arrangement = 0;
  });
  add("linear_glass",
      [](Config& c) { c.linear_bits = 10, c.smooth = 1, c.color_frac = 2, c.translucency = 1, c.beat_words = 2; });
  add("units", [](Config& c) { c.units = 3, c.dx_bits = 6, c.face_bits = 4, c.seg_bits = 4, c.translucency = 1; });
  add("counting_systolic", [](Config& c) { c.dsf_bits = 3, c.arrangement = 0; });
  add("smooth_systolic", [](Config& c) { c.smooth = 1, c.color_frac = 6, c.arrangement = 0; });
  add("lights_systolic", [](Config& c) {
    c.fsf = 0, c.dsf_bits = 2, c.count_bits = 2, c.lights = 2, c.class_bits = 2, c.translucency = 1, c.arrangement = 0;
  });
  add("units_systolic", [](Config& c) { c.units = 2, c.dx_bits = 6, c.face_bits = 4, c.arrangement = 0; });
  add("polygons", [](Config& c) { c.active = 6; });
  add("polygons_lights", [](Config& c) {
    c.active = 12, c.smooth = 1, c.color_frac = 6, c.dsf_bits = 3, c.count_bits = 2, c.lights = 3, c.class_bits = 3;
    c.translucency = 1, c.beat_words = 2;
  });
  add("polygons_linear", [](Config& c) {
    c.active = 12, c.linear_bits = 10, c.smooth = 1, c.color_frac = 6, c.dsf_bits = 3, c.count_bits = 2;
    c.translucency = 1, c.beat_words = 2;
  });
  return all;
}

void make_frames(Inputs& inputs, std::uint64_t seed) {
  Random random(seed);
  struct Ports {
    int idle;
    int backpressure;
    bool busy;  // frames come to a core that has another frame, or was reset within one
  };
  constexpr std::array kPorts{Ports{0, 0, false}, Ports{30, 30, false}, Ports{0, 70, false}, Ports{0, 70, true}};
  for (const auto& [idle, backpressure, busy] : kPorts) {
    Sequence s;
    s.rtl.seed = seed;
    s.rtl.idle_percent = idle;
    s.rtl.backpressure_percent = backpressure;
    if (busy)
      s.rtl.prelude =
          RandomFrames(inputs.config, Manner::mixed, seed, inputs.config.active > 0 ? Level::polygons : Level::spans)
              .prelude();
    for (int i = 0; i < kValid + kDamaged; ++i) {
      auto& lines = s.lines.emplace_back();
      // A core with a front end takes both levels.
      const Level level = inputs.config.active > 0 && i % 4 != 3 ? Level::polygons : Level::spans;
      s.frames.push_back(cosim::known_frame(
          inputs.config,
          i < kValid ? sound_frame(random, inputs.config, static_cast<std::uint32_t>(i), level)
                     : damaged_frame(random, inputs.config, static_cast<std::uint32_t>(i), level),
          [&](int, std::span<const std::uint8_t> line) { lines.emplace_back(line.begin(), line.end()); }));
    }
    inputs.sequences.push_back(std::move(s));
  }
}

}  // namespace kage::verif
