// SPDX-License-Identifier: Apache-2.0
// Translucent faces from frame to frame, in smooth colour, in one plane, and at every scale.
#include "kage/error.hpp"
#include "oracle/face_pixels.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 120;
constexpr int kHeight = 90;

Config glass(int smooth = 0) {
  Config c;
  c.translucency = 1;
  c.smooth = smooth;
  return c;
}

/// Glass through itself about the origin, every corner of its own colour; up to 250 faces.
SceneFrame random_glass(Random& random, int panes, int bodies) {
  SceneFrame f = random_scene(random, 1);
  const auto place = [&] { return glm::dvec3(random.real(-2, 2), random.real(-1.5, 1.5), random.real(-2, 2)); };
  for (int i = 0; i < panes + bodies; ++i)
    add_glass(f, i < panes ? pane_solid() : octahedron_solid(), place(), glm::dvec3(random.real(0.3, 1.5)),
              random_turn(random), {1, 1, 1}, static_cast<std::uint8_t>(random.in(60, 200)));
  for (Triangle& t : f.triangles)
    for (std::uint32_t& s : t.shading) {
      f.shading.push_back(f.shading[s]);
      f.shading.back().color = {random.real(0, 1), random.real(0, 1), random.real(0, 1)};
      s = static_cast<std::uint32_t>(f.shading.size()) - 1;
    }
  return f;
}

}  // namespace

TEST_CASE("family 14: a fragment of smooth colour has its face's colour and depth at every pixel") {
  Random random(test_seed(14));
  CAPTURE(test_seed(14));
  const Config config = glass(1);
  std::size_t cut = 0;
  std::size_t fans = 0;
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    const SceneFrame f = random_glass(random, random.in(2, 12), random.in(0, 3));
    Look look;
    look.translucent = TranslucentWay::submission;
    const FrameGeometry parts = make_geometry(f, config, kWidth, kHeight);
    const FrameGeometry whole = make_geometry(f, config, kWidth, kHeight, {.look = look});
    const FacePixels pixels = pixels_of_faces(parts, config);
    CHECK(pixels == pixels_of_faces(whole, config));
    int twice = 0;
    for (const auto& p : pixels) twice += std::get<0>(p.second) == 1 ? 0 : 1;
    CHECK(twice == 0);
    for (const ScreenFragment& s : parts.fragments) {
      cut += s.cut_count > 0 ? 1 : 0;
      fans += s.cut_count > 0 && s.polygon_count > 1 ? 1 : 0;
    }
  }
  CHECK(cut > 500);
  CHECK(fans > 20);  // cut by the near plane as well, so that a face is several polygons
}

TEST_CASE("an order kept from other frames changes no frame, whatever moved meanwhile") {
  Random random(test_seed(40));
  CAPTURE(test_seed(40));
  const Config config = glass();
  SceneFrame f = random_glass(random, 6, 2);
  TranslucentOrder kept;
  int changed = 0;
  std::vector<std::uint32_t> before;
  for (int i = 0; i < 120; ++i) {
    CAPTURE(i);
    switch (random.in(0, 5)) {
      case 0:  // a face's corner
        f.vertices[f.triangles.back().vertex[static_cast<std::size_t>(random.in(0, 2))]] +=
            glm::dvec3(random.real(-0.5, 0.5), random.real(-0.5, 0.5), 0);
        break;
      case 1:  // a face appears, or one vanishes
        f.triangles[f.triangles.size() - static_cast<std::size_t>(random.in(1, 12))].alpha =
            random.chance(0.5) ? 0 : 128;
        break;
      case 2:
        std::swap(f.triangles.back().vertex[0], f.triangles.back().vertex[1]);
        break;
      case 3:
        f = random_glass(random, random.in(0, 6), random.in(0, 2));
        break;
      case 4:
        f.camera.perspective = !f.camera.perspective;
        break;
      default:
        look_at(f.camera, {random.real(-4, 4), random.real(-2, 2), random.real(-4, 4)}, {0, 0, 0});
    }
    Look look;
    if (random.chance(0.1)) look.translucent = TranslucentWay::centroid;
    const auto words = words_of(make_geometry(f, config, kWidth, kHeight, {.look = look, .order = &kept}), config, 3);
    CHECK(words == words_of(make_geometry(f, config, kWidth, kHeight, {.look = look}), config));
    changed += words != before ? 1 : 0;
    before = words;
  }
  CHECK(changed > 60);
}

TEST_CASE("a build of the order that ended early changes no frame after it") {
  Random random(test_seed(41));
  CAPTURE(test_seed(41));
  const Config config = glass();
  struct Stop {};
  bool stop = true;
  OrderBuildOptions build;
  build.max_fragments = 2000;
  build.progress = [&stop](double) {
    if (stop) throw Stop{};
  };
  TranslucentOrder kept(build);
  const SceneFrame first = random_glass(random, 6, 2);
  const SceneFrame second = random_glass(random, 5, 2);
  const SceneFrame large = random_glass(random, 300, 0);
  const auto words = [&](const SceneFrame& f, TranslucentOrder* order) {
    return words_of(make_geometry(f, config, kWidth, kHeight, {.order = order}), config, 3);
  };
  for (const SceneFrame* f : {&first, &second, &first}) {
    stop = true;
    CHECK_THROWS_AS(words(*f, &kept), Stop);
    CHECK_THROWS_AS(words(*f, &kept), Stop);
    stop = false;
    CHECK_THROWS_AS(words(large, &kept), TooManyFragments);
    CHECK(words(*f, &kept) == words(*f, nullptr));
    CHECK(words(*f, &kept) == words(*f, nullptr));  // by the tree that is kept
    CHECK_THROWS_AS(words(large, &kept), TooManyFragments);
    CHECK(words(*f, &kept) == words(*f, nullptr));
  }
}

TEST_CASE("fragments for a core without a blender are refused before the first word") {
  Random random(test_seed(42));
  const FrameGeometry g = make_geometry(random_glass(random, 4, 0), glass(), kWidth, kHeight);
  CHECK(!g.fragments.empty());
  std::vector<std::uint32_t> words;
  CHECK_THROWS_AS(make_frame(g, Config{}, 0, words, {.threads = 1}), Error);
  CHECK(words.empty());
}

TEST_CASE("family 37: faces in one plane are drawn in the order of the mesh, from either side") {
  for (const double side : {1.0, -1.0}) {
    CAPTURE(side);
    SceneFrame f;
    for (int i = 0; i < 6; ++i)
      add_glass(f, pane_solid(), {0.25 * i - 0.75, 0.125 * i, 0}, {0.5, 0.5, 1}, Turn{}, {0.15 * i, 0.5, 0.3}, 120);
    look_at(f.camera, {0.25, 0.5, 4 * side}, {0, 0, 0});
    Look look;
    look.translucent = TranslucentWay::submission;
    CHECK(words_of(make_geometry(f, glass(), kWidth, kHeight), glass()) ==
          words_of(make_geometry(f, glass(), kWidth, kHeight, {.look = look}), glass()));
  }
}

TEST_CASE("the same scene, larger or smaller by any power of two, is the same frame") {
  Random random(test_seed(41));
  CAPTURE(test_seed(41));
  for (int i = 0; i < 12; ++i) {
    const SceneFrame f = random_glass(random, 5, 2);
    const FrameGeometry g = make_geometry(f, glass(), kWidth, kHeight);
    CHECK(!g.fragments.empty());
    for (const int exponent : {-330, -250, -200, -60, 60, 200, 250, 330}) {
      CAPTURE(i, exponent, f.camera.perspective);
      const double scale = std::ldexp(1.0, exponent);
      SceneFrame scaled = f;
      for (glm::dvec3& v : scaled.vertices) v *= scale;
      scaled.camera.eye *= scale;
      scaled.camera.near *= scale;
      if (!f.camera.perspective) scaled.camera.half_height *= scale;
      scaled.lights[0].position *= scale;
      const FrameGeometry s = make_geometry(scaled, glass(), kWidth, kHeight);
      CHECK(pixels_of_faces(s, glass()) == pixels_of_faces(g, glass()));
    }
  }
}

TEST_CASE("scenes of nothing but glass: one pixel, all of alpha 0, all edge-on, with and without shadows") {
  for (const int dsf_bits : {0, 5}) {
    CAPTURE(dsf_bits);
    Config config = glass();
    config.dsf_bits = dsf_bits;
    if (dsf_bits == 0) config.fsf = 0;
    for (const int kind : {0, 1, 2}) {
      CAPTURE(kind);
      SceneFrame f;
      add_glass(f, pane_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0, 0}, kind == 1 ? 0 : 128);
      add_glass(f, box_solid(), {0, 0, 0}, {0.5, kind == 2 ? 0 : 0.5, 0.5}, Turn{}, {0, 1, 0}, kind == 1 ? 0 : 90);
      look_at(f.camera, kind == 2 ? glm::dvec3(3, 0, 0) : glm::dvec3(1, 0.5, 3), {0, 0, 0});
      for (const auto& [width, height] : {std::pair{1, 1}, {1, 91}, {121, 1}, {kWidth, kHeight}}) {
        CAPTURE(width, height);
        const FrameGeometry g = make_geometry(f, config, width, height);
        CHECK(g.volumes.empty());
        CHECK(g.fragments.empty() == (kind != 0));
        CHECK(pixels_of_faces(g, config).empty() == (kind != 0));
      }
    }
  }
}

}  // namespace kage::verif
