// SPDX-License-Identifier: Apache-2.0
// Real meshes from Debian packages, held against the oracle: open, non-manifold, of many parts.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "kage/error.hpp"
#include "test/scene/shadow_checks.hpp"
#include "test/support/catch.hpp"
#include "test/support/installed.hpp"

namespace kage::verif {
namespace {

Config wide() {
  Config config;
  config.max_width = 2047;
  return config;
}

}  // namespace

TEST_CASE("real meshes: covered pixels, surfaces and shadows are the oracle's") {
  for (const char* file : {"horse.3ds", "bunny.obj", "cat.3ds", "asteroid-high.3ds", "asteroid-low.3ds"}) {
    const std::string path = glmark2(file);
    if (!present(path)) continue;
    const Scene scene = Scene::load(path);
    for (const auto& [frame, bits] : {std::pair{0, 1}, {3, 1}, {0, 2}, {3, 2}, {3, 3}, {0, 8}}) {
      Config config = wide();
      config.dsf_bits = bits;
      CAPTURE(path, frame, bits);
      const FrameGeometry g = make_geometry(scene.frame(frame, 8), config, 64, 48);
      if (bits == 8) CHECK(g.volumes.size() == 1);
      const Judgement j = judge(g, config);
      INFO(j.text());
      CHECK(j.good());
      CHECK(j.covered > 100);
      CHECK(j.shadowed > 0);
      CHECK((j.surface_near + j.shadow_near) * 50 < j.covered);
    }
  }
}

TEST_CASE("the meshes of CGAL's demo below 50000 faces: covered pixels, surfaces and shadows are the oracle's") {
  const std::string archive = kCgalMeshes;
  if (!present(archive)) return;
  const auto dir = std::filesystem::temp_directory_path() / ("kage-meshes-" + std::to_string(::getpid()));
  std::filesystem::create_directories(dir);
  REQUIRE(std::system(("tar xzf " + archive + " -C " + dir.string() + " --wildcards 'data/meshes/*.off'").c_str()) ==
          0);
  const Config config = wide();
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(dir / "data/meshes"))
    if (entry.is_regular_file()) files.insert(entry.path());  // Debian 13 has a folder among them
  std::size_t judged = 0;
  std::size_t large = 0;
  std::set<std::string> refused;
  for (const std::filesystem::path& path : files) {
    const std::string name = path.filename().string();
    CAPTURE(name);
    try {
      const SceneFrame frame = Scene::load(path.string()).frame(3, 8);
      if (frame.triangles.size() >= 50'000) {
        ++large;
        continue;
      }
      const Judgement j = judge(make_geometry(frame, config, 48, 36), config);
      INFO(j.text());
      CHECK(j.good());
      CHECK(j.covered > 50);
      CHECK((j.surface_near + j.shadow_near) * 50 < j.covered);
      // However many faces have a volume, the picture is the same.
      Look per_face;
      per_face.volumes = VolumeWay::per_face;
      const FrameGeometry simple = make_geometry(frame, config, 48, 36, {.look = per_face});
      for (const int bits : {1, 2, 4}) {
        CAPTURE(bits);
        Config counting = wide();
        counting.dsf_bits = bits;
        same_but_near_ties(simple, config, make_geometry(frame, counting, 48, 36), counting);
      }
      ++judged;
    } catch (const Error&) {
      refused.insert(name);
    }
  }
  CHECK(judged > 120);
  CHECK(judged + large + refused.size() == files.size());
  refused.erase("mesh_with_colors.off");  // names colours, which Assimp takes for numbers
  CAPTURE(refused);
  CHECK(refused.empty());
  std::filesystem::remove_all(dir);
}

}  // namespace kage::verif
