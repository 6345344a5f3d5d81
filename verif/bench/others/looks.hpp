// SPDX-License-Identifier: Apache-2.0
//
// Parts shared by all renderers of the benchmark: the flat colour of a face as kage has it, worked out when it is first
// asked for, and the picture that they fill.
#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "geometry/shade.hpp"
#include "geometry/view.hpp"
#include "kage/geometry.hpp"
#include "shadow/shadow_caster.hpp"

namespace kage::verif {

/// Three bytes a pixel, lines from top to bottom.
using Picture = std::vector<std::uint8_t>;

/// Content of the drawing: the picture, or the shadow alone: black in shadow, white on a face without shadow, grey
/// where there is no face.
enum class Shown { picture, shadow };

inline constexpr std::array<std::uint8_t, 3> kShadowBackground{128, 128, 128};

struct FaceLook {
  std::array<std::uint8_t, 3> color{};
  bool lit = false;  ///< eye and light are on the same side
};

/// The faces of a frame with one light. Refers to what it is made of.
class Looks {
 public:
  Looks(const SceneFrame& frame, const ShadowCaster& caster, Shown shown)
      : frame_(&frame),
        caster_(&caster),
        lighting_(frame.lights, frame.camera.up, false),
        shown_(shown),
        looks_(frame.polygons.size()),
        known_(frame.polygons.size(), 0) {}

  /// > 0 where the eye is outside of the polygon.
  [[nodiscard]] double facing(const Polygon& face) const {
    const Triangle& t = frame_->triangles[face.triangle];
    const glm::dvec3& p = frame_->vertices[t.vertex[0]];
    const glm::dvec3 normal = glm::cross(frame_->vertices[t.vertex[1]] - p, frame_->vertices[t.vertex[2]] - p);
    const Camera& c = frame_->camera;
    return c.perspective ? glm::dot(normal, c.eye - p) : -glm::dot(normal, c.forward);
  }

  const FaceLook& operator[](std::uint32_t polygon) {
    if (known_[polygon] == 0) {
      known_[polygon] = 1;
      looks_[polygon] = make(frame_->polygons[polygon]);
    }
    return looks_[polygon];
  }

 private:
  [[nodiscard]] FaceLook make(const Polygon& face) const {
    FaceLook look;
    const double to_eye = facing(face);
    look.lit = to_eye * caster_->facing(face) > 0;
    look.color = {255, 255, 255};
    if (shown_ == Shown::shadow) return look;
    const Triangle& t = frame_->triangles[face.triangle];
    const auto corners = frame_->outline(face);
    const std::array<std::int8_t, 1> before{static_cast<std::int8_t>(look.lit ? 1 : 0)};
    const bool by_place = lighting_.depends_on_place(before, 1);
    glm::dvec3 sum{0, 0, 0};
    glm::dvec3 color{0, 0, 0};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t of_corner = t.shading[corners.size() == 3 ? i : 0];
      const ShadingVertex& s = frame_->shading[of_corner];
      // As kage does it: a corner that looks as the one before is not worked out again.
      if (i == 0 || by_place || (corners.size() == 3 && of_corner != t.shading[i - 1]))
        color = color_of(frame_->vertices[corners[i]], to_eye < 0 ? -s.normal : s.normal, s.color, before);
      sum += color;
    }
    for (std::size_t c = 0; c < 3; ++c)
      look.color[c] = static_cast<std::uint8_t>(
          to_fixed(std::clamp(sum[static_cast<int>(c)] / static_cast<double>(corners.size()), 0.0, 255.0), 0));
    return look;
  }

  [[nodiscard]] glm::dvec3 color_of(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& base,
                                    const std::array<std::int8_t, 1>& before) const {
    glm::dvec3 light;
    lighting_.arriving(point, normal, before, 1, std::span(&light, 1));
    return lighting_.displayed(normal, base, light);
  }

  const SceneFrame* frame_;
  const ShadowCaster* caster_;
  Lighting lighting_;
  Shown shown_;
  std::vector<FaceLook> looks_;
  std::vector<std::uint8_t> known_;
};

}  // namespace kage::verif
