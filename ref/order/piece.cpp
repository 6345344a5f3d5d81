// SPDX-License-Identifier: Apache-2.0
#include "order/piece.hpp"

#include <algorithm>

namespace kage::order {
namespace {

constexpr std::uint32_t kCut = OrderFragment::kCutEdge;

/// Points less certain than this, as of planes that hardly differ, are made by integers.
constexpr double kPoor = 0x1p-30;

bool has(const std::array<std::uint32_t, 3>& plane, std::uint32_t v) {
  return v == plane[0] || v == plane[1] || v == plane[2];
}

}  // namespace

Classifier::Test Classifier::test_corner(std::uint32_t v, const Splitter& plane) {
  ++tests_;
  if (has(faces_.faces[plane.face].plane, v)) return {0, 0, 0};
  const OrderPoint& p = faces_.scaled[v];
  const double value = plane.filter.value(p);
  double error = plane.filter.error(NearPoint{p, 0});
  if (value > error) return {1, value, error};
  if (value < -error) return {-1, value, error};
  const int flat = plane.filter.flat();
  if (flat >= 0 && faces_.vertices[v][static_cast<std::size_t>(flat)] == plane.points.a[static_cast<std::size_t>(flat)])
    return {0, 0, 0};
  error = plane.filter.error(p);  // tighter, by the distances themselves
  if (value > error) return {1, value, error};
  if (value < -error) return {-1, value, error};
  ++exact_;
  ExactVertex exact;
  exact.p = faces_.vertices[v];
  return {exact_side(faces_.grid, exact, plane.points), value, error};
}

Classifier::Test Classifier::test_vertex(const Face& face, const Piece& piece, std::size_t i, const Splitter& plane) {
  const Piece::Vertex& v = piece.vertices[i];
  if (v.corner != kNoNode) return test_corner(v.corner, plane);
  ++tests_;
  const double value = plane.filter.value(v.point.at);
  const double error = plane.filter.error(v.point);
  if (value > error) return {1, value, error};
  if (value < -error) return {-1, value, error};
  // On an edge that lies in the plane for its two ends' sake.
  const std::size_t n = piece.edges.size();
  const std::array<std::uint32_t, 3>& in = faces_.faces[plane.face].plane;
  for (const std::uint32_t e : {piece.edges[i], piece.edges[(i + n - 1) % n]})
    if (e < kCut && has(in, faces_.corner(face, e)) && has(in, faces_.corner(face, e + 1))) return {0, 0, 0};
  ++exact_;
  return {exact_side(faces_.grid, exact_vertex(face, piece, i), plane.points), value, error};
}

ExactVertex Classifier::exact_vertex(const Face& face, const Piece& piece, std::size_t i) const {
  const std::size_t n = piece.edges.size();
  std::uint32_t before = piece.edges[(i + n - 1) % n];
  std::uint32_t after = piece.edges[i];
  if (before < after) std::swap(before, after);  // a cut first
  return exact_vertex(face, piece, after, faces_.plane(faces_.faces[piece.cuts[before - kCut].face]));
}

ExactVertex Classifier::exact_vertex(const Face& face, const Piece& piece, std::uint32_t edge,
                                     const PlanePoints& plane) const {
  ExactVertex v;
  v.first = plane;
  if (edge < kCut) {
    v.kind = ExactVertex::Kind::kOnEdge;
    v.p = faces_.vertices[faces_.corner(face, edge)];
    v.q = faces_.vertices[faces_.corner(face, edge + 1)];
  } else {
    v.kind = ExactVertex::Kind::kInside;
    v.face = faces_.plane(face);
    v.second = faces_.plane(faces_.faces[piece.cuts[edge - kCut].face]);
  }
  return v;
}

Side Classifier::classify(const BuildFragment& f, const Splitter& plane) {
  if (f.face == plane.face) return Side::kOn;
  const Face& face = faces_.faces[f.face];
  at_.clear();
  bool front = false;
  bool back = false;
  const std::size_t n = f.piece ? f.piece->vertices.size() : face.count;
  for (std::size_t i = 0; i < n; ++i) {
    at_.push_back(f.piece ? test_vertex(face, *f.piece, i, plane) : test_corner(faces_.corners[face.first + i], plane));
    front = front || at_.back().sign > 0;
    back = back || at_.back().sign < 0;
  }
  if (front && back) return Side::kBoth;
  if (front) return Side::kFront;
  return back ? Side::kBack : Side::kOn;
}

Piece Classifier::whole(const Face& face) const {
  Piece p;
  for (std::uint32_t i = 0; i < face.count; ++i) {
    const std::uint32_t v = faces_.corners[face.first + i];
    p.vertices.push_back({{faces_.scaled[v], 0}, v});
    p.edges.push_back(i);
  }
  return p;
}

NearPoint Classifier::crossing(const Face& face, const Piece& piece, std::size_t i, const Splitter& plane) const {
  const std::size_t j = (i + 1) % piece.vertices.size();
  const NearPoint x =
      meet(piece.vertices[i].point, at_[i].value, at_[i].error, piece.vertices[j].point, at_[j].value, at_[j].error);
  if (x.radius <= kPoor) return x;
  return {faces_.scale(exact_point(faces_.grid, exact_vertex(face, piece, piece.edges[i], plane.points))), 0x1p-50};
}

std::pair<BuildFragment, BuildFragment> Classifier::split(const BuildFragment& f, const Splitter& plane,
                                                          BuildNode* node) {
  const Face& face = faces_.faces[f.face];
  const Piece whole_face = f.piece ? Piece() : whole(face);
  const Piece& piece = f.piece ? *f.piece : whole_face;
  const std::size_t n = piece.vertices.size();
  const auto cut_edge = kCut + static_cast<std::uint32_t>(piece.cuts.size());
  // Both parts get the very same points: they are made from the edge as the piece has it, once.
  crossings_.clear();
  for (std::size_t i = 0; i < n; ++i)
    if (at_[i].sign * at_[(i + 1) % n].sign < 0) crossings_.push_back(crossing(face, piece, i, plane));
  std::array<Piece, 2> part;  // front, back
  for (int s = 0; s < 2; ++s) {
    Piece& out = part[static_cast<std::size_t>(s)];
    const int wanted = s == 0 ? 1 : -1;
    out.cuts.reserve(piece.cuts.size() + 1);
    out.cuts = piece.cuts;
    out.cuts.push_back({node, plane.face, s == 0});
    out.vertices.reserve(n + 1);  // a convex polygon's part has at most one more
    out.edges.reserve(n + 1);
    auto x = crossings_.begin();
    for (std::size_t i = 0; i < n; ++i) {
      const int here = at_[i].sign * wanted;
      const int next = at_[(i + 1) % n].sign * wanted;
      if (here >= 0) {
        out.vertices.push_back(piece.vertices[i]);
        // On the plane and leaving: what follows is the cut.
        out.edges.push_back(here == 0 && next <= 0 ? cut_edge : piece.edges[i]);
      }
      if (here * next >= 0) continue;
      out.vertices.push_back({*x++, kNoNode});
      out.edges.push_back(here > 0 ? cut_edge : piece.edges[i]);
    }
  }
  return {BuildFragment{f.face, std::make_unique<Piece>(std::move(part[0]))},
          BuildFragment{f.face, std::make_unique<Piece>(std::move(part[1]))}};
}

}  // namespace kage::order
