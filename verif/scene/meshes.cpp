// SPDX-License-Identifier: Apache-2.0
// Real meshes from Debian packages, held against the oracle: open, non-manifold, of many parts. A mesh that is not
// installed is named.
#include <filesystem>

#include "catch.hpp"
#include "scene/judge.hpp"

namespace kage::verif {

TEST_CASE("real meshes: coverage, surfaces and shadows are the oracle's") {
  Config config;
  config.max_width = 2047;
  for (const char* file : {"horse.3ds", "bunny.obj", "cat.3ds", "asteroid-high.3ds", "asteroid-low.3ds"}) {
    const std::string path = std::string("/usr/share/glmark2/models/") + file;
    if (!std::filesystem::exists(path)) {
      WARN("not installed, not tested: " << path);
      continue;
    }
    const Scene scene = Scene::load(path);
    for (const int frame : {0, 3}) {
      CAPTURE(path, frame);
      const Judgement j = judge(make_geometry(scene.frame(frame, 8), config, 64, 48), config);
      INFO(j.text());
      CHECK(j.good());
      CHECK(j.covered > 100);
      CHECK(j.shadowed > 0);
      CHECK((j.surface_near + j.shadow_near) * 50 < j.covered);
    }
  }
}

}  // namespace kage::verif
