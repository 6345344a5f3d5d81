// SPDX-License-Identifier: Apache-2.0
// Real meshes from Debian packages, held against rays through the unsnapped mesh: what the whole way from mesh to pixel
// gets wrong must be what the snap to 1/256 pixel can do.
//
// `scene_rays "[full]" -s` does every pixel of 640x480 and prints how many pixels the snap changes (minutes).
#include "oracle/ray_truth.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr const char* kMeshes = "/usr/share/glmark2/models/";

void check_mesh(const std::string& file, int width, int height, int step) {
  const Scene scene = Scene::load(kMeshes + file);
  RayCount count;
  for (const int frame : {0, 3}) count += compare_with_rays(scene.frame(frame, 8), width, height, step);
  INFO(file << ": " << count.text());
  CHECK(count.good());
  CHECK(count.lit > 0);
  CHECK(count.shadowed > 0);
  // Only the snap changes these.
  CHECK((count.near_surface + count.near_shadow) * 50 < count.lit + count.shadowed);
}

}  // namespace

TEST_CASE("real meshes: surfaces and shadows are what rays say of the unsnapped mesh") {
  check_mesh("horse.3ds", 640, 480, 5);
  check_mesh("cat.3ds", 640, 480, 8);
  check_mesh("asteroid-high.3ds", 640, 480, 16);
  check_mesh("bunny.obj", 640, 480, 19);
}

TEST_CASE("real meshes at every pixel of 640x480", "[.][full]") {
  for (const char* file : {"horse.3ds", "cat.3ds", "asteroid-high.3ds", "bunny.obj"}) check_mesh(file, 640, 480, 1);
}

}  // namespace kage::verif
