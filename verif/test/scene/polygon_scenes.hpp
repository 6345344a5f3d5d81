// SPDX-License-Identifier: Apache-2.0
//
// Built-in scenes at both levels.
#pragma once

#include <vector>

#include "kage/geometry.hpp"
#include "oracle/light_truth.hpp"
#include "test/scene/scene_configs.hpp"
#include "test/support/catch.hpp"
#include "test/support/polygon_level.hpp"

namespace kage::verif {

/// The configurations that a scene is drawn with here: by parity flat, smooth, with units and by counting, with what it
/// needs of blending and light counters.
inline std::vector<Config> polygon_configs_for(const Scene& scene) {
  std::vector<Config> all;
  for (int way = 0; way < 4; ++way) {
    Config c = wide_enough();
    c.active = kUsualActive;
    c.smooth = way == 1 ? 1 : 0;
    c.color_frac = 8 * c.smooth;
    c.units = way == 2 ? 16 : 0;
    c.dsf_bits = way == 3 ? 4 : 1;
    c.translucency = translucent(scene) ? 1 : 0;
    all.push_back(config_for_lights(scene.frame(0, scene.frame_count()), Look{}.samples, c));
  }
  return all;
}

/// Every `step`th frame of all scenes in all of them: the same tokens, origins and pixels.
inline void check_both_levels(int width, int height, int step) {
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    for (const Config& c : polygon_configs_for(scene))
      for (int i = 0; i < scene.frame_count(); i += step) {
        const SceneFrame f = scene.frame(i, scene.frame_count());
        CAPTURE(name, i, width, c.smooth, c.units, c.dsf_bits);
        const BothLevels both = both_levels(make_geometry(f, c, width, height), c);
        INFO(both.fault);
        CHECK(both.fault.empty());
        CHECK(both.counts.made > 0);
      }
  }
}

}  // namespace kage::verif
