// SPDX-License-Identifier: Apache-2.0
#include "extremes/plane_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <span>

#include "geometry/sampled_lights.hpp"
#include "geometry/seen.hpp"
#include "oracle/exact_screen.hpp"
#include "oracle/oracle.hpp"
#include "shadow/kept.hpp"
#include "shadow/volumes.hpp"

namespace kage::verif {
namespace {

double length(const PrecisePoint& p) { return sqrt(p.x * p.x + p.y * p.y + p.w * p.w).convert_to<double>(); }

PrecisePoint minus(const PrecisePoint& a, const PrecisePoint& b) { return {a.x - b.x, a.y - b.y, a.w - b.w}; }

PrecisePoint cross(const PrecisePoint& a, const PrecisePoint& b) {
  return {a.y * b.w - a.w * b.y, a.w * b.x - a.x * b.w, a.x * b.y - a.y * b.x};
}

/// A frame on the screen as exact arithmetic has it.
struct Truth {
  Truth(const SceneFrame& f, const Config& config, int w, int h, const Look& look)
      : camera(f.camera),
        screen(f.camera, w, h),
        range(depth_range(f, config, w, h, look, eye_points(f))),
        z_bits(config.z_bits),
        height(h),
        sub_bits(look.sub_bits) {}

  Camera camera;
  ExactScreen screen;
  DepthRange range;
  int z_bits;
  int height;
  int sub_bits;
};

/// A face before the snap: its plane over the screen, and its corners after clipping.
class TrueFace {
 public:
  /// `plane`: corners whose plane it is; `outline`: all of its corners, in order. `at_far`: it is cut where volumes
  /// are.
  TrueFace(const Truth& truth, const std::array<glm::dvec3, 3>& plane, std::span<const glm::dvec3> outline, bool at_far)
      : truth_(&truth) {
    std::vector<PrecisePoint> points;
    for (const glm::dvec3& p : outline) points.push_back(truth.screen.point(p));
    for (const PrecisePoint& p : points) reach_ = std::max(reach_, length(p));
    find_slopes(plane);
    const Real near(truth.range.near);
    // A hundredth of the depth's range past its end.
    const Real end = Real(truth.range.far) + (Real(truth.range.far) - near) / 100;
    find_doubt(points, near, end);
    truth.screen.clip(points, truth.range.near);
    if (at_far) ExactScreen::cut_behind(points, end);
    for (const PrecisePoint& p : points) {
      nearest_ = std::min(nearest_, p.w.convert_to<double>());
      const Real scale = truth.screen.scale(p);
      corners_.push_back({Real(truth.screen.x(p) / scale).convert_to<double>(),
                          Real(truth.screen.y(p) / scale).convert_to<double>(),
                          truth.screen.depth(p, truth.range.near, truth.range.far, truth.z_bits)});
    }
  }

  /// Its plane is one that has a mean depth in its place, or nearly so.
  [[nodiscard]] bool is_edge_on() const {
    const double most = std::ldexp(0.999, truth_->z_bits + truth_->sub_bits);
    return !(slope_x_ <= most && slope_y_ <= most);
  }

  /// Doubles may cut it elsewhere: a corner lies next to a plane that it is cut at, or an edge nearly along one.
  [[nodiscard]] bool is_doubtful() const { return doubtful_; }

  /// |a| + |b|, in LSB a pixel.
  [[nodiscard]] double slope() const { return slope_x_ + slope_y_; }

  /// How far a plane that kage has for some of the face, with these snapped corners, is off the corners' own depths,
  /// and what it may be, `more` LSB included. Empty if the corners are not the face's.
  [[nodiscard]] std::optional<Outcome> errors(std::span<const ScreenVertex> snapped, const ScreenPlane& plane,
                                              double more) const {
    Outcome o;
    for (const ScreenVertex& v : snapped) {
      // Two true corners may have come to one place.
      std::optional<double> least;
      double bound = 0;
      for (const Corner& c : corners_) {
        if (!snaps_to(c, v)) continue;
        const Real off = abs(value(plane, v) - c.z);
        if (!least || off < *least) {
          least = off.convert_to<double>();
          const double pixels = std::abs(v.x / 256.0 - plane.x0 - 0.5) + std::abs(v.y / 256.0 - plane.y0 - 0.5);
          bound = std::ldexp(slope(), -truth_->sub_bits - 1) + more + (pixels + 2) * 0x1p-25 + in_doubles(pixels);
        }
      }
      if (!least) return std::nullopt;
      ++o.items;
      o.measure(*least, bound);
    }
    return o;
  }

 private:
  struct Corner {
    double x, y;  ///< in pixels
    Real z;       ///< in LSB
  };

  [[nodiscard]] bool snaps_to(const Corner& c, const ScreenVertex& v) const {
    const double half = std::ldexp(0.5, -truth_->sub_bits) * (1 + 0x1p-10);
    return std::abs(c.x - v.x / 256.0) <= half && std::abs(c.y - v.y / 256.0) <= half;
  }

  static Real value(const ScreenPlane& p, const ScreenVertex& v) {
    return (Real(p.c) + Real(p.a) * (Real(v.x) / 256 - p.x0 - Real(0.5)) +
            Real(p.b) * (Real(v.y) / 256 - p.y0 - Real(0.5))) /
           (1 << kPlaneFrac);
  }

  void find_doubt(std::span<const PrecisePoint> points, const Real& near, const Real& end) {
    const auto look = [&](double size, const auto& distance) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double a = Real(distance(points[i])).convert_to<double>();
        const double b = Real(distance(points[(i + 1) % points.size()])).convert_to<double>();
        if (std::abs(a) <= 0x1p-40 * size || ((a < 0) != (b < 0) && std::abs(a - b) <= 0x1p-12 * size))
          doubtful_ = true;
      }
    };
    const ExactScreen& s = truth_->screen;
    const double size = (1 + reach_) * kGuard;
    look(reach_, [&](const PrecisePoint& p) { return p.w - near; });
    look(reach_, [&](const PrecisePoint& p) { return p.w - end; });
    look(size, [&](const PrecisePoint& p) { return s.scale(p) * kGuard - s.x(p); });
    look(size, [&](const PrecisePoint& p) { return s.scale(p) * kGuard + s.x(p); });
    look(size, [&](const PrecisePoint& p) { return s.scale(p) * kGuard - s.y(p); });
    look(size, [&](const PrecisePoint& p) { return s.scale(p) * kGuard + s.y(p); });
  }

  void find_slopes(const std::array<glm::dvec3, 3>& plane) {
    const std::array at{truth_->screen.point(plane[0]), truth_->screen.point(plane[1]), truth_->screen.point(plane[2])};
    const PrecisePoint e = minus(at[1], at[0]);
    const PrecisePoint f = minus(at[2], at[0]);
    const PrecisePoint n = cross(e, f);
    const bool perspective = truth_->camera.perspective;
    const Real through = perspective ? n.x * at[0].x + n.y * at[0].y + n.w * at[0].w : n.w;
    if (through == 0) {
      slope_x_ = slope_y_ = INFINITY;
      return;
    }
    // Depth changes by `steps` for 1/w (perspective) or w; a pixel is `pixel` wide at w = 1 or anywhere.
    const Real range((std::int64_t{1} << truth_->z_bits) - 3);
    const Real near(truth_->range.near);
    const Real far(truth_->range.far);
    const Real steps = range / (far - near) * (perspective ? near * far : Real(1));
    const Real pixel = Real(truth_->camera.half_height) * 2 / truth_->height;
    slope_x_ = Real(abs(steps * pixel * n.x / through)).convert_to<double>();
    slope_y_ = Real(abs(steps * pixel * n.y / through)).convert_to<double>();
    steps_ = steps.convert_to<double>();
    pixel_ = pixel.convert_to<double>();
    // docs/numbers.md, "The plane": what rounding in doubles does to the normal, to what it is divided by, and so to a
    // slope.
    const double sum = length(e) + length(f);
    const double of_normal = 0x1p-46 * reach_ * sum;
    const double of_through = perspective ? 0x1p-44 * reach_ * reach_ * sum : of_normal;
    const double size = std::abs(through.convert_to<double>());
    const double share = of_through / size;
    slope_error_ = share < 0.5 ? 2 * (steps_ * pixel_ * of_normal / size + slope() * (share + 0x1p-49)) : INFINITY;
  }

  /// Greatest rounding error of doubles at a corner `pixels` columns and lines from the plane's anchor, another corner.
  [[nodiscard]] double in_doubles(double pixels) const {
    const double place = 0x1p-46 * reach_;  // of a corner, in space
    const double w = truth_->camera.perspective ? nearest_ : 1;
    return slope_error_ * pixels + 2 * place * (slope() * (1 + reach_ / w) / (pixel_ * w) + steps_ / (w * w));
  }

  const Truth* truth_;
  double reach_ = 0;           ///< the distance of the corner that is furthest from the eye
  double nearest_ = INFINITY;  ///< the least distance of a corner after clipping
  double slope_x_ = 0, slope_y_ = 0;
  double slope_error_ = 0;
  double steps_ = 0;
  bool doubtful_ = false;
  double pixel_ = 0;
  std::vector<Corner> corners_;
};

/// A polygon's corners and plane as kage has them, or as a injected error spoils them.
struct Given {
  Given(const FrameGeometry& g, const ScreenPolygon& p, const Context& context) : plane(p.depth) {
    const auto outline = g.outline(p);
    corners.assign(outline.begin(), outline.end());
    if (context.injected(Injection::moved_corner)) corners.back().x += snap_step(g);
    if (context.injected(Injection::tilted_plane)) plane.a += plane.a / 64;
  }

  std::vector<ScreenVertex> corners;
  ScreenPlane plane;
};

}  // namespace

Outcome unsnapped_planes_hold(const SceneFrame& f, const Config& config, int width, int height, const Look& look,
                              const Context& context) {
  const FrameGeometry g = make_geometry(f, config, width, height, {.look = look});
  const Truth truth(f, config, width, height, look);
  Outcome o;
  for (const ScreenPolygon& p : std::span(g.polygons).first(g.drawn)) {
    const Polygon& face = f.polygons[p.source];
    if (face.count == 3) continue;
    std::vector<glm::dvec3> outline;
    for (const std::uint32_t v : f.outline(face)) outline.push_back(f.vertices[v]);
    const Triangle& t = f.triangles[face.triangle];
    const TrueFace exact(truth, {f.vertices[t.vertex[0]], f.vertices[t.vertex[1]], f.vertices[t.vertex[2]]}, outline,
                         false);
    if (exact.is_edge_on()) continue;
    const Given given(g, p, context);
    if (const auto errors = exact.errors(given.corners, given.plane, 0))
      o.add(*errors);
    else if (!exact.is_doubtful())
      o.fail(fmt::format("a corner of face {} is none of its own, snapped", p.source));
  }
  return o;
}

Outcome sides_hold(const SceneFrame& f, const Config& config, int width, int height, Look look,
                   const Context& context) {
  look.leave_out = false;
  const FrameGeometry g = make_geometry(f, config, width, height, {.look = look});
  const Truth truth(f, config, width, height, look);
  // The sides are made from the volumes in space. Whether these are right is not asked here.
  const View view(f.camera, width, height, config.z_bits, truth.range, look.sub_bits);
  const SampledLights lights(f, config, look, view.near_corners());
  const std::vector<SpaceBox> boxes = component_boxes(f);
  ShadowCache cache;
  VolumeCaster volumes(f, boxes, config.dsf_bits, look.volumes, ShadowCacheInside::of(cache));
  const ShadowCaster& caster = lights.samples()[0];
  std::vector<TrueFace> sides;
  volumes.make(0, caster, [&](const WorldVolume& w, std::uint32_t) {
    const double factor = caster.far_factor(w.caps);
    for (const SideEdge& s : w.sides) {
      const std::array outline{f.vertices[s.a], caster.far_point(f.vertices[s.a], factor),
                               caster.far_point(f.vertices[s.b], factor), f.vertices[s.b]};
      sides.emplace_back(truth, std::array{outline[0], outline[3], outline[1]}, outline, true);
    }
  });
  const bool doubtful = std::any_of(sides.begin(), sides.end(), [](const TrueFace& s) { return s.is_doubtful(); });
  Outcome o;
  for (const VolumeFace& face : g.volume_faces) {
    const ScreenPolygon& p = g.polygons[face.polygon];
    if (p.source != ~0U) continue;  // a cap
    const Given given(g, p, context);
    // Sides may have the same corners on the screen: the one that fits best.
    std::optional<Outcome> best;
    bool open = false;
    for (const TrueFace& side : sides) {
      // An LSB is what a side's corners may be off their plane; both it and depths are rounded to 2^-16 LSB.
      const auto errors = side.errors(given.corners, given.plane, 1 + 0x1p-15);
      if (!errors) continue;
      open = open || side.is_edge_on();
      if (!best || errors->share() < best->share()) best = errors;
    }
    if (!best && !doubtful)
      o.fail("a corner of a side is none of its own, snapped");
    else if (best && !open)
      o.add(*best);
  }
  return o;
}

}  // namespace kage::verif
