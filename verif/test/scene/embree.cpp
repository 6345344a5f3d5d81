// SPDX-License-Identifier: Apache-2.0
// Embree as Embree: surfaces and shadows of all built-in scenes and of real meshes on a ground. Each pixel
// that differs is a near tie, or Embree's single precision, which rays in double precision tell; none is wrong.
#include <fmt/format.h>

#include <cstdio>

#include "kage/light.hpp"
#include "oracle/embree_scene.hpp"
#include "stimulus/on_ground.hpp"
#include "test/support/catch.hpp"
#include "test/support/installed.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

RayCount compare(const SceneFrame& f) {
  Config config;
  const FrameGeometry g = make_geometry(f, config, kWidth, kHeight);
  const RayScene exact(f);
  return compare_with_rays(f, g, config, EmbreeScene(f), 1, &exact);
}

void report(const std::string& name, const RayCount& c, std::size_t most_near_percent = 2) {
  std::printf("| %s | %zu | %zu | %zu | %zu | %zu | %zu | %zu |\n", name.c_str(), static_cast<std::size_t>(c.pixels),
              static_cast<std::size_t>(c.lit), static_cast<std::size_t>(c.shadowed),
              static_cast<std::size_t>(c.near_surface), static_cast<std::size_t>(c.near_shadow),
              static_cast<std::size_t>(c.wrong_rays), static_cast<std::size_t>(c.wrong_surface + c.wrong_shadow));
  INFO(name << ": " << c.text());
  CHECK(c.good());
  CHECK(c.lit > 1000);
  CHECK(c.shadowed > 500);
  CHECK((c.near_surface + c.near_shadow) * 100 < c.pixels * most_near_percent);
  CHECK(c.wrong_rays * 1000 < c.pixels);
}

}  // namespace

TEST_CASE("built-in scenes and real meshes: Embree says what the picture says, but for near ties") {
  std::printf("| scene | pixels | lit | in shadow | near ties of surfaces | of shadows | Embree rounds | wrong |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    RayCount sum;
    for (int i = 0; i < scene.frame_count(); i += 3) {
      SceneFrame f = scene.frame(i, scene.frame_count());
      for (const Light& l : std::vector<Light>(f.lights)) {
        const auto points = light_points(l, 3, 1);
        Light alone;
        static_cast<LightPoint&>(alone) = points.back();
        f.lights = {alone};
        sum += compare(f);
      }
    }
    // In depths whole faces lie in one plane on purpose: 5.2 % of its pixels.
    report(name, sum, name == "depths" ? 6 : 2);
  }
  for (const char* file : {"horse.3ds", "cat.3ds", "bunny.obj"}) {
    const std::string path = glmark2(file);
    if (!present(path)) continue;
    const SceneFrame mesh = Scene::load(path).frame(1, 8);
    for (const double degrees : {12.0, 55.0})
      report(fmt::format("{}, sun at {} degrees", file, degrees), compare(on_ground(mesh, degrees)));
  }
}

}  // namespace kage::verif
