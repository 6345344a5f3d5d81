// SPDX-License-Identifier: Apache-2.0
// Shadow volumes that are kept change no frame, however eye, lights and casters move; and they save the work.
#include <algorithm>

#include "kage/error.hpp"
#include "kage/frontend.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

std::vector<std::uint32_t> words_of(const SceneFrame& f, const Config& c, ShadowCache* kept) {
  Look look;
  look.samples = 3;
  std::vector<std::uint32_t> words;
  make_frame(make_geometry(f, c, 64, 48, {.look = look, .shadows = kept}), c, 0, words, {.threads = 1});
  return words;
}

void move(SceneFrame& f, std::size_t component, const glm::dvec3& by) {
  std::vector<bool> moved(f.vertices.size(), false);
  const Component& part = f.components[component];
  for (std::uint32_t p = part.first_polygon; p < part.first_polygon + part.polygon_count; ++p)
    for (const std::uint32_t v : f.outline(f.polygons[p]))
      if (!moved[v]) {
        f.vertices[v] += by;
        moved[v] = true;
      }
}

}  // namespace

TEST_CASE("kept shadow volumes change no word, whatever moves, appears, goes or turns") {
  Random random(test_seed());
  CAPTURE(test_seed());
  ShadowCache kept;
  for (int scene = 0; scene < 12; ++scene) {
    SceneFrame f = random_scene(random, 4, scene % 3 != 0);
    f.components.back().closed = f.components.back().convex = false;
    Config c;
    c.count_bits = 2;
    c.dsf_bits = 1 + scene % 3;
    if (scene % 2 == 0) {
      f.lights[0].directional = false;
      f.lights[0].shape = LightShape::sphere;
      f.lights[0].axis_u = {0.3, 0, 0};
    }
    for (int step = 0; step < 12; ++step) {
      CAPTURE(scene, step);
      switch (random.in(0, 6)) {
        case 0:
          break;  // nothing moves
        case 1:
          look_at(f.camera, {random.real(-4, 4), random.real(-1, 4), random.real(-4, 4)}, {0, 0, 0});
          break;
        case 2:
          f.lights[0].position += glm::dvec3(random.real(-1, 1), 0, 0);
          f.lights[0].direction = random_direction(random);
          break;
        case 3:
          move(f, static_cast<std::size_t>(random.in(0, static_cast<int>(f.components.size()) - 1)),
               {random.real(-1, 1), 0, random.real(-1, 1)});
          break;
        case 4:
          add_solid(f, octahedron_solid(), {random.real(-2, 2), 1, 0}, {0.4, 0.4, 0.4}, random_turn(random), {1, 1, 1},
                    false, random.chance(0.5));
          break;
        case 5:  // one face the other way round: the same corners, another component
          std::swap(f.corners[f.polygons.back().first], f.corners[f.polygons.back().first + 1]);
          break;
        default:  // as far away as nothing else, which moves what a point light takes for edge-on
          move(f, 0, {random.real(-20, 20), 0, 0});
      }
      CHECK(words_of(f, c, &kept) == words_of(f, c, nullptr));
      CHECK(words_of(f, c, &kept) == words_of(f, c, nullptr));
    }
  }
}

TEST_CASE(
    "what is kept is made again when the light turns, a corner moves, or a face becomes edge-on by the scene's size") {
  // A sheet folded three times, whose folds lie over each other as the light sees them, or do not.
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {6, 0.2, 6}, Turn{}, {1, 1, 1});
  Solid s;
  for (int i = 0; i <= 3; ++i)
    for (const double z : {-1.0, 1.0}) s.vertices.emplace_back(i % 2 == 0 ? -1 : 1, 0.7 * i, z);
  for (std::uint32_t i = 0; i < 3; ++i) {
    s.faces.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    s.faces.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  const std::size_t first = f.vertices.size();
  add_solid(f, s, {0, -1, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
  look_at(f.camera, {4, 5, 6}, {0, -2, 0});
  f.lights[0].direction = glm::normalize(glm::dvec3(0.05, -1, 0.04));
  for (const int bits : {1, 2}) {
    CAPTURE(bits);
    Config c;
    c.dsf_bits = bits;
    ShadowCache kept;
    const auto same = [&](const SceneFrame& frame) {
      auto words = words_of(frame, c, &kept);
      CHECK(words == words_of(frame, c, nullptr));
      return words;
    };
    SceneFrame now = f;
    const auto before = same(now);
    now.lights[0].direction = glm::normalize(glm::dvec3(1, -0.4, 0.3));
    CHECK(same(now) != before);
    now = f;
    CHECK(same(now) == before);
    for (std::size_t v : {first + 6, first + 7}) now.vertices[v] += glm::dvec3(-6, 0, 0);  // unfolded at the top
    CHECK(same(now) != before);
    for (std::size_t v : {first + 2, first + 3}) now.vertices[v] += glm::dvec3(-6, 0, 0);
    same(now);
  }
  // The plane of a face passes the light at 1e-8: far enough in a small scene, not in a large one.
  SceneFrame e;
  add_solid(e, Solid{{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, -1, 1}}, {{0, 2, 1}, {1, 2, 3}}}, {0, 0, 0}, {1, 1, 1},
            Turn{}, {1, 1, 1}, false, false);
  add_solid(e, box_solid(), {0, -2, 0}, {1, 0.1, 1}, Turn{}, {1, 1, 1}, false, true);
  look_at(e.camera, {3, 1, 4}, {0, -1, 0});
  e.lights[0].directional = false;
  e.lights[0].position = {-2, 1e-8, -2};
  Look all;
  all.leave_out = false;
  ShadowCache kept;
  const auto caps_and_sides = [&](ShadowCache* c) {
    return make_geometry(e, Config{}, 64, 48, {.look = all, .shadows = c}).volume_faces.size();
  };
  const std::size_t with = caps_and_sides(&kept);
  move(e, 1, {0, 0, -50});
  CHECK(caps_and_sides(&kept) < with);
  CHECK(caps_and_sides(&kept) == caps_and_sides(nullptr));
}

TEST_CASE(
    "what is kept is made again when a light or a caster goes and comes back, or volumes are wanted another way") {
  // The same on both sides of x = 0, so that a light there and its mirror image are as far from everything.
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {6, 0.2, 6}, Turn{}, {1, 1, 1});
  for (const double x : {-1.5, 1.5}) add_solid(f, tetrahedron_solid(), {x, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false);
  look_at(f.camera, {0.5, 4, 9}, {0, -2, 0});
  f.lights[0].directional = false;
  f.lights[0].position = {3, 3, 1};
  Config c;
  Look look;
  ShadowCache kept;
  const auto same = [&] {
    const auto words = [&](ShadowCache* cache) {
      std::vector<std::uint32_t> w;
      make_frame(make_geometry(f, c, 64, 48, {.look = look, .shadows = cache}), c, 0, w, {.threads = 1});
      return w;
    };
    const auto with = words(&kept);
    CHECK(with == words(nullptr));
    return with;
  };
  const auto first = same();
  f.lights[0].position.x = -3;
  CHECK(same() != first);
  f.lights[0].position.x = 3;
  CHECK(same() == first);
  // Turned over, and back.
  const std::vector<glm::dvec3> vertices = f.vertices;
  for (std::size_t v = f.vertices.size() - 4; v < f.vertices.size(); ++v) f.vertices[v].y *= -1;
  CHECK(same() != first);
  f.vertices = vertices;
  CHECK(same() == first);
  look.volumes = VolumeWay::per_face;
  CHECK(same() != first);
  look.volumes = VolumeWay::fewest;
  CHECK(same() == first);
  for (const int bits : {2, 4, 1, 4}) {
    c.dsf_bits = bits;
    same();
  }
}

TEST_CASE("a configuration that counts may do without FSF, and is refused where one volume will not do") {
  Needs needs;
  needs.shadows = needs.several_volumes = true;
  Config c;
  c.fsf = 0;
  CHECK(lacks(c, needs).size() == 1);
  c.dsf_bits = 2;
  CHECK(lacks(c, needs).empty());
  SceneFrame f;
  for (int i = 0; i < 3; ++i) add_solid(f, box_solid(), {0, 3.0 * i, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  look_at(f.camera, {5, 6, 7}, {0, 0, 0});
  f.lights[0].direction = {0, -1, 0};
  CHECK_NOTHROW(words_of(f, c, nullptr));
  add_solid(f, box_solid(), {0, 9, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  CHECK_THROWS_AS(words_of(f, c, nullptr), Error);
}

}  // namespace kage::verif
