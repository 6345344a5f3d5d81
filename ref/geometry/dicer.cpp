// SPDX-License-Identifier: Apache-2.0
#include "geometry/dicer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace kage {
namespace {

// A part whose edges are all shorter, in pixels, has no more pixels to gain; and none to speak of by classes, which a
// table of a few tells apart along many lines.
constexpr double kLeastEdge = 2;
constexpr double kLeastClassEdge = 16;

// Light is looked at every so many pixels at most, and at so many places along the longer side of a part.
constexpr int kMostStep = 4;
constexpr int kPlaces = 8;

// A sample's light is no brighter at a corner, in 1/256 of white.
constexpr double kMostLight = 500;

// No frame has more shades: it would be noise.
constexpr std::size_t kMostShades = std::size_t{1} << 20;

}  // namespace

std::uint32_t Dicer::add(const FaceShading::Shaded& face, const ClipPoint& p) {
  Corner& c = corners_.emplace_back(Corner{p.sx / p.q, p.sy / p.q, p, std::nullopt, {}});
  if (face.linear)
    c.light = shading_->light_at(face, view_->place(p));
  else
    c.clip.color = shading_->color_at(face, view_->place(p));
  return static_cast<std::uint32_t>(corners_.size() - 1);
}

Dicer::Corners Dicer::begin(const FaceShading::Shaded& face, std::span<const ClipPoint, 3> triangle) {
  corners_.clear();
  Corners t{};
  for (std::size_t i = 0; i < 3; ++i) t[i] = add(face, triangle[i]);
  return t;
}

// The point of a triangle that has these parts of its corners on the screen. 1 / q is linear there (perspective), or w
// (parallel).
ClipPoint Dicer::between(const Corners& t, const glm::dvec3& part) const {
  const Corner& a = at(t[0]);
  const Corner& b = at(t[1]);
  const Corner& c = at(t[2]);
  ClipPoint p;
  if (view_->perspective())
    p.q = p.w = 1 / (part[0] / a.clip.q + part[1] / b.clip.q + part[2] / c.clip.q);
  else
    p.w = a.clip.w * part[0] + b.clip.w * part[1] + c.clip.w * part[2];
  p.sx = (a.x * part[0] + b.x * part[1] + c.x * part[2]) * p.q;
  p.sy = (a.y * part[0] + b.y * part[1] + c.y * part[2]) * p.q;
  return p;
}

Dicer::Edge Dicer::longest_edge(const Corners& t) const {
  Edge edge{0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner& a = at(t[k]);
    const Corner& b = at(t[(k + 1) % 3]);
    const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    if (length > edge.length * kLonger) edge = {k, length};
  }
  return edge;
}

FaceShading::Part Dicer::part_of(const FaceShading::Shaded& face, const Corners& t) {
  std::array<const FaceShading::Place*, 3> places{};
  for (std::size_t i = 0; i < 3 && face.normal_class > 0; ++i) {
    Corner& c = corners_[t[i]];
    if (!c.place) c.place = shading_->place(face, view_->place(c.clip), c.clip.color);
    places[i] = &*c.place;
  }
  return shading_->part(face, places);
}

std::optional<Dicer::Window> Dicer::window(const Corners& t) const {
  const auto [left, right] = std::minmax({at(t[0]).x, at(t[1]).x, at(t[2]).x});
  const auto [top, bottom] = std::minmax({at(t[0]).y, at(t[1]).y, at(t[2]).y});
  const Window in{std::max(left, 0.0), std::min(right, static_cast<double>(out_->width)), std::max(top, 0.0),
                  std::min(bottom, static_cast<double>(out_->height))};
  if (!(in.x0 < in.x1 && in.y0 < in.y1)) return std::nullopt;
  return in;
}

// Whether colour between the corners is too far from light at a point that has these parts of them.
bool Dicer::is_off(const FaceShading::Shaded& face, const Corners& t, const glm::dvec3& part,
                   const ClipPoint& p) const {
  const Corner& a = at(t[0]);
  const Corner& b = at(t[1]);
  const Corner& c = at(t[2]);
  if (face.linear) {
    FaceShading::Light between = a.light;
    for (std::size_t i = 0; i < between.size(); ++i)
      between[i] = a.light[i] * part[0] + b.light[i] * part[1] + c.light[i] * part[2];
    return shading_->difference(face, between, shading_->light_at(face, view_->place(p))) > max_shading_;
  }
  const glm::dvec3 linear = a.clip.color * part[0] + b.clip.color * part[1] + c.clip.color * part[2];
  const glm::dvec3 d = glm::abs(shading_->color_at(face, view_->place(p)) - linear);
  return std::max({d.x, d.y, d.z}) > max_shading_;
}

// Whether colour between the corners is too far from light somewhere in the picture.
bool Dicer::off(const FaceShading::Shaded& face, const Corners& t, const Window& in) const {
  const Corner& a = at(t[0]);
  const Corner& b = at(t[1]);
  const Corner& c = at(t[2]);
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (!(std::abs(area) > 0)) return false;
  const auto is_off = [&](const glm::dvec3& part) {
    const ClipPoint p = between(t, part);
    const double x = p.sx / p.q;
    const double y = p.sy / p.q;
    if (!(x >= in.x0 && x <= in.x1 && y >= in.y0 && y <= in.y1)) return false;
    return this->is_off(face, t, part, p);
  };
  constexpr double kThird = 1.0 / 3;
  for (const glm::dvec3& part :
       {glm::dvec3{kThird, kThird, kThird}, glm::dvec3{0.5, 0.5, 0}, glm::dvec3{0, 0.5, 0.5}, glm::dvec3{0.5, 0, 0.5}})
    if (is_off(part)) return true;
  const double step = std::clamp(std::floor(std::max(in.x1 - in.x0, in.y1 - in.y0) / kPlaces), 2.0, double{kMostStep});
  for (double y = std::ceil(in.y0 / step) * step; y < in.y1; y += step) {
    // Where the line meets the edges: a long and thin part is no reason to look at all that its window has.
    double from = in.x1;
    double to = in.x0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& p = at(t[k]);
      const Corner& q = at(t[(k + 1) % 3]);
      if (!(std::min(p.y, q.y) <= y && y <= std::max(p.y, q.y)) || p.y == q.y) continue;
      const double x = p.x + (q.x - p.x) * ((y - p.y) / (q.y - p.y));
      from = std::min(from, x);
      to = std::max(to, x);
    }
    for (double x = std::ceil(std::max(from, in.x0) / step) * step; x <= std::min(to, in.x1); x += step) {
      const double v = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
      const double w = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
      if (v >= 0 && w >= 0 && v + w <= 1 && is_off({1 - v - w, v, w})) return true;
    }
  }
  return false;
}

// Whether a class of its own is worth while.
bool Dicer::is_large(const Corners& t) const { return longest_edge(t).length >= kLeastClassEdge && window(t); }

bool Dicer::needs_cut(const FaceShading::Shaded& face, const Corners& t) {
  const double length = longest_edge(t).length;
  if (length < kLeastEdge || out_->shades.size() >= kMostShades) return false;
  const auto in = window(t);
  if (!in) return false;
  return off(face, t, *in) || (face.normal_class > 0 && is_large(t) && part_of(face, t).error > max_shading_);
}

// A span's colour has two bits above white, so that a light that is brighter in the middle of a part still comes out
// right beside it.
std::uint32_t Dicer::add_light(const Corners& t) {
  const auto first = static_cast<std::uint32_t>(out_->color_planes.size());
  for (std::size_t i = 0; i < at(t[0]).light.size(); ++i) {
    triangle_.clear();
    for (const std::uint32_t k : t) {
      triangle_.push_back(at(k).clip);
      triangle_.back().color = glm::min(at(k).light[i], glm::dvec3(kMostLight));
    }
    for (int c = 0; c < 3; ++c) out_->color_planes.push_back(faces_->color_plane(triangle_, c));
  }
  return first;
}

std::uint32_t Dicer::add_light(const FaceShading::Shaded& face, std::span<const ClipPoint, 3> triangle) {
  return add_light(begin(face, triangle));
}

std::uint32_t Dicer::add_light(const FaceShading::Light& light) {
  const auto first = static_cast<std::uint32_t>(out_->color_planes.size());
  for (const glm::dvec3& one : light)
    for (int c = 0; c < 3; ++c)
      out_->color_planes.push_back({0, 0, to_fixed(std::min(one[c], kMostLight), kPlaneFrac), 0, 0});
  return first;
}

std::int32_t Dicer::shade(const FaceShading::Shaded& face, const Corners& t) {
  if (face.linear) {
    out_->shades.push_back({add_light(t), 0});
    return ~static_cast<std::int32_t>(out_->shades.size() - 1);
  }
  const FaceShading::Part part = part_of(face, t);
  triangle_.clear();
  for (const std::uint32_t i : t) {
    triangle_.push_back(at(i).clip);
    triangle_.back().color = glm::min(triangle_.back().color * part.factor, glm::dvec3(255));
  }
  out_->shades.push_back({static_cast<std::uint32_t>(out_->color_planes.size()), part.normal_class});
  for (int c = 0; c < 3; ++c) out_->color_planes.push_back(faces_->color_plane(triangle_, c));
  return ~static_cast<std::int32_t>(out_->shades.size() - 1);
}

std::int32_t Dicer::part(const FaceShading::Shaded& face, const Corners& t) {
  return needs_cut(face, t) ? cut(face, t) : shade(face, t);
}

// From the middle of the longest edge to the corner across it.
std::int32_t Dicer::cut(const FaceShading::Shaded& face, const Corners& t) {
  const std::size_t longest = longest_edge(t).from;
  const std::size_t next = (longest + 1) % 3;
  const std::uint32_t third = t[(longest + 2) % 3];
  glm::dvec3 half{0, 0, 0};
  half[static_cast<int>(longest)] = half[static_cast<int>(next)] = 0.5;
  const std::uint32_t middle = add(face, between(t, half));
  const auto on_picture = [this](std::uint32_t i) { return view_->on_picture(at(i).x, at(i).y); };
  glm::dvec3 line = glm::cross(on_picture(third), on_picture(middle));
  if (glm::dot(line, on_picture(t[longest])) < 0) line = -line;
  const std::size_t number = out_->shade_cuts.size();
  out_->shade_cuts.push_back({view_->line(line)});
  const std::int32_t front = part(face, {t[longest], middle, third});
  const std::int32_t behind = part(face, {middle, t[next], third});
  out_->shade_cuts[number].front = front;
  out_->shade_cuts[number].behind = behind;
  corners_.erase(corners_.begin() + middle, corners_.end());  // no other part has it
  return static_cast<std::int32_t>(number);
}

bool Dicer::may_cut(const FaceShading::Shaded& face, std::span<const ClipPoint, 3> triangle) const {
  if (max_shading_ == 0 || !face.varies) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const ClipPoint& a = triangle[k];
    const ClipPoint& b = triangle[(k + 1) % 3];
    const double x = b.sx / b.q - a.sx / a.q;
    const double y = b.sy / b.q - a.sy / a.q;
    if (x * x + y * y >= kLeastEdge * kLeastEdge) return true;
  }
  return false;
}

bool Dicer::differs(const FaceShading::Shaded& face, const std::array<ClipPoint, 3>& triangle) {
  if (!may_cut(face, triangle)) return false;
  const Corners t = begin(face, triangle);
  return needs_cut(face, t) || (!face.linear && is_large(t) && part_of(face, t).normal_class != face.normal_class);
}

std::int32_t Dicer::dice(const FaceShading::Shaded& face, std::span<ClipPoint, 3> triangle,
                         std::uint32_t& normal_class) {
  if (!may_cut(face, triangle)) return -1;
  const Corners t = begin(face, triangle);
  if (needs_cut(face, t)) return cut(face, t);
  if (face.linear || !is_large(t)) return -1;
  const FaceShading::Part part = part_of(face, t);
  if (part.normal_class == face.normal_class) return -1;
  normal_class = part.normal_class;
  for (std::size_t i = 0; i < 3; ++i) triangle[i].color = glm::min(at(t[i]).clip.color * part.factor, glm::dvec3(255));
  return -1;
}

}  // namespace kage
