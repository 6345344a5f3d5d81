// SPDX-License-Identifier: Apache-2.0
#include "raw_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

#include "file/one_line.hpp"
#include "kage/error.hpp"
#include "space.hpp"

namespace kage::scene {
namespace {

constexpr std::size_t kMostVertices = std::size_t{1} << 31;

/// Where in a scene something is wrong, for messages.
class Place {
 public:
  Place(std::string name) : name_(std::move(name)) {}  // NOLINT(google-explicit-constructor)
  [[nodiscard]] Place at(const std::string& part) const { return name_ + ": " + part; }
  [[noreturn]] void refuse(const std::string& why) const { throw Error(name_ + ": " + why); }
  void expect(bool holds, const std::string& why) const {
    if (!holds) refuse(why);
  }

 private:
  std::string name_;
};

bool in_unit(double v) { return v >= 0 && v <= 1; }

template <class Vector>
bool in_unit(const Vector& v) {
  return in_unit(double{v.x}) && in_unit(double{v.y}) && in_unit(double{v.z});
}

/// A list that has an entry for each of so many things, or none at all.
template <class Entry>
void check_length(const Place& place, const char* what, const std::vector<Entry>& list, std::size_t ought) {
  place.expect(list.empty() || list.size() == ought,
               std::to_string(list.size()) + " " + what + " in place of " + std::to_string(ought));
}

void append(std::vector<float>& to, const std::vector<glm::vec3>& from, std::size_t vertex) {
  if (from.empty()) return;
  const glm::vec3& v = from[vertex];
  to.insert(to.end(), {v.x, v.y, v.z});
}

void check(const Place& place, const SceneObject& o, std::size_t materials) {
  place.expect(o.positions.size() < kMostVertices && o.triangles.size() < kMostVertices, "too many vertices");
  check_length(place, "normals", o.normals, o.positions.size());
  check_length(place, "colors", o.colors, o.positions.size());
  check_length(place, "materials", o.materials, o.triangles.size());
  for (std::size_t i = 0; i < o.positions.size(); ++i)
    place.expect(is_finite(glm::dvec3(o.positions[i])), "vertex " + std::to_string(i) + ": position is not finite");
  for (std::size_t i = 0; i < o.colors.size(); ++i)
    place.expect(in_unit(o.colors[i]), "vertex " + std::to_string(i) + ": colour is not in 0 .. 1");
  for (std::size_t i = 0; i < o.triangles.size(); ++i)
    for (const std::uint32_t v : o.triangles[i])
      place.expect(v < o.positions.size(), "triangle " + std::to_string(i) + ": vertex " + std::to_string(v) + " of " +
                                               std::to_string(o.positions.size()));
  for (std::size_t i = 0; i < o.materials.size(); ++i)
    place.expect(o.materials[i] < materials, "triangle " + std::to_string(i) + ": material " +
                                                 std::to_string(o.materials[i]) + " of " + std::to_string(materials));
}

/// The triangles of one material, with the vertices that they have.
class PrimitiveMaker {
 public:
  PrimitiveMaker(const SceneObject& o, const Material& material) : object_(o) {
    primitive_.color = material.color;
    primitive_.alpha = material.alpha;
    primitive_.unlit = material.unlit;
    primitive_.double_sided = material.double_sided;
  }

  void add(const std::array<std::uint32_t, 3>& triangle) {
    for (const std::uint32_t v : triangle) primitive_.corners.push_back(vertex(v));
    primitive_.faces.push_back(primitive_.face_count++);
  }
  RawPrimitive take() { return std::move(primitive_); }

 private:
  std::uint32_t vertex(std::uint32_t of_object) {
    const auto [place, fresh] = vertices_.emplace(of_object, static_cast<std::uint32_t>(vertices_.size()));
    if (fresh) {
      append(primitive_.positions, object_.positions, of_object);
      append(primitive_.normals, object_.normals, of_object);
      append(primitive_.colors, object_.colors, of_object);
    }
    return place->second;
  }

  const SceneObject& object_;
  RawPrimitive primitive_;
  std::unordered_map<std::uint32_t, std::uint32_t> vertices_;  // of the object, as the primitive counts them
};

RawMesh raw_mesh(const SceneObject& o, const std::vector<Material>& materials) {
  std::vector<PrimitiveMaker> makers;
  std::map<std::uint32_t, std::size_t> places;  // of a material among them, in the order in which triangles have them
  for (std::size_t i = 0; i < o.triangles.size(); ++i) {
    const std::uint32_t material = o.materials.empty() ? 0 : o.materials[i];
    const auto [place, fresh] = places.emplace(material, makers.size());
    if (fresh) makers.emplace_back(o, materials[material]);
    makers[place->second].add(o.triangles[i]);
  }
  RawMesh mesh;
  mesh.name = o.name;
  for (PrimitiveMaker& maker : makers) mesh.primitives.push_back(maker.take());
  return mesh;
}

void check(const Place& place, const Camera& c) {
  const bool numbers = is_finite(c.eye) && is_finite(c.forward) && is_finite(c.up) && std::isfinite(c.near) &&
                       std::isfinite(c.far) && std::isfinite(c.aspect) && std::isfinite(c.half_height);
  place.expect(numbers, "a number is not finite");
  place.expect(length(cross(c.forward, c.up)) > 0, "the camera has no direction");
  place.expect(c.half_height > 0, "half_height is not above 0");
  place.expect(c.near > 0, "near is not above 0");
  place.expect(c.far == 0 || c.far > c.near, "far is not beyond near");
  place.expect(c.aspect >= 0, "aspect is below 0");
}

RawCamera raw_camera(const Camera& c) {
  RawCamera raw;
  raw.eye = c.eye;
  raw.forward = c.forward;
  raw.up = c.up;
  raw.perspective = c.perspective;
  raw.half_height = c.half_height;
  raw.near = c.near;
  raw.far = c.far;
  raw.aspect = c.aspect;
  return raw;
}

void check(const Place& place, const Light& l) {
  const bool numbers = is_finite(l.direction) && is_finite(l.position) && is_finite(l.color) && is_finite(l.axis_u) &&
                       is_finite(l.axis_v) && std::isfinite(l.range) && std::isfinite(l.inner_cosine) &&
                       std::isfinite(l.outer_cosine);
  place.expect(numbers, "a number is not finite");
  place.expect(l.color.x >= 0 && l.color.y >= 0 && l.color.z >= 0, "color is below 0");
  place.expect(l.range >= 0, "range is below 0");
  if (l.directional || l.spot) place.expect(length(l.direction) > 0, "direction is 0");
}

std::vector<RawLight> raw_lights(const Place& place, const std::vector<Light>& lights) {
  place.expect(lights.size() <= kMaxLights,
               std::to_string(lights.size()) + " lights, and at most " + std::to_string(kMaxLights) + " are drawn");
  std::vector<RawLight> all;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    check(place.at("light " + std::to_string(i)), lights[i]);
    all.push_back({.node = 0, .light = lights[i]});
  }
  return all;
}

void take_objects(const Place& place, const SceneParts& parts, RawScene& raw) {
  const std::vector<Material> materials = parts.materials.empty() ? std::vector<Material>(1) : parts.materials;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Place at = place.at("material " + std::to_string(i));
    at.expect(in_unit(materials[i].color), "color is not in 0 .. 1");
    at.expect(materials[i].alpha > 0 && materials[i].alpha <= 1, "alpha is not in 0 .. 1, or is 0");
  }
  raw.nodes.emplace_back();  // cameras and lights are in its frame, which is the world's
  for (const SceneObject& o : parts.objects) {
    check(place.at("object '" + one_line(o.name, 60) + "'"), o, materials.size());
    if (o.triangles.empty()) continue;
    RawNode& node = raw.nodes.emplace_back();
    node.name = o.name;
    node.mesh = static_cast<std::int32_t>(raw.meshes.size());
    raw.meshes.push_back(raw_mesh(o, materials));
  }
  if (raw.meshes.empty()) place.refuse("no faces");
  SceneContents& contents = raw.contents;
  contents.materials = static_cast<std::uint32_t>(materials.size());
  for (const Material& m : materials) {
    contents.translucent += m.alpha < 1 ? 1 : 0;
    contents.unlit += m.unlit ? 1 : 0;
    contents.single_sided += m.double_sided ? 0 : 1;
  }
  contents.says_sides = true;
}

}  // namespace

RawParts raw_parts(const SceneParts& parts) {
  const Place place(one_line(parts.name, 300));
  RawParts out;
  take_objects(place, parts, out.scene);
  for (std::size_t i = 0; i < parts.cameras.size(); ++i) {
    check(place.at("camera " + std::to_string(i)), parts.cameras[i]);
    out.cameras.push_back(raw_camera(parts.cameras[i]));
  }
  for (std::size_t i = 0; i < parts.lights.size(); ++i)
    out.lights.push_back(raw_lights(place.at("lights of frame " + std::to_string(i)), parts.lights[i]));
  const std::size_t cameras = std::max<std::size_t>(1, parts.cameras.size());
  const std::size_t sets = std::max<std::size_t>(1, parts.lights.size());
  place.expect(cameras == sets || cameras == 1 || sets == 1,
               std::to_string(cameras) + " cameras and " + std::to_string(sets) + " sets of lights");
  if (!out.cameras.empty()) out.scene.camera = out.cameras.front();
  if (!out.lights.empty()) out.scene.lights = out.lights.front();
  out.scene.contents.cameras = static_cast<std::uint32_t>(parts.cameras.size());
  out.scene.contents.lights = static_cast<std::uint32_t>(out.scene.lights.size());
  if (cameras > 1 || sets > 1) out.scene.frames = static_cast<std::uint32_t>(std::max(cameras, sets));
  if (out.cameras.size() == 1) out.cameras.clear();
  if (out.lights.size() == 1) out.lights.clear();
  return out;
}

}  // namespace kage::scene
