// SPDX-License-Identifier: Apache-2.0
// The effect of rounding in doubles before the snap. Transform, clipping and projection of every corner of every drawn
// face are done once more in floating point of 333 bits, which shares no arithmetic with the golden model.
//
// `scene_precision -s` prints how many corners snap otherwise, a line for each scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "geometry/seen.hpp"
#include "kage/geometry.hpp"
#include "oracle/exact_screen.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

using Points = std::vector<PrecisePoint>;

Points outline(const SceneFrame& f, const Points& points, std::uint32_t polygon) {
  Points all;
  for (const std::uint32_t v : f.outline(f.polygons[polygon])) all.push_back(points[v]);
  return all;
}

/// Where depth begins, by docs/numbers.md.
double begin(const SceneFrame& f, const Points& points, const ExactScreen& screen) {
  Real nearest = -1;
  Real far = 0;
  for (const PrecisePoint& p : points) far = std::max(far, p.w);
  far *= 1 + Real(1e-6);
  for (std::uint32_t i = 0; i < f.polygons.size(); ++i) {
    Points p = outline(f, points, i);
    screen.to_picture(p, f.camera.near);
    for (const PrecisePoint& c : p)
      if (nearest < 0 || c.w < nearest) nearest = c.w;
  }
  if (nearest < 0) return f.camera.near;
  const Real deep = f.camera.perspective ? nearest : Real(far - nearest);
  const Real least = nearest - ldexp(deep, -20);
  Real unit = 1;
  const Real below = f.camera.perspective ? least : deep;
  while (unit > below) unit /= 2;
  while (unit * 2 <= below) unit *= 2;
  const Real w0 = f.camera.perspective ? unit : Real(floor(least / unit) * unit);
  return std::max(f.camera.near, w0.convert_to<double>());
}

struct Count {
  std::uint64_t corners = 0;
  std::uint64_t other = 0;  ///< that snap otherwise
  std::uint64_t most = 0;   ///< subpixels that one does, at most
  std::uint64_t faces = 0;  ///< with other corners than the same number of them: clipping went another way
  std::uint64_t cut = 0;    ///< faces that are clipped

  /// Compares exact arithmetic on `f` with what the golden model makes of `given`.
  void add(const SceneFrame& f, const SceneFrame& given) {
    const ExactScreen screen(f.camera, kWidth, kHeight);
    Points points;
    points.reserve(f.vertices.size());
    for (const glm::dvec3& v : f.vertices) points.push_back(screen.point(v));
    Config config;
    config.max_width = 2047;
    const double near = begin(f, points, screen);
    CHECK(near == depth_range(given, config, kWidth, kHeight, {}, eye_points(given)).near);
    const FrameGeometry g = make_geometry(given, config, kWidth, kHeight);
    for (const ScreenPolygon& p : g.polygons) {
      if (p.source == ~0U) continue;
      Points truth = outline(f, points, p.source);
      const std::size_t whole = truth.size();
      const auto at = g.outline(p);
      screen.clip(truth, near);
      if (truth.size() != whole) ++cut;
      if (truth.size() != at.size()) {
        ++faces;
        continue;
      }
      for (std::size_t i = 0; i < at.size(); ++i) {
        const ScreenVertex exact = screen.snap(truth[i]);
        ++corners;
        const std::int64_t off =
            std::max(std::abs(std::int64_t{exact.x} - at[i].x), std::abs(std::int64_t{exact.y} - at[i].y));
        other += off > 0 ? 1 : 0;
        most = std::max(most, static_cast<std::uint64_t>(off));
      }
    }
  }

  [[nodiscard]] std::string text() const {
    return fmt::format("{} corners, {} snap otherwise, by {} subpixel at most; {} faces clipped, {} with other corners",
                       corners, other, most, cut, faces);
  }
};

void check(const std::string& name, int step) {
  const Scene scene = Scene::load(name);
  Count count;
  for (int i = 0; i < scene.frame_count(); i += step) {
    const SceneFrame f = scene.frame(i, scene.frame_count());
    count.add(f, f);
  }
  UNSCOPED_INFO(fmt::format("{}: {}", name, count.text()));
  CAPTURE(name);
  CHECK(count.corners > 0);
  CHECK(count.other == 0);
  CHECK(count.faces == 0);
}

}  // namespace

TEST_CASE("what rounding snaps otherwise shows: places that have been through single precision, and far away") {
  const Scene scene = Scene::load("polyhedra");
  const SceneFrame f = scene.frame(1, scene.frame_count());
  SceneFrame single = f;
  for (glm::dvec3& p : single.vertices)
    for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(p[k]);
  Count count;
  count.add(f, single);
  UNSCOPED_INFO("polyhedra, frame 1, places in single precision: " << count.text());
  CHECK(count.other > 0);
  // The scene moved by 1e10 in doubles, as a frame of a program's own may be: some 2^-20 of its size are lost.
  SceneFrame far = f;
  const glm::dvec3 way{1e10, 0.5e10, -1e10};
  for (glm::dvec3& p : far.vertices) p += way;
  far.camera.eye += way;
  Count moved;
  moved.add(f, far);
  UNSCOPED_INFO("polyhedra, frame 1, 1e10 from the origin: " << moved.text());
  CHECK(moved.other > 10);
}

TEST_CASE("what doubles snap otherwise than exact arithmetic: built-in scenes") {
  for (const std::string& name : builtin_scenes()) check(name, 1);
}

TEST_CASE("what doubles snap otherwise than exact arithmetic: real meshes") {
  for (const char* file : {"horse.3ds", "cat.3ds", "asteroid-high.3ds", "bunny.obj"})
    check(std::string("/usr/share/glmark2/models/") + file, 4);
}

}  // namespace kage::verif
