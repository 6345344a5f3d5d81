// SPDX-License-Identifier: Apache-2.0
// Small defects of polyhedra are found in three ways. Rays through the unsnapped scene find errors from the geometry
// on. The judge finds the front end's errors in right outlines. Defects below the errors that both excuse are found
// by the law that segments and spans give the same bits.
#include "oracle/ray_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"
#include "test/support/tree_frames.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

Config eight_units() {
  Config c;
  c.units = 8;
  return c;
}

SceneFrame forty() {
  static const Scene scene = Scene::load("polyhedra");
  return scene.frame(2, scene.frame_count());
}

/// A box whose faces are of two triangles each, an octahedron that pierces it, and a floor.
SceneFrame pierced() {
  SceneFrame f;
  const Turn turn{glm::normalize(glm::dvec3(3, 0, -1)), {0, 1, 0}, glm::normalize(glm::dvec3(1, 0, 3))};
  add_solid(f, box_solid(), {0, 0, 0}, {1.2, 1, 0.8}, turn, {1, 0.6, 0.2});
  Random random(5);
  add_solid(f, octahedron_solid(), {0.2, 0.1, 1.1}, {1.1, 1.1, 1.1}, random_turn(random), {0.2, 0.6, 1});
  add_solid(f, box_solid(), {0, -2, 0}, {4, 0.2, 4}, Turn{}, {1, 1, 1});
  look_at(f.camera, {1.2, 1.6, 5}, {0, -0.2, 0});
  f.lights[0].direction = glm::normalize(glm::dvec3(-0.5, -1, -0.3));
  return f;
}

struct Told {
  Judgement judge;
  RayCount rays;
};

Told tell(const SceneFrame& f, const FrameGeometry& g) {
  return {judge(g, eight_units()), compare_with_rays(f, g, eight_units())};
}

/// Right as it is, and drawn by segments, so that what is told is a defect of those.
FrameGeometry sound(const SceneFrame& f) {
  FrameGeometry g = make_geometry(f, eight_units(), kWidth, kHeight);
  REQUIRE(picture(g, eight_units()).by_segments() > 0);
  const Told truth = tell(f, g);
  INFO(truth.judge.text() << truth.rays.text());
  REQUIRE(truth.judge.good());
  REQUIRE(truth.rays.good());
  return g;
}

void move(ScreenVertex& v, int axis, int subpixels) { (axis == 0 ? v.x : v.y) += subpixels; }

}  // namespace

TEST_CASE("defects: polyhedra moved by 2 to 4 subpixels are told by rays") {
  const SceneFrame f = forty();
  const FrameGeometry whole = sound(f);
  for (const int axis : {0, 1})
    for (const int by : {-4, -3, -2, 2, 3, 4}) {
      CAPTURE(axis, by);
      FrameGeometry g = whole;
      for (ScreenVertex& v : g.vertices) move(v, axis, by);
      for (PolyhedronEdge& e : g.polyhedron_edges) {
        move(e.from, axis, by);
        move(e.to, axis, by);
      }
      const RayCount rays = compare_with_rays(f, g, eight_units());
      INFO(rays.text());
      CHECK(rays.wrong_surface > 5);
    }
}

TEST_CASE("defects: edges of polyhedra moved by 1 to 4 subpixels from their outlines are told by the judge") {
  const FrameGeometry whole = sound(forty());
  for (const int axis : {0, 1})
    for (const int by : {-4, -2, -1, 1, 2, 4}) {
      CAPTURE(axis, by);
      FrameGeometry g = whole;
      for (PolyhedronEdge& e : g.polyhedron_edges) {
        move(e.from, axis, by);
        move(e.to, axis, by);
      }
      const Judgement j = judge(g, eight_units());
      INFO(j.text());
      CHECK(j.cover_wrong + j.surface_gross > 5);
    }
}

TEST_CASE(
    "defects: a corner of a merged face that is out of its plane by a hundredth of its distance is told by rays") {
  const SceneFrame f = pierced();
  const FrameGeometry whole = sound(f);
  const auto sound_picture = draw(whole, eight_units());
  int corners = 0;
  int told = 0;
  for (std::uint32_t i = 0; i < whole.polyhedra[0].polygon_count; ++i)
    for (const std::uint32_t v : f.outline(f.polygons[whole.polygons[i].source]))
      for (const double out : {-0.03, -0.01, 0.01, 0.03}) {
        CAPTURE(i, v, out);
        // Along the ray from the eye: on the screen it stays where it is.
        SceneFrame bent = f;
        bent.vertices[v] = f.camera.eye + (f.vertices[v] - f.camera.eye) * (1 + out);
        const FrameGeometry g = make_geometry(bent, eight_units(), kWidth, kHeight);
        REQUIRE(g.polyhedra.size() == whole.polyhedra.size());
        CHECK(judge(g, eight_units()).good());  // the picture is right for what the geometry says
        const RayCount rays = compare_with_rays(f, g, eight_units());
        INFO(rays.text());
        const auto picture = draw(g, eight_units());
        std::size_t changed = 0;
        for (std::size_t p = 0; p < picture.size(); ++p) changed += picture[p] != sound_picture[p] ? 1 : 0;
        // A corner on whose triangle the face's plane does not rest may change nothing that is seen.
        CHECK(rays.good() == (changed == 0));
        told += changed != 0 ? 1 : 0;
        ++corners;
      }
  CHECK(told >= 30);
  CHECK(corners == 2 * 4 * 4);  // two faces are seen
}

TEST_CASE("defects: a front face that is dropped is told by judge and rays") {
  const SceneFrame f = pierced();
  const FrameGeometry whole = sound(f);
  std::vector<std::uint64_t> pixels(whole.drawn, 0);  // that show a face
  FrameGeometry numbered = whole;
  numbered.shade = 0;
  numbered.background = 255;
  for (std::uint32_t i = 0; i < whole.drawn; ++i) numbered.polygons[i].color = {static_cast<std::uint8_t>(i), 0, 0};
  for (const std::uint32_t i : draw(numbered, eight_units()))
    if (i < whole.drawn) ++pixels[i];
  // The floor is cut and goes by spans, which draw hidden sides too; of the two others all faces that are left show.
  REQUIRE(whole.polyhedra.size() == 2);
  const std::uint32_t of_polyhedra = whole.polyhedra[1].first_polygon + whole.polyhedra[1].polygon_count;
  CHECK(std::count(pixels.begin(), pixels.begin() + of_polyhedra, 0) == 0);
  for (const Polyhedron& p : whole.polyhedra)
    for (std::uint32_t i = p.first_polygon; i < p.first_polygon + p.polygon_count; ++i) {
      if (pixels[i] == 0) continue;
      CAPTURE(p.component, i);
      // By the scan alone: its edges no longer name it.
      FrameGeometry g = whole;
      for (PolyhedronEdge& e : g.polyhedron_edges) {
        if (e.along == i) e.along = PolyhedronEdge::kNoPolygon;
        if (e.against == i) e.against = PolyhedronEdge::kNoPolygon;
      }
      const Told scan = tell(f, g);
      INFO(scan.judge.text() << scan.rays.text());
      CHECK(scan.judge.surface_gross == pixels[i]);
      CHECK(scan.rays.wrong_surface * 10 > pixels[i] * 9);
      // From the geometry on: then only rays know that there should be one.
      for (std::uint32_t v = 0; v < g.polygons[i].vertex_count; ++v) g.vertices[g.polygons[i].first_vertex + v] = {};
      const Told all = tell(f, g);
      INFO(all.judge.text() << all.rays.text());
      CHECK(all.judge.good());
      CHECK(all.rays.wrong_surface * 10 > pixels[i] * 9);
    }
}

// A step that is wrong by 1 is off by k 2^-Z_FRAC LSB after k pixels, which is within what rounding may do: judge and
// rays excuse it. Where surfaces tie, no pixel may change, and there it shows.
TEST_CASE("defects: a face whose step is wrong by 1 is told where segments and spans must give the same bits") {
  SceneFrame f;
  for (const double red : {1.0, 0.3}) add_solid(f, box_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {red, 0.5, 0.5});
  look_at(f.camera, {2, 2.2, 3}, {0, 0, 0});
  const Config c = eight_units();
  const FrameGeometry g = sound(f);
  Config none = c;
  none.units = 0;
  const auto spans = picture(g, none).pixels;
  const Picture tree = picture(g, c);
  REQUIRE(tree.pixels == spans);
  int faces = 0;
  each_token(tree.words, c, Kind::FACE, [&](const Token& t, std::size_t at) {
    // The first body's face falls back behind the second's, or the second's comes before the first's.
    SegmentToken face = t.segment;
    face.dz += face.index == 0 ? 1 : -1;
    std::vector<std::uint32_t> one;
    TokenWriter(c, one).face(face);
    auto words = tree.words;
    std::copy(one.begin(), one.end(), words.begin() + static_cast<std::ptrdiff_t>(at));
    check_frame(c, words, "a step wrong by 1", 0);
    CAPTURE(face.index, face.face);
    const auto wrong = pixels_of(words, c);
    CHECK(!std::equal(wrong.begin(), wrong.end(), spans.begin(), spans.end()));
    ++faces;
  });
  CHECK(faces == 6);
}

}  // namespace kage::verif
