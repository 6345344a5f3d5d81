// SPDX-License-Identifier: Apache-2.0
// Real meshes of Debian's packages: how many triangles, and which of their parts are closed and convex.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "files.hpp"
#include "scene/space.hpp"
#include "test/support/catch.hpp"
#include "test/support/installed.hpp"

using namespace kage;
using test::TempDirectory;

TEST_CASE("real meshes") {
  struct Expected {
    const char* file;
    std::size_t triangles;
  };
  for (const Expected& e : {Expected{"horse.3ds", 7172},
                            {"bunny.obj", 69666},
                            {"cat.3ds", 14348},
                            {"asteroid-low.3ds", 480},
                            {"asteroid-high.3ds", 48000},
                            {"cube.3ds", 12}}) {
    const std::string path = verif::glmark2(e.file);
    if (!verif::present(path)) continue;
    const Scene s = Scene::load(path);
    const SceneFrame f = s.frame(3, 8);
    std::size_t closed = 0;
    std::size_t convex = 0;
    std::size_t counted = 0;
    for (const Component& c : f.components) {
      REQUIRE(c.first == counted);
      counted += c.count;
      closed += c.closed ? 1 : 0;
      convex += c.convex ? 1 : 0;
      REQUIRE(c.reason.empty() == c.convex);
    }
    std::printf("%s: %zu triangles, %zu vertices, %zu components, %zu closed, %zu convex\n", e.file, f.triangles.size(),
                f.vertices.size(), f.components.size(), closed, convex);
    CHECK(counted == f.triangles.size());
    CHECK(f.triangles.size() == e.triangles);
    double worst = 0;
    for (const ShadingVertex& v : f.shading) worst = std::max(worst, std::abs(kage::length(v.normal) - 1));
    CHECK(worst < 1e-12);
  }
}

TEST_CASE("topology of meshes from CGAL's demo") {
  struct Expected {
    const char* file;
    std::size_t triangles;
    std::size_t vertices;
    std::size_t components;
    std::size_t closed;
    std::size_t convex;
  };
  const std::string archive = verif::kCgalMeshes;
  if (!verif::present(archive)) return;
  const TempDirectory dir;
  REQUIRE(std::system(("tar xzf " + archive + " -C " + dir.path().string()).c_str()) == 0);
  for (const Expected& e : {Expected{"tetrahedron", 4, 4, 1, 1, 1},
                            {"cube_quad", 12, 8, 1, 1, 1},
                            {"icosahedron", 20, 12, 1, 1, 1},
                            {"cube-meshed", 1728, 866, 1, 1, 1},
                            {"geosphere", 320, 162, 1, 1, 1},
                            {"larger_sphere", 1620, 812, 1, 1, 1},
                            {"open_cube", 10, 8, 1, 0, 0},
                            {"star", 24, 14, 1, 1, 0},
                            {"eight", 634, 315, 1, 1, 0},
                            {"elephant", 5558, 2775, 1, 1, 0},
                            {"elephant-with-holes", 4463, 2733, 1, 0, 0},
                            {"knot2", 11520, 5760, 2, 2, 0}}) {
    INFO(e.file);
    const SceneFrame f =
        Scene::load((dir.path() / "data/meshes" / (std::string(e.file) + ".off")).string()).frame(0, 1);
    std::size_t closed = 0;
    std::size_t convex = 0;
    for (const Component& c : f.components) {
      closed += c.closed ? 1 : 0;
      convex += c.convex ? 1 : 0;
    }
    CHECK(f.triangles.size() == e.triangles);
    CHECK(f.vertices.size() == e.vertices);
    CHECK(f.components.size() == e.components);
    CHECK(closed == e.closed);
    CHECK(convex == e.convex);
  }
}
