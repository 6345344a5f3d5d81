// SPDX-License-Identifier: Apache-2.0
#include "deform.hpp"

#include <algorithm>

#include "mesh.hpp"
#include "transform.hpp"

namespace kage::scene {
namespace {

glm::dvec3 vertex_of(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

/// Appends what a primitive has, or as many zeros where it has none.
template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from, std::size_t count) {
  to.insert(to.end(), from.begin(), from.end());
  if (from.empty()) to.resize(to.size() + count);
}

class Mover {
 public:
  Mover(const Mesh& mesh, const std::vector<Affine>& bones, const std::vector<double>& weights)
      : mesh_(mesh), motion_(*mesh.motion), bones_(bones), weights_(weights) {}

  Moved run() {
    Moved out;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      const std::uint32_t source = motion_.sources[v];
      out.vertices.push_back(map(source).point(morphed(mesh_.vertices[v], source, &RawTarget::positions)));
    }
    out.mirrored = !mesh_.vertices.empty() && map(motion_.sources[0]).determinant() < 0;
    for (std::size_t s = 0; s < mesh_.shading.size(); ++s) out.shading.push_back(shading(s, out));
    return out;
  }

 private:
  [[nodiscard]] glm::dvec3 morphed(glm::dvec3 v, std::size_t source, std::vector<float> RawTarget::*part) const {
    for (std::size_t t = 0; t < motion_.targets.size(); ++t) {
      const std::vector<float>& by = motion_.targets[t].*part;
      if (!by.empty() && weights_[t] != 0) v = v + vertex_of(by, source) * weights_[t];
    }
    return v;
  }

  /// The mean of the joints' maps, by weight.
  [[nodiscard]] Affine map(std::size_t source) const {
    if (motion_.influences == 0 || bones_.size() == 1) return bones_[0];
    Affine mean{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    double sum = 0;
    for (std::size_t k = source * motion_.influences; k < (source + 1) * motion_.influences; ++k)
      sum += motion_.weights[k];
    if (!(sum > 0)) return bones_[motion_.joints[source * motion_.influences]];
    for (std::size_t k = source * motion_.influences; k < (source + 1) * motion_.influences; ++k) {
      if (motion_.weights[k] == 0) continue;
      const double w = motion_.weights[k] / sum;
      const Affine& bone = bones_[motion_.joints[k]];
      mean.x = mean.x + bone.x * w;
      mean.y = mean.y + bone.y * w;
      mean.z = mean.z + bone.z * w;
      mean.origin = mean.origin + bone.origin * w;
    }
    return mean;
  }

  [[nodiscard]] ShadingVertex shading(std::size_t s, const Moved& out) const {
    const Motion::Normal& from = motion_.shading[s];
    ShadingVertex v = mesh_.shading[s];
    if (from.of_face) {
      const Corners& t = mesh_.triangles[from.number];
      const glm::dvec3& a = out.vertices[t[0]];
      const glm::dvec3 across = cross(out.vertices[t[1]] - a, out.vertices[t[2]] - a);
      v.normal = unit(out.mirrored ? -across : across, {0, 1, 0});
      return v;
    }
    const glm::dvec3 n =
        unit(morphed(vertex_of(motion_.normals, from.number), from.number, &RawTarget::normals), v.normal);
    const glm::dvec3 in_world = unit(map(from.number).normal(n), n);
    v.normal = from.negated ? -in_world : in_world;
    return v;
  }

  const Mesh& mesh_;
  const Motion& motion_;
  const std::vector<Affine>& bones_;
  const std::vector<double>& weights_;
};

}  // namespace

bool Motion::same(std::size_t a, std::size_t b) const {
  const auto equal = [a, b](const auto& values, std::size_t width) {
    if (values.empty()) return true;
    const auto begin = values.begin();
    return std::equal(begin + static_cast<std::ptrdiff_t>(a * width),
                      begin + static_cast<std::ptrdiff_t>((a + 1) * width),
                      begin + static_cast<std::ptrdiff_t>(b * width));
  };
  return equal(joints, influences) && equal(weights, influences) &&
         std::all_of(targets.begin(), targets.end(), [&](const RawTarget& t) { return equal(t.positions, 3); });
}

Motion motion_of(const RawMesh& raw) {
  Motion m;
  for (const RawPrimitive& p : raw.primitives)
    if (p.vertex_count() > 0) m.influences = std::max(m.influences, p.joints.size() / p.vertex_count());
  for (const RawPrimitive& p : raw.primitives) {
    const std::size_t n = p.vertex_count();
    const std::size_t own = n == 0 ? 0 : p.joints.size() / n;
    for (std::size_t v = 0; v < n; ++v)
      for (std::size_t k = 0; k < m.influences; ++k) {
        m.joints.push_back(k < own ? p.joints[v * own + k] : 0);
        m.weights.push_back(k < own ? p.weights[v * own + k] : 0);
      }
    append(m.normals, p.normals, 3 * n);
    m.targets.resize(std::max(m.targets.size(), p.targets.size()));
  }
  for (std::size_t t = 0; t < m.targets.size(); ++t)
    for (const RawPrimitive& p : raw.primitives) {
      append(m.targets[t].positions, p.targets[t].positions, 3 * p.vertex_count());
      append(m.targets[t].normals, p.targets[t].normals, 3 * p.vertex_count());
    }
  return m;
}

Moved moved(const Mesh& mesh, const std::vector<Affine>& bones, const std::vector<double>& weights) {
  return Mover(mesh, bones, weights).run();
}

}  // namespace kage::scene
