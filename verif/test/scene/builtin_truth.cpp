// SPDX-License-Identifier: Apache-2.0
// The built-in scenes: every frame's covered pixels, surfaces and shadows against the oracle and against rays, and
// polyhedra by segments against spans.
#include <string>

#include "oracle/judge.hpp"
#include "oracle/ray_truth.hpp"
#include "test/scene/scene_configs.hpp"
#include "test/support/catch.hpp"
#include "test/support/tree_frames.hpp"

namespace kage::verif {

TEST_CASE("built-in scenes: covered pixels, surfaces and shadows are the oracle's in every frame") {
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    Judgement sum;
    for (int i = 0; i < scene.frame_count(); ++i) {
      CAPTURE(name, i);
      const Judgement j =
          judge(make_geometry(scene.frame(i, scene.frame_count()), wide_enough(), 128, 96), wide_enough());
      INFO(j.text());
      CHECK(j.good());
      CHECK(j.shadowed > 0);
      sum.pixels += j.pixels;
      sum.surface_near += j.surface_near;
      sum.shadow_near += j.shadow_near;
    }
    // Near ties are pixels, not areas.
    CAPTURE(name, sum.surface_near, sum.shadow_near, sum.pixels);
    CHECK((sum.surface_near + sum.shadow_near) * 500 < sum.pixels);
  }
}

TEST_CASE("built-in scenes: surfaces and shadows are what rays say of the unsnapped scene") {
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    RayCount count;
    for (int i = 0; i < scene.frame_count(); ++i) {
      Config c;
      c.dsf_bits = i % 2 == 0 ? 1 : 2 + i / 2 % 3;  // parity, and counting of several widths
      count += compare_with_rays(scene.frame(i, scene.frame_count()), 160, 120, 1, c);
    }
    CAPTURE(name);
    UNSCOPED_INFO(name << ": " << count.text());
    CHECK(count.good());
    CHECK(count.lit > 1000);
    CHECK(count.shadowed > 1000);
    // The snap alone changes little, but in `edges`, whose edges run through pixel centres.
    CHECK((count.near_surface + count.near_shadow) * 50 < count.pixels);
  }
}

TEST_CASE("built-in scenes: polyhedra by segments and by spans give the same bits in every frame") {
  int with_polyhedra = 0;
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    int by_segments = 0;
    std::size_t polyhedra = 0;
    for (int i = 0; i < scene.frame_count(); ++i) {
      CAPTURE(name, i);
      Config c;
      c.smooth = i % 2;
      c.color_frac = 8 * c.smooth;
      c.translucency = translucent(scene) ? 1 : 0;
      const SceneFrame f = scene.frame(i, scene.frame_count());
      for (const SegmentCount& n : same_either_way(f, c, 128, 96)) by_segments += n.by_segments;
      polyhedra += make_geometry(f, c, 128, 96).polyhedra.size();
    }
    CAPTURE(name);
    CHECK((by_segments > 0) == (polyhedra > 0));
    with_polyhedra += polyhedra > 0 ? 1 : 0;
  }
  // The only convex body of `knot` is its floor, which w0 cuts in every frame.
  CHECK(with_polyhedra == static_cast<int>(builtin_scenes().size()) - 1);
}

}  // namespace kage::verif
