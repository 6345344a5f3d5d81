// SPDX-License-Identifier: Apache-2.0
#include "extremes/shadows.hpp"

#include <fmt/format.h>

#include <set>

#include "extremes/shadow_checks.hpp"
#include "kage/error.hpp"
#include "kage/frontend.hpp"

namespace kage::verif {
namespace {

constexpr int kShadowWidth = 80;
constexpr int kShadowHeight = 60;

FrameGeometry geometry(const SceneFrame& f, const Config& config, const Look& look) {
  return make_geometry(f, config, kShadowWidth, kShadowHeight, {.look = look});
}

Outcome closed_and_right(const SceneFrame& f, const Config& config, const Look& look, const Context& context) {
  Outcome o = picture_is_the_oracles(geometry(f, config, look), config, context);
  o.add(volumes_are_closed(f, config, kShadowWidth, kShadowHeight, context, look));
  return o;
}

double moved_by_ulps(double v, int ulps) {
  for (; ulps > 0; --ulps) v = std::nextafter(v, 1e9);
  for (; ulps < 0; ++ulps) v = std::nextafter(v, -1e9);
  return v;
}

/// Gives each cap a polygon of its own, nearer than that of the face.
void bring_caps_nearer(FrameGeometry& g) {
  for (VolumeFace& face : g.volume_faces) {
    ScreenPolygon cap = g.polygons[face.polygon];
    if (cap.source == ~0U) continue;  // a side
    cap.depth.c -= std::int64_t{1000} << kPlaneFrac;
    face.polygon = static_cast<std::uint32_t>(g.polygons.size());
    g.polygons.push_back(cap);
  }
}

void bits_field(Fields& f, int& bits) { f.number("bits", bits, 1, 8, 1); }

}  // namespace

// ---- 21

void ShadowsCase::fields(Fields& f) {
  bits_field(f, bits);
  scene.fields(f);
}

Outcome ShadowsCase::check(const Context& context) const {
  return closed_and_right(scene.frame(), counting(bits), scene.look(), context);
}

void ShadowRaysCase::fields(Fields& f) {
  bits_field(f, bits);
  scene.fields(f);
}

Outcome ShadowRaysCase::check(const Context& context) const {
  const SceneFrame f = scene.frame();
  return picture_is_the_rays(f, geometry(f, counting(bits), scene.look()), counting(bits), context);
}

// ---- 22

void NestedCase::Place::fields(Fields& f) { f.number("box", box, 0, 63); }

void NestedCase::fields(Fields& f) {
  bits_field(f, bits);
  sub_bits_field(f, sub_bits);
  f.real("aside", aside, 0, 1, 0.5);
  f.list("place", order, 0, 64);
}

Outcome NestedCase::check(const Context& context) const {
  std::vector<int> boxes;
  std::set<int> known;
  for (const Place& p : order)
    if (known.insert(p.box).second) boxes.push_back(p.box);
  const std::vector<int> sorted(known.begin(), known.end());
  const FrameGeometry g = geometry(box_threes(boxes, aside), counting(bits), look_of(sub_bits));
  Outcome o = picture_is_the_oracles(g, counting(bits), context);
  if (draw(g, counting(bits)) !=
      draw(geometry(box_threes(sorted, aside), counting(bits), look_of(sub_bits)), counting(bits)))
    o.fail("another order of the casters is another picture");
  // One counting volume against a volume for each.
  if (bits > 1)
    o.add(same_but_near_ties_count(geometry(box_threes(boxes, aside), Config{}, look_of(sub_bits)), Config{}, g,
                                   counting(bits))
              .outcome());
  return o;
}

// ---- 23

void CrossedCase::fields(Fields& f) {
  bits_field(f, bits);
  sub_bits_field(f, sub_bits);
  const int limit = 1 << bits;
  f.number("crossed", crossed, 1, std::min(130, limit + 2), 1);
}

Outcome CrossedCase::check(const Context& context) const {
  const SceneFrame f = zigzag_scene(crossed);
  const Config config = counting(bits);
  const FrameGeometry g = geometry(f, config, look_of(sub_bits));
  Outcome o = picture_is_the_oracles(g, config, context);
  // The zigzag and the floor below it. A shadow that fits in one volume is one volume.
  if (bits > 1 && (g.volumes.size() == 1) != (crossed + 1 <= (1 << bits) - 1))
    o.fail(fmt::format("{} volumes for {} crossings", g.volumes.size(), crossed + 1));
  o.add(picture_is_the_rays(f, g, config, context));
  Config no_fsf = config;
  no_fsf.fsf = 0;
  const FrameGeometry without = geometry(f, no_fsf, look_of(sub_bits));
  if (without.volumes.size() == 1) {
    o.add(picture_is_the_oracles(without, no_fsf, context));
  } else {
    std::vector<std::uint32_t> words;
    bool refused = false;
    try {
      make_frame(without, no_fsf, 0, words, {.threads = 1});
    } catch (const Error&) {
      refused = true;
    }
    if (!refused) o.fail("several volumes without FSF are not refused");
  }
  return o;
}

// ---- 24

void EyeCase::fields(Fields& f) {
  bits_field(f, bits);
  sub_bits_field(f, sub_bits);
  static constexpr std::array kPlanes{"free", "left", "right"};
  f.choice("on_x", on_x, kPlanes);
  f.number("ulps_x", ulps_x, -2, 2);
  f.choice("on_z", on_z, kPlanes);
  f.number("ulps_z", ulps_z, -2, 2);
  f.real("x", x, -4, 4);
  f.real("y", y, -2.4, 1.4, -0.5);
  f.real("z", z, -4, 4);
  f.real("at_x", at_x, -4, 4);
  f.real("at_y", at_y, -3, 0);
  f.real("at_z", at_z, -4, 4, 1);
  f.real("near", near, 0.01, 2, 0.5);
}

Outcome EyeCase::check(const Context& context) const {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0, 2, 0}, {1, 0.5, 1}, Turn{}, {1, 1, 1}, false, true);
  add_solid(f, box_solid(), {0.5, 3.2, 0}, {1, 0.5, 1}, Turn{}, {1, 1, 1}, false, false);
  add_solid(f, octahedron_solid(), {2.5, 1, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  f.lights[0].direction = {0, -1, 0};  // shadow planes of the box: x = +-1, z = +-1
  const auto place = [](int on, double free, int ulps) {
    return on == 0 ? free : moved_by_ulps(on == 1 ? -1 : 1, ulps);
  };
  const glm::dvec3 eye(place(on_x, x, ulps_x), y, place(on_z, z, ulps_z));
  glm::dvec3 at(at_x, at_y, at_z);
  if (glm::dot(eye - at, eye - at) < 1e-6) at.z += 1;
  look_at(f.camera, eye, at);
  f.camera.near = near;
  return closed_and_right(f, counting(bits), look_of(sub_bits), context);
}

// ---- 25

void LightPlaceCase::fields(Fields& f) {
  bits_field(f, bits);
  sub_bits_field(f, sub_bits);
  f.flag("directional", directional);
  static constexpr std::array kPlaces{"free", "face", "other_face", "middle"};
  f.choice("on_x", on_x, kPlaces);
  f.choice("on_y", on_y, kPlaces);
  f.choice("on_z", on_z, kPlaces);
  f.number("ulps", ulps, -2, 2);
  f.real("x", x, -6, 6);
  f.real("y", y, -2, 6, 5);
  f.real("z", z, -6, 6);
  f.number("far", far, 0, 6);
}

Outcome LightPlaceCase::check(const Context& context) const {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  add_solid(f, octahedron_solid(), {1.5, 0.5, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
  look_at(f.camera, {4, 3, 5}, {0, -1, 0});
  const auto place = [this](int on, double free) {
    return on == 0 ? free : moved_by_ulps(on == 1 ? 1 : on == 2 ? -1 : 0, ulps);
  };
  glm::dvec3 at(place(on_x, x), place(on_y, y), place(on_z, z));
  for (int i = 0; i < far; ++i) at *= 10.0;
  Light& light = f.lights[0];
  light.directional = directional;
  light.position = at;
  const double length = std::sqrt(glm::dot(at, at));
  light.direction = length > 1e-9 ? -at / length : glm::dvec3(0, -1, 0);
  return closed_and_right(f, counting(bits), look_of(sub_bits), context);
}

// ---- 26

void ReachCase::fields(Fields& f) {
  bits_field(f, bits);
  f.real("extrusion", extrusion, 1, 20, 3);
  scene.fields(f);
}

Outcome ReachCase::check(const Context& context) const {
  const SceneFrame f = scene.frame();
  Look further = scene.look();
  further.extrusion = extrusion;
  const FrameGeometry g = geometry(f, counting(bits), further);
  Outcome o =
      same_but_near_ties_count(geometry(f, counting(bits), scene.look()), counting(bits), g, counting(bits)).outcome();
  o.add(picture_is_the_oracles(g, counting(bits), context));
  return o;
}

// ---- 27

void CapCase::fields(Fields& f) {
  bits_field(f, bits);
  sub_bits_field(f, sub_bits);
  f.choice("kind", kind, std::array{"triangle", "octahedron", "box"});
  turn.fields(f);
  lamp.fields(f);
}

Outcome CapCase::check(const Context& context) const {
  SceneFrame f;
  if (kind == 0)
    add_solid(f, Solid{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {0, 0, 0}, {1, 1, 1}, turn.turn(), {1, 1, 1},
              false, false);
  else
    add_solid(f, kind == 1 ? octahedron_solid() : box_solid(), {0, 0, 0}, {1, 1, 1}, turn.turn(), {1, 1, 1});
  look_at(f.camera, {0, 0, 3}, {0, 0, 0});
  LampCase sun = lamp;
  sun.placed = false;
  sun.apply_to(f.lights[0]);
  FrameGeometry g = geometry(f, counting(bits), look_of(sub_bits));
  if (context.injected(Injection::near_cap)) bring_caps_nearer(g);
  Outcome o = no_acne(g, counting(bits), sub_bits);
  o.add(picture_is_the_oracles(g, counting(bits), context));
  return o;
}

// ---- 28

void TornCase::Torn::fields(Fields& f) {
  solid.fields(f);
  f.number("inverted", inverted, 0, 4095);
  f.flag("fin", fin);
  f.flag("twice", twice);
  f.flag("junction", junction);
}

void TornCase::fields(Fields& f) {
  bits_field(f, bits);
  sub_bits_field(f, sub_bits);
  f.list("torn", torn, 1, 3);
  view.fields(f);
  lamp.fields(f);
}

SceneFrame TornCase::frame() const {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -2.5, 0}, {5, 0.2, 5}, Turn{}, {1, 1, 1});
  for (const Torn& t : torn) {
    Solid open = t.solid.kind == 0 ? box_solid() : octahedron_solid();
    open.faces.pop_back();
    for (std::size_t i = 0; i < open.faces.size(); ++i)
      if ((t.inverted >> i & 1) != 0) std::swap(open.faces[i][0], open.faces[i][1]);
    if (t.fin) open.faces.push_back({0, 3, 5});
    if (t.twice) open.faces.push_back(open.faces[0]);
    if (t.junction) {
      open.vertices.push_back((open.vertices[0] + open.vertices[1]) * 0.5);
      open.faces.push_back({0, static_cast<std::uint32_t>(open.vertices.size() - 1), 3});
    }
    add_solid(f, open, {t.solid.x / 3, t.solid.y / 2, t.solid.z / 3}, {t.solid.wide, t.solid.high, t.solid.deep},
              t.solid.turn.turn(), {1, 1, 1}, false, false);
  }
  view.apply_to(f.camera);
  lamp.apply_to(f.lights[0]);
  return f;
}

Outcome TornCase::check(const Context& context) const {
  const SceneFrame f = frame();
  const FrameGeometry g = geometry(f, counting(bits), look_of(sub_bits));
  Outcome o = closed_and_right(f, counting(bits), look_of(sub_bits), context);
  o.add(picture_is_the_rays(f, g, counting(bits), context));
  Look per_face = look_of(sub_bits);
  per_face.volumes = VolumeWay::per_face;
  o.add(same_but_near_ties_count(g, counting(bits), geometry(f, Config{}, per_face), Config{}).outcome());
  return o;
}

void add_shadow_families(Families& to) {
  add_family<ShadowsCase>(to, {21, "21", "any scene: volumes are closed, pictures the oracle's"});
  add_family<ShadowRaysCase>(to, {21, "21 rays", "any scene: shadows are those of rays to the light"});
  add_family<NestedCase>(to, {22, "22", "nested, overlapping, touching casters in any order"});
  add_family<CrossedCase>(to, {23, "23", "a caster that light crosses as often as a count goes, and more"});
  add_family<EyeCase>(to, {24, "24", "the eye in, out and on shadow planes, near planes through volumes"});
  add_family<LightPlaceCase>(to, {25, "25", "the light on faces' planes, in the caster, behind the eye, far"});
  add_family<ReachCase>(to, {26, "26", "volumes that reach further than they must"});
  add_family<CapCase>(to, {27, "27", "a face that is the cap of its own volume"});
  add_family<TornCase>(to, {28, "28", "open, inverted, torn casters, against rays and a volume a face"});
}

}  // namespace kage::verif
