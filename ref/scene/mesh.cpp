// SPDX-License-Identifier: Apache-2.0
#include "mesh.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "transform.hpp"

namespace kage::scene {
namespace {

constexpr std::uint32_t kNoSlot = 0xffffffffu;

glm::dvec3 triple(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

glm::dvec3 clamped(const glm::dvec3& c) {
  return {std::clamp(c.x, 0.0, 1.0), std::clamp(c.y, 0.0, 1.0), std::clamp(c.z, 0.0, 1.0)};
}

// A triangle before topology: where its corners come from.
struct Source {
  std::uint32_t primitive;
  Corners vertex;  // within the primitive
};

class Builder {
 public:
  Builder(const RawMesh& raw, std::uint64_t& budget) : raw_(raw), budget_(budget) {}

  Mesh run() {
    collect();
    assemble(false);
    assemble(true);
    shade();
    for (MeshComponent& c : mesh_.components) {
      if (mesh_.motion && c.convex) {
        c.convex = false;
        c.reason.kind = Reason::Kind::kMoved;
      }
      c.first_polygon = static_cast<std::uint32_t>(mesh_.polygons.size());
      append_polygons(mesh_.vertices, std::span(mesh_.triangles).subspan(c.first, c.count),
                      std::span(mesh_.shading_corners).subspan(c.first, c.count), mesh_.shading,
                      std::span(mesh_.surfaces).subspan(c.first, c.count), c.first, c.convex && !c.translucent,
                      mesh_.polygons, mesh_.corners);
      c.polygon_count = static_cast<std::uint32_t>(mesh_.polygons.size()) - c.first_polygon;
    }
    for (std::size_t t = 0; t < mesh_.triangles.size() && !mesh_.has_area; ++t)
      mesh_.has_area = face_cross(t) != glm::dvec3{0, 0, 0};
    return std::move(mesh_);
  }

 private:
  static Corners turned(const Corners& c, bool reversed) { return reversed ? Corners{c[0], c[2], c[1]} : c; }

  void collect();
  void assemble(bool translucent);
  void part_moved(std::vector<std::uint32_t>& number);
  void keep_used_vertices();
  void shade();
  void shade_component(const MeshComponent& c);
  /// Across a face, twice its area long.
  [[nodiscard]] glm::dvec3 face_cross(std::size_t triangle) const;
  [[nodiscard]] glm::dvec3 face_normal(std::size_t triangle) const;
  /// The file's normal at a corner, of length 1, or 0 where it has none to speak of.
  [[nodiscard]] glm::dvec3 file_normal(const Source& s, std::size_t corner) const;
  [[nodiscard]] glm::dvec3 color(const Source& s, std::size_t corner) const;
  [[nodiscard]] Surface surface(const Source& s, bool reversed) const {
    const RawPrimitive& p = raw_.primitives[s.primitive];
    return {alpha(s), p.unlit, p.double_sided ? Sides::both : reversed ? Sides::back : Sides::front};
  }
  [[nodiscard]] std::uint8_t alpha(const Source& s) const {
    return static_cast<std::uint8_t>(std::lround(std::clamp(raw_.primitives[s.primitive].alpha, 0.0, 1.0) * 255));
  }
  std::uint32_t add(const ShadingVertex& v, const Motion::Normal& from) {
    mesh_.shading.push_back(v);
    if (mesh_.motion) mesh_.motion->shading.push_back(from);
    return static_cast<std::uint32_t>(mesh_.shading.size() - 1);
  }

  const RawMesh& raw_;
  std::uint64_t& budget_;
  Mesh mesh_;
  std::vector<Corners> welded_;
  std::vector<std::uint32_t> faces_;
  std::vector<Source> sources_;
  std::vector<Source> ordered_;
  std::vector<std::size_t> first_vertex_;  // of each primitive in the concatenation of all
  std::vector<std::uint32_t> slots_;  // shading vertex of a file's vertex: as in the file, and with its normal negated
};

void Builder::collect() {
  std::vector<float> positions;
  for (const RawPrimitive& p : raw_.primitives) {
    first_vertex_.push_back(positions.size() / 3);
    positions.insert(positions.end(), p.positions.begin(), p.positions.end());
  }
  slots_.assign(positions.size() / 3 * 2, kNoSlot);
  std::vector<std::uint32_t> number = weld(positions, mesh_.vertices);
  const auto moves = [](const RawPrimitive& p) { return !p.joints.empty() || !p.targets.empty(); };
  if (std::any_of(raw_.primitives.begin(), raw_.primitives.end(), moves)) part_moved(number);
  std::uint32_t first_face = 0;
  for (std::uint32_t k = 0; k < raw_.primitives.size(); ++k) {
    const RawPrimitive& p = raw_.primitives[k];
    for (std::size_t t = 0; t < p.triangle_count(); ++t) {
      Source s{k, {p.corners[3 * t], p.corners[3 * t + 1], p.corners[3 * t + 2]}};
      Corners c{};
      for (std::size_t i = 0; i < 3; ++i) c[i] = number[first_vertex_[k] + s.vertex[i]];
      if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) {
        ++mesh_.dropped;
        continue;
      }
      welded_.push_back(c);
      faces_.push_back(first_face + p.faces[t]);
      sources_.push_back(s);
    }
    first_face += p.face_count;
  }
  keep_used_vertices();
}

// Vertices at one place that are not moved alike are not one.
void Builder::part_moved(std::vector<std::uint32_t>& number) {
  mesh_.motion = motion_of(raw_);
  std::vector<std::vector<std::uint32_t>> there(mesh_.vertices.size());  // of each place the sources that part
  std::vector<std::uint32_t> own(number.size());
  std::vector<glm::dvec3> vertices;
  std::vector<std::uint32_t>& sources = mesh_.motion->sources;
  for (std::uint32_t source = 0; source < number.size(); ++source) {
    std::vector<std::uint32_t>& others = there[number[source]];
    const auto same = std::find_if(others.begin(), others.end(),
                                   [&](std::uint32_t other) { return mesh_.motion->same(other, source); });
    if (same != others.end()) {
      own[source] = own[*same];
      continue;
    }
    others.push_back(source);
    own[source] = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(mesh_.vertices[number[source]]);
    sources.push_back(source);
  }
  number = std::move(own);
  mesh_.vertices = std::move(vertices);
}

// Opaque and translucent triangles make separate components: glass in a wall leaves a hole in it.
void Builder::assemble(bool translucent) {
  std::vector<std::uint32_t> of;
  std::vector<Corners> triangles;
  for (std::uint32_t t = 0; t < welded_.size(); ++t) {
    if ((alpha(sources_[t]) < 255) != translucent) continue;
    of.push_back(t);
    triangles.push_back(welded_[t]);
  }
  if (of.empty()) return;
  const Topology topology = analyse(mesh_.vertices, triangles, budget_);
  const auto first = static_cast<std::uint32_t>(mesh_.triangles.size());
  for (MeshComponent c : topology.components) {
    c.first += first;
    c.translucent = translucent;
    mesh_.components.push_back(c);
  }
  mesh_.turned += topology.turned;
  mesh_.inside_out += topology.inside_out;
  for (const std::uint32_t i : topology.order) {
    const bool reversed = topology.reversed[i];
    const std::uint32_t t = of[i];
    mesh_.triangles.push_back(turned(welded_[t], reversed));
    mesh_.faces.push_back(faces_[t]);
    mesh_.surfaces.push_back(surface(sources_[t], reversed));
    ordered_.push_back({sources_[t].primitive, turned(sources_[t].vertex, reversed)});
  }
}

// Vertices of points, lines and dropped triangles would only blow up the bounds.
void Builder::keep_used_vertices() {
  std::vector<std::uint32_t> number(mesh_.vertices.size(), kNoSlot);
  for (const Corners& c : welded_)
    for (const std::uint32_t v : c) number[v] = 0;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kNoSlot) continue;
    number[v] = kept;
    if (mesh_.motion) mesh_.motion->sources[kept] = mesh_.motion->sources[v];
    mesh_.vertices[kept++] = mesh_.vertices[v];
  }
  mesh_.vertices.resize(kept);
  if (mesh_.motion) mesh_.motion->sources.resize(kept);
  for (Corners& c : welded_)
    for (std::uint32_t& v : c) v = number[v];
}

glm::dvec3 Builder::face_cross(std::size_t triangle) const {
  const Corners& t = mesh_.triangles[triangle];
  const glm::dvec3& a = mesh_.vertices[t[0]];
  return cross(mesh_.vertices[t[1]] - a, mesh_.vertices[t[2]] - a);
}

glm::dvec3 Builder::face_normal(std::size_t triangle) const {
  // A face without area has no normal, nor a pixel: any will do.
  return unit(face_cross(triangle), {0, 1, 0});
}

glm::dvec3 Builder::file_normal(const Source& s, std::size_t corner) const {
  const RawPrimitive& p = raw_.primitives[s.primitive];
  if (p.normals.empty()) return {0, 0, 0};
  return unit(triple(p.normals, s.vertex[corner]), {0, 0, 0});
}

glm::dvec3 Builder::color(const Source& s, std::size_t corner) const {
  const RawPrimitive& p = raw_.primitives[s.primitive];
  if (p.colors.empty()) return clamped(p.color);
  const glm::dvec3 c = triple(p.colors, s.vertex[corner]);
  return clamped({p.color.x * c.x, p.color.y * c.y, p.color.z * c.z});
}

// The winding decides what is outside; the file's normals follow it, by a majority over the component, because single
// corners of a coarse mesh may well lean away from their face.
void Builder::shade_component(const MeshComponent& c) {
  double agreement = 0;
  for (std::uint32_t t = c.first; t < c.first + c.count; ++t) {
    const glm::dvec3 n = face_normal(t);
    for (std::size_t i = 0; i < 3; ++i) agreement += dot(file_normal(ordered_[t], i), n);
  }
  const bool negate = agreement < 0;
  for (std::uint32_t t = c.first; t < c.first + c.count; ++t) {
    const Source& s = ordered_[t];
    const RawPrimitive& p = raw_.primitives[s.primitive];
    Corners corners{};
    std::uint32_t of_face =
        kNoSlot;  // corners without a normal of their own share the face's, if they are of one colour
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 n = file_normal(s, i);
      if (n.x == 0 && n.y == 0 && n.z == 0) {
        if (!p.normals.empty()) ++mesh_.bad_normals;
        if (of_face == kNoSlot || !p.colors.empty()) of_face = add({face_normal(t), color(s, i)}, {t, true, false});
        corners[i] = of_face;
        continue;
      }
      const auto source = static_cast<std::uint32_t>(first_vertex_[s.primitive] + s.vertex[i]);
      std::uint32_t& slot = slots_[2 * std::size_t{source} + (negate ? 1 : 0)];
      if (slot == kNoSlot) slot = add({negate ? -n : n, color(s, i)}, {source, false, negate});
      corners[i] = slot;
    }
    const auto differ = [&](std::uint32_t a, std::uint32_t b) {
      const ShadingVertex& u = mesh_.shading[a];
      const ShadingVertex& v = mesh_.shading[b];
      return (u.normal != v.normal && !p.unlit) || u.color != v.color;
    };
    mesh_.smooth = mesh_.smooth || differ(corners[0], corners[1]) || differ(corners[0], corners[2]);
    mesh_.shading_corners.push_back(corners);
  }
}

void Builder::shade() {
  for (const MeshComponent& c : mesh_.components) shade_component(c);
}

}  // namespace

Mesh build_mesh(const RawMesh& raw, std::uint64_t& budget) { return Builder(raw, budget).run(); }

}  // namespace kage::scene
