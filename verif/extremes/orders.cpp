// SPDX-License-Identifier: Apache-2.0
#include "extremes/orders.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

#include "extremes/order_checks.hpp"
#include "geometry/translucent.hpp"
#include "oracle/face_pixels.hpp"
#include "oracle/layer_truth.hpp"
#include "oracle/order_oracle.hpp"
#include "stimulus/order_meshes.hpp"

namespace kage::verif {
namespace {

enum Manner { kFree, kLattice, kPanes, kOnePlane, kNearly };
constexpr std::array kManners{"free", "lattice", "panes", "one_plane", "nearly_one_plane"};

constexpr int kOrderWidth = 80;
constexpr int kOrderHeight = 60;

Config glass_config(bool smooth) {
  Config c;
  c.translucency = 1;
  c.smooth = smooth ? 1 : 0;
  return c;
}

/// Weights of a face's corners, one after another, whole and above 0: other points for other `point`.
auto weights(int point) {
  return [point, n = 0]() mutable { return 1 + (point * 7 + n++ * 5) % 11; };
}

/// Rays from each eye through a point of each face.
Outcome rays_meet_the_order(const OrderTree& tree, const std::vector<Eye>& eyes, const Context& context) {
  Outcome o;
  if (tree.face_count() == 0) return o;
  const OrderOracle oracle(tree);
  const auto way = make_order(tree, OrderWay::fast);
  int point = 0;
  for (const Eye& eye : eyes) {
    const auto found = way->update(eye);
    std::vector<std::uint32_t> order(found.begin(), found.end());
    if (context.injected(Injection::swapped_pair) && order.size() > 1) std::swap(order[0], order[1]);
    for (std::uint32_t face = 0; face < tree.face_count(); ++face) {
      const OrderOracle::Point target = oracle.point_of(face, weights(++point));
      if (eye.perspective && target == OrderOracle::exact(eye.at)) continue;
      int pairs = 0;
      const int wrong = oracle.wrong_pairs(eye, target, order, &pairs);
      o.items += static_cast<std::uint64_t>(pairs);
      if (wrong == -2) o.fail(fmt::format("a point of face {} does not lie in exactly one of its fragments", face));
      if (wrong > 0)
        o.fail(fmt::format("{} pairs of fragments on a ray through face {} are in the wrong order", wrong, face));
    }
  }
  return o;
}

}  // namespace

// ---- meshes and eyes

void MeshCase::Face::fields(Fields& f) {
  double* const values[] = {&ax, &ay, &az, &bx, &by, &bz, &cx, &cy, &cz};
  static constexpr const char* kNames[] = {"ax", "ay", "az", "bx", "by", "bz", "cx", "cy", "cz"};
  for (std::size_t i = 0; i < 9; ++i) f.real(kNames[i], *values[i], -3, 3);
  f.number("ulps", ulps, -2, 2);
}

void MeshCase::fields(Fields& f, std::size_t most) {
  f.choice("manner", manner, kManners);
  f.real("slope_x", slope_x, -1, 1);
  f.real("slope_y", slope_y, -1, 1);
  f.list("face", faces, 1, most);
}

OrderMesh MeshCase::mesh() const {
  OrderMesh mesh;
  for (const Face& face : faces) {
    std::vector<OrderPoint> p{{face.ax, face.ay, face.az}, {face.bx, face.by, face.bz}, {face.cx, face.cy, face.cz}};
    if (manner == kLattice || manner == kOnePlane)
      for (OrderPoint& v : p)
        for (double& x : v) x = std::round(x);
    if (manner == kOnePlane)
      for (OrderPoint& v : p) v[2] = v[0] - 3 * v[1] + 5;
    if (manner == kNearly)
      for (OrderPoint& v : p) {
        v[2] = slope_x * v[0] + slope_y * v[1] + 0.5;
        for (int n = 0; n < std::abs(face.ulps); ++n) v[2] = std::nextafter(v[2], face.ulps > 0 ? 10 : -10);
      }
    if (manner == kPanes) {
      const OrderPoint middle{std::round(face.ax), std::round(face.ay), std::round(face.az)};
      const auto x = static_cast<std::size_t>(std::abs(face.bx) * 0.99);
      const std::size_t y = (x + 1) % 3;
      const double half = face.by > 0 ? 1 : 2;
      p.assign(4, middle);
      for (std::size_t k = 0; k < 4; ++k) {
        p[k][x] += k == 0 || k == 3 ? -half : half;
        p[k][y] += k < 2 ? -half : half;
      }
    }
    add_polygon(mesh, p);
  }
  return mesh;
}

void EyeStep::fields(Fields& f) {
  f.choice("how", how, std::array{"jump", "step", "back", "lattice", "vertex", "parallel", "still"});
  f.real("x", x, -4, 4);
  f.real("y", y, -4, 4);
  f.real("z", z, -4, 4);
  f.number("shift", shift, 0, 30);
  f.number("ulps", ulps, -1, 1);
}

std::vector<Eye> eyes_of(const std::vector<EyeStep>& steps, const OrderTree& tree) {
  std::vector<Eye> eyes;
  Eye eye = Eye::point({0, 0, 4});
  OrderPoint last{};
  for (const EyeStep& s : steps) {
    const OrderPoint p{s.x, s.y, s.z};
    const auto nudge = [&s](OrderPoint at) {
      for (double& v : at)
        if (s.ulps != 0) v = std::nextafter(v, s.ulps > 0 ? 10 : -10);
      return at;
    };
    const auto move = [&eye, &last](double sign) {
      for (std::size_t i = 0; i < 3; ++i) eye.at[i] += sign * last[i];
    };
    switch (s.how) {
      case 1:
        for (std::size_t i = 0; i < 3; ++i) last[i] = std::ldexp(p[i], -s.shift);
        move(1);
        break;
      case 2:
        move(-1);
        break;
      case 3:
        eye = Eye::point(nudge({std::round(s.x), std::round(s.y), std::round(s.z)}));
        break;
      case 4: {
        const auto& v = tree.vertices();
        if (!v.empty())
          eye = Eye::point(nudge(v[static_cast<std::size_t>((s.x + 4) / 8.001 * static_cast<double>(v.size()))]));
        break;
      }
      case 5:
        eye = Eye::parallel(s.ulps == 0 ? OrderPoint{std::round(s.x), std::round(s.y), std::round(s.z)} : p);
        break;
      case 6:
        break;
      default:
        eye = Eye::point(p);
    }
    if (!eye.perspective && eye.at == OrderPoint{0, 0, 0}) eye.at[2] = 1;
    for (double& v : eye.at) v = std::clamp(v, -1e3, 1e3);
    eyes.push_back(eye);
  }
  return eyes;
}

// ---- 14

Outcome PartitionCase::check(const Context& context) const {
  const OrderTree tree = OrderTree::build(mesh.mesh());
  OrderOracle oracle(tree);
  Outcome o;
  for (std::uint32_t face = 0; face < tree.face_count(); ++face) {
    if (context.injected(Injection::lost_fragment)) oracle.lose_fragment(face);
    const OrderOracle::Areas a = oracle.areas(face);
    if (a.face != a.fragments) o.fail(fmt::format("the fragments of face {} have another area than it has", face));
    if (!(a.vertex_error < 1e-9)) o.fail(fmt::format("a vertex of face {} is off by {}", face, a.vertex_error));
    for (int i = 0; i < 5; ++i) {
      const int count = oracle.fragments_at(oracle.point_of(face, weights(i)), face);
      if (count != 1 && count != -1) o.fail(fmt::format("a point of face {} lies in {} of its fragments", face, count));
    }
    o.items += 6;
  }
  return o;
}

void GlassCase::Piece::fields(Fields& f) {
  f.flag("pane", pane);
  solid.fields(f);
}

void GlassCase::fields(Fields& f) {
  f.list("piece", pieces, 1, 10);
  view.fields(f);
}

SceneFrame GlassCase::frame() const {
  SceneFrame f;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const SolidCase& s = pieces[i].solid;
    add_glass(f, pieces[i].pane ? pane_solid() : s.solid(), {s.x / 2, s.y / 2, s.z / 2}, {s.wide, s.high, s.deep},
              s.turn.turn(), {0.1 * static_cast<double>(i), 0.5, 0.3}, static_cast<std::uint8_t>(60 + 15 * i));
  }
  view.apply_to(f.camera);
  return f;
}

void CutFacesCase::fields(Fields& f) {
  f.flag("smooth", smooth);
  sub_bits_field(f, sub_bits);
  glass.fields(f);
}

Outcome CutFacesCase::check(const Context& context) const {
  SceneFrame f = glass.frame();
  if (smooth)  // every corner a colour of its own
    for (Triangle& t : f.triangles)
      for (std::uint32_t& s : t.shading) {
        f.shading.push_back(f.shading[s]);
        const double n = static_cast<double>(f.shading.size() % 17) / 16;
        f.shading.back().color = {n, 1 - n, n * n};
        s = static_cast<std::uint32_t>(f.shading.size()) - 1;
      }
  const Config config = glass_config(smooth);
  const Look look = look_of(sub_bits);
  Look whole = look;
  whole.translucent = TranslucentWay::submission;
  FacePixels parts = pixels_of_faces(make_geometry(f, config, kOrderWidth, kOrderHeight, {.look = look}), config);
  const FacePixels uncut =
      pixels_of_faces(make_geometry(f, config, kOrderWidth, kOrderHeight, {.look = whole}), config);
  if (context.injected(Injection::lost_fragment) && !parts.empty()) parts.erase(std::prev(parts.end()));
  Outcome o;
  if (parts != uncut) o.fail("faces in fragments have other pixels, depths or colours than uncut");
  for (const auto& [place, pixel] : parts)
    if (std::get<0>(pixel) != 1)
      o.fail(fmt::format("face {} has pixel ({}, {}) {} times", std::get<0>(place), std::get<2>(place),
                         std::get<1>(place), std::get<0>(pixel)));
  if (smooth) {
    // A clipped face of several colours is a fan of triangles: together they are the face.
    const Config flat = glass_config(false);
    const FacePixels faces = pixels_of_faces(make_geometry(f, flat, kOrderWidth, kOrderHeight, {.look = whole}), flat);
    if (!std::ranges::equal(parts, faces, {}, &FacePixels::value_type::first, &FacePixels::value_type::first))
      o.fail("faces of several colours have other pixels than faces of one");
  }
  o.items = parts.size();
  return o;
}

void CutLineCase::fields(Fields& f) {
  f.choice("manner", manner, std::array{"any", "sliver", "nearly_one_plane", "eye_near_plane"});
  f.number("width", width, 16, kMaxSize, 64);
  f.number("height", height, 16, kMaxSize, 48);
  f.number("thin", thin, 3, 18, 8);
  face.fields(f);
  node.fields(f);
  view.fields(f);
}

Outcome CutLineCase::check(const Context& context) const {
  using Corners = std::array<glm::dvec3, 3>;
  const auto corners = [](const MeshCase::Face& p) {
    return Corners{glm::dvec3(p.ax, p.ay, p.az) / 3.0, glm::dvec3(p.bx, p.by, p.bz) / 3.0,
                   glm::dvec3(p.cx, p.cy, p.cz) / 3.0};
  };
  Camera camera;
  view.apply_to(camera);
  const Corners cut = corners(face);
  Corners by = corners(node);
  double tiny = 1;
  for (int i = 0; i < thin; ++i) tiny /= 10;
  if (manner == 1) by[1] = by[0] + tiny * by[1];
  if (manner == 2)
    for (std::size_t i = 0; i < 3; ++i) by[i] = cut[i] + tiny * by[i];
  if (manner == 3) camera.eye = by[0] + 2.0 * (by[1] - by[0]) + tiny * by[2];
  return cut_line_is_exact(camera, cut, by, width, height, context);
}

// ---- 35 - 38

void WaysCase::fields(Fields& f) {
  mesh.fields(f, 40);
  f.list("step", steps, 1, 300);
}

Outcome WaysCase::check(const Context& context) const {
  const OrderTree tree = OrderTree::build(mesh.mesh());
  return ways_agree(tree, eyes_of(steps, tree), context);
}

void OnPlanesCase::fields(Fields& f) {
  mesh.fields(f, 12);
  f.list("step", steps, 1, 40);
}

Outcome OnPlanesCase::check(const Context& context) const {
  MeshCase m = mesh;
  if (m.manner == kFree || m.manner == kNearly) m.manner = kPanes;
  const OrderTree tree = OrderTree::build(m.mesh());
  // Lattice points lie on many planes at once, vertices on several, lattice directions along many.
  std::vector<EyeStep> on = steps;
  for (EyeStep& s : on)
    if (s.how < 3) s.how += 3;
  const auto eyes = eyes_of(on, tree);
  Outcome o = ways_agree(tree, eyes, context);
  o.add(rays_meet_the_order(
      tree, std::vector<Eye>(eyes.begin(), eyes.begin() + std::min<std::ptrdiff_t>(4, std::ssize(eyes))), context));
  return o;
}

void FlatMeshCase::fields(Fields& f) {
  mesh.fields(f, 20);
  f.list("step", steps, 1, 4);
}

Outcome FlatMeshCase::check(const Context& context) const {
  MeshCase m = mesh;
  if (m.manner != kOnePlane && m.manner != kLattice) m.manner = kNearly;
  const OrderTree tree = OrderTree::build(m.mesh());
  const OrderBuildStats& s = tree.stats();
  Outcome o;
  if (!within_fragment_bound(s)) o.fail(fmt::format("{} fragments of {} faces", s.fragments, s.faces));
  if (m.manner == kOnePlane && s.faces > 0) {
    if (tree.node_count() != 1) o.fail(fmt::format("{} nodes for one plane", tree.node_count()));
    for (std::uint32_t f = 1; f < tree.fragment_count(); ++f)
      if (tree.fragment(f - 1).face >= tree.fragment(f).face) o.fail("faces of one plane are not in the mesh's order");
  }
  o.add(rays_meet_the_order(tree, eyes_of(steps, tree), context));
  return o;
}

void RaysCase::fields(Fields& f) {
  mesh.fields(f, 12);
  f.list("step", steps, 1, 6);
}

Outcome RaysCase::check(const Context& context) const {
  const OrderTree tree = OrderTree::build(mesh.mesh());
  const auto eyes = eyes_of(steps, tree);
  Outcome o = rays_meet_the_order(tree, eyes, context);
  if (!within_fragment_bound(tree.stats())) o.fail("more fragments than the bound");
  return o;
}

void LayerRaysCase::fields(Fields& f) {
  sub_bits_field(f, sub_bits);
  glass.fields(f);
}

Outcome LayerRaysCase::check(const Context& context) const {
  const SceneFrame f = glass.frame();
  const Config config = glass_config(false);
  FrameGeometry g = make_geometry(f, config, kOrderWidth, kOrderHeight, {.look = look_of(sub_bits)});
  if (context.injected(Injection::swapped_pair) && g.fragments.size() > 1) std::swap(g.fragments[0], g.fragments[1]);
  const LayerCount count = compare_layers(f, g, config, 2);
  Outcome o;
  if (count.wrong > 0) o.fail(count.text());
  o.pixels = count.pixels;
  return o;
}

void add_order_families(Families& to) {
  add_family<PartitionCase>(to, {14, "14", "faces cut by planes: fragments partition them, in rationals", {}, 0, 2});
  add_family<CutFacesCase>(to, {14, "14 screen", "the same on the screen: pixels, depths and colours"});
  add_family<CutLineCase>(to, {14, "14 line", "the line where a plane cuts a face", "2^-15 px", 2000, 2});
  add_family<WaysCase>(to, {35, "35", "all ways give one order, whatever the eye does"});
  add_family<OnPlanesCase>(to, {36, "36", "the eye on nodes' planes"});
  add_family<FlatMeshCase>(to, {37, "37", "coplanar and nearly coplanar faces", {}, 0, 2});
  add_family<RaysCase>(to, {38, "38", "the order against exact rays", {}, 0, 2});
  add_family<LayerRaysCase>(to, {38, "38 layers", "translucent layers against rays"});
}

}  // namespace kage::verif
