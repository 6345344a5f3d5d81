// SPDX-License-Identifier: Apache-2.0
// The built-in scenes: as their script writes them, as their descriptions promise, and the same bits everywhere.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>

#include "files.hpp"
#include "scene/transform.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using scene::dot;

namespace {

// FNV-1a over everything that geometry is given.
class Digest {
 public:
  void add(const void* data, std::size_t size) {
    const auto* p = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) hash_ = (hash_ ^ p[i]) * 1099511628211u;
  }
  void add(double v) { add(&v, sizeof v); }
  void add(const glm::dvec3& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037u;
};

std::uint64_t digest(const Scene& scene) {
  Digest d;
  for (int i = 0; i < scene.frame_count(); ++i) {
    const SceneFrame f = scene.frame(i, scene.frame_count());
    for (const glm::dvec3& v : {f.camera.eye, f.camera.right, f.camera.up, f.camera.forward}) d.add(v);
    for (const Light& l : f.lights) {
      for (const glm::dvec3& v : {l.direction, l.position, l.color, l.axis_u, l.axis_v}) d.add(v);
      for (const double v : {l.range, l.inner_cosine, l.outer_cosine}) d.add(v);
    }
    for (const double v : {f.camera.half_height, f.camera.near, f.camera.far}) d.add(v);
    for (const glm::dvec3& v : f.vertices) d.add(v);
    for (const ShadingVertex& v : f.shading) {
      d.add(v.normal);
      d.add(v.color);
    }
    for (const Triangle& t : f.triangles) {
      d.add(t.vertex.data(), sizeof t.vertex);
      d.add(t.shading.data(), sizeof t.shading);
    }
    for (const Component& c : f.components) {
      d.add(&c.count, sizeof c.count);
      d.add(c.closed ? 1.0 : c.convex ? 2.0 : 3.0);
    }
  }
  return d.value();
}

std::set<std::uint32_t> corners_of(const SceneFrame& f, const Component& c) {
  std::set<std::uint32_t> out;
  for (std::uint32_t t = c.first; t < c.first + c.count; ++t)
    out.insert(f.triangles[t].vertex.begin(), f.triangles[t].vertex.end());
  return out;
}

// Whether a point lies inside a convex component.
bool inside(const SceneFrame& f, const Component& c, const glm::dvec3& p) {
  for (std::uint32_t t = c.first; t < c.first + c.count; ++t) {
    const auto& v = f.triangles[t].vertex;
    const glm::dvec3 n = scene::cross(f.vertices[v[1]] - f.vertices[v[0]], f.vertices[v[2]] - f.vertices[v[0]]);
    if (dot(n, p - f.vertices[v[0]]) >= 0) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("scenes/make writes exactly the committed files") {
  if (std::system("python3 -c pass") != 0) {
    std::printf("SKIPPED: python3 is not installed\n");
    return;
  }
  CHECK(std::system(KAGE_SOURCE_DIR "/scenes/make --check") == 0);
}

TEST_CASE("a scene is the same, bit by bit, for every compiler and every Debian") {
  // Where this fails after scenes/make or the import changed on purpose, put in what it prints.
  const std::map<std::string, std::uint64_t> expected{
      {"courtyard", 0xdafad70fbe351606u}, {"knot", 0x8af285b312b7f4b5u},      {"inside", 0xd0a0767ce8552fcbu},
      {"edges", 0x28d72d74e6a81245u},     {"polyhedra", 0xb71340f8b132bc80u}, {"fifteen", 0x9da0d5ea69866ecau},
      {"glass", 0x68def4c55b2cad88u},     {"penumbra", 0xb7d8de047a0c80d1u},  {"three-lights", 0x16ec070fa193bb97u},
      {"canopy", 0x0c0c389308a78020u},    {"cutaway", 0xd57ec2803820da01u},   {"depths", 0xd6c54698bdcbd25cu}};
  for (const std::string& name : builtin_scenes()) {
    const std::uint64_t found = digest(Scene::load(name));
    INFO(fmt::format("{{\"{}\", {:#018x}u}},", name, found));
    CHECK((expected.count(name) == 1 && expected.at(name) == found));
  }
}

TEST_CASE("every built-in scene: frames, orthonormal cameras, nothing left out") {
  const std::map<std::string, int> frames{{"courtyard", 8},    {"knot", 8},    {"inside", 8},  {"edges", 2},
                                          {"polyhedra", 8},    {"fifteen", 8}, {"glass", 8},   {"penumbra", 8},
                                          {"three-lights", 8}, {"canopy", 8},  {"cutaway", 8}, {"depths", 4}};
  for (const std::string& name : builtin_scenes()) {
    INFO(name);
    const Scene s = Scene::load(name);
    CHECK(s.name() == name);
    CHECK(s.frame_count() == frames.at(name));
    CHECK(s.notes().empty());
    CHECK(s.needs_smooth() == (name == "knot" || name == "penumbra" || name == "three-lights"));
    for (int i = 0; i < s.frame_count(); ++i) {
      const Camera c = s.frame(i, s.frame_count()).camera;
      for (const glm::dvec3& v : {c.right, c.up, c.forward}) CHECK(std::abs(dot(v, v) - 1) < 1e-14);
      CHECK(std::abs(dot(c.right, c.up)) < 1e-14);
      CHECK(std::abs(dot(c.up, c.forward)) < 1e-14);
      CHECK(dot(scene::cross(c.right, c.up), c.forward) < 0);  // right-handed, looking along -z
    }
  }
}

TEST_CASE("courtyard: all casters are convex, and the camera keeps clear of them") {
  const Scene s = Scene::load("courtyard");
  for (int i = 0; i < 8; ++i) {
    const SceneFrame f = s.frame(i, 8);
    CHECK(f.components.size() == 20);
    for (const Component& c : f.components) {
      CHECK(c.convex);
      // The eye is further outside some face than the near plane's farthest corner lies from it.
      double outside = -1e9;
      for (std::uint32_t t = c.first; t < c.first + c.count; ++t) {
        const auto& v = f.triangles[t].vertex;
        const glm::dvec3 n = scene::unit(
            scene::cross(f.vertices[v[1]] - f.vertices[v[0]], f.vertices[v[2]] - f.vertices[v[0]]), {0, 0, 0});
        outside = std::max(outside, dot(n, f.camera.eye - f.vertices[v[0]]));
      }
      CHECK(outside > 2 * f.camera.near);
    }
  }
}

TEST_CASE("knot: one closed part that is not convex, over a floor that is") {
  const SceneFrame f = Scene::load("knot").frame(0, 8);
  REQUIRE(f.components.size() == 2);
  CHECK(f.components[0].convex);
  CHECK(f.components[1].closed);
  CHECK_FALSE(f.components[1].convex);
  CHECK(f.components[1].count >= 1500);
  CHECK(f.components[1].count <= 3000);
  CHECK_FALSE(f.lights[0].directional);
}

TEST_CASE("inside: the eye within volumes, the near plane cut by several") {
  // Rays from points of the near plane to the light, against every caster: the share that each shadows
  // (scenes/README.md).
  const Scene s = Scene::load("inside");
  bool whole = false;
  std::size_t most_cut = 0;
  for (int i = 0; i < 8; ++i) {
    const SceneFrame f = s.frame(i, 8);
    const Camera& c = f.camera;
    constexpr int kX = 40;
    constexpr int kY = 30;
    std::vector<int> hits(f.components.size(), 0);
    for (int k = 0; k < kX * kY; ++k) {
      const int column = k % kX;
      const int row = k / kX;
      const double x = ((column + 0.5) * 2 / kX - 1) * c.half_height * kX / kY;
      const double y = ((row + 0.5) * 2 / kY - 1) * c.half_height;
      const glm::dvec3 p = c.eye + (c.forward + c.right * x + c.up * y) * c.near;
      const glm::dvec3 ray = f.lights[0].position - p;
      for (std::size_t n = 0; n < f.components.size(); ++n) {
        // Convex: the ray is cut down by each face's plane.
        double enter = 0;
        double leave = 1;
        for (std::uint32_t t = f.components[n].first; t < f.components[n].first + f.components[n].count; ++t) {
          const auto& v = f.triangles[t].vertex;
          const glm::dvec3 normal =
              scene::cross(f.vertices[v[1]] - f.vertices[v[0]], f.vertices[v[2]] - f.vertices[v[0]]);
          const double from = dot(normal, p - f.vertices[v[0]]);
          const double along = dot(normal, ray);
          if (along < 0) enter = std::max(enter, -from / along);
          if (along > 0) leave = std::min(leave, -from / along);
          if (along == 0 && from > 0) leave = -1;
        }
        hits[n] += enter < leave ? 1 : 0;
      }
    }
    std::size_t cut = 0;
    for (const int n : hits) {
      cut += n > 0 && n < kX * kY ? 1 : 0;
      whole = whole || n == kX * kY;
    }
    most_cut = std::max(most_cut, cut);
  }
  CHECK(whole);
  CHECK(most_cut >= 4);
}

TEST_CASE("polyhedra: convex bodies of 4 to 126 faces, through each other and out of the picture on each side") {
  const Scene s = Scene::load("polyhedra");
  std::set<std::uint32_t> counts;
  // By side: left, right, below, above. Out: seen in one frame and gone past that side in another, in either order.
  std::array<bool, 4> cut{};
  std::array<std::set<std::size_t>, 4> past;
  std::set<std::size_t> seen;
  std::size_t pierced = 0;
  for (int i = 0; i < 8; ++i) {
    const SceneFrame f = s.frame(i, 8);
    REQUIRE(f.components.size() == 45);
    CHECK(f.lights[0].directional);
    for (std::size_t n = 0; n < f.components.size(); ++n) {
      const Component& c = f.components[n];
      CHECK(c.convex);
      CHECK(c.polygon_count >= 4);
      CHECK(c.polygon_count <= 126);
      if (i == 0) counts.insert(c.polygon_count);
      const std::set<std::uint32_t> corners = corners_of(f, c);
      std::array<std::size_t, 4> outside{};
      for (const std::uint32_t v : corners) {
        const glm::dvec3 e = f.vertices[v] - f.camera.eye;
        const double w = dot(e, f.camera.forward);
        CHECK(w > f.camera.near);  // so that every frame of every body can go through a unit
        const double x = dot(e, f.camera.right) / (w * f.camera.half_height * 4 / 3);
        const double y = dot(e, f.camera.up) / (w * f.camera.half_height);
        outside[0] += x < -1 ? 1 : 0;
        outside[1] += x > 1 ? 1 : 0;
        outside[2] += y < -1 ? 1 : 0;
        outside[3] += y > 1 ? 1 : 0;
      }
      bool gone = false;
      for (std::size_t side = 0; side < 4; ++side) {
        if (outside[side] == corners.size()) past[side].insert(n);
        gone = gone || outside[side] == corners.size();
        cut[side] = cut[side] || (outside[side] > 0 && outside[side] < corners.size());
      }
      if (!gone) seen.insert(n);
      // Some corner of another body lies inside this one.
      bool holds = false;
      for (std::size_t m = 0; m < f.components.size() && !holds; ++m) {
        if (m == n) continue;
        for (const std::uint32_t v : corners_of(f, f.components[m])) holds = holds || inside(f, c, f.vertices[v]);
      }
      pierced += holds ? 1 : 0;
    }
  }
  CHECK(counts.size() >= 15);
  CHECK(*counts.begin() == 4);
  CHECK(*counts.rbegin() == 126);
  for (std::size_t side = 0; side < 4; ++side) {
    CAPTURE(side);
    CHECK(cut[side]);
    CHECK(std::any_of(past[side].begin(), past[side].end(), [&](std::size_t n) { return seen.count(n) > 0; }));
  }
  CHECK(pierced >= std::size_t{8} * 8);
}

TEST_CASE("glass: panes and bodies of glass among opaque ones, all of them seen through something") {
  const Scene s = Scene::load("glass");
  const SceneFrame f = s.frame(0, s.frame_count());
  std::size_t panes = 0;
  std::size_t bodies = 0;
  std::size_t opaque = 0;
  for (const Component& c : f.components) {
    panes += c.translucent && !c.closed ? 1 : 0;
    bodies += c.translucent && c.convex ? 1 : 0;
    opaque += !c.translucent && c.convex ? 1 : 0;
    for (std::uint32_t t = c.first; t < c.first + c.count; ++t) CHECK((f.triangles[t].alpha < 255) == c.translucent);
    // Translucent triangles are faces of their own, however flat their body.
    if (c.translucent) CHECK(c.polygon_count == c.count);
  }
  CHECK(panes == 10);
  CHECK(bodies == 3);
  CHECK(opaque >= 6);
}

TEST_CASE("fifteen: eight bodies of fifteen faces, one before another") {
  const Scene s = Scene::load("fifteen");
  for (int i = 0; i < 8; ++i) {
    const SceneFrame f = s.frame(i, 8);
    REQUIRE(f.components.size() == 8);
    for (const Component& c : f.components) {
      CHECK(c.convex);
      CHECK(c.polygon_count == 15);
    }
    // Bodies on the stage that have a corner behind another body.
    std::size_t hidden = 0;
    for (std::size_t n = 1; n < f.components.size(); ++n) {
      bool behind = false;
      for (const std::uint32_t v : corners_of(f, f.components[n]))
        for (std::size_t m = 1; m < f.components.size(); ++m)
          for (int step = 100; m != n && step < 200; ++step)
            behind =
                behind || inside(f, f.components[m], f.camera.eye + (f.vertices[v] - f.camera.eye) * (step / 200.0));
      hidden += behind ? 1 : 0;
    }
    CHECK(hidden >= 3);
  }
}

TEST_CASE("edges: vertices on pixel centres in the first frame, half a pixel away in the second") {
  const Scene s = Scene::load("edges");
  const auto on_centres = [&](int frame) {
    const SceneFrame f = s.frame(frame, 2);
    CHECK(f.camera.half_height == 240);
    CHECK_FALSE(f.camera.perspective);
    std::size_t n = 0;
    for (const glm::dvec3& v : f.vertices) {
      const double x = dot(v - f.camera.eye, f.camera.right) + 320;
      const double y = 240 - dot(v - f.camera.eye, f.camera.up);
      n += x - std::floor(x) == 0.5 && y - std::floor(y) == 0.5 ? 1 : 0;
    }
    return n;
  };
  CHECK(on_centres(0) > 150);
  CHECK(on_centres(1) < 100);
}
