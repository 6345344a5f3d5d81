// SPDX-License-Identifier: Apache-2.0
// What rounding in doubles does left of the snap: transform, clipping and projection of every corner of every drawn
// face once more in floating point of 333 bits, which shares no arithmetic with the golden model.
//
// `scene_precision -s` prints how many corners snap otherwise, a line for each scene.
#include <fmt/format.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "geometry/seen.hpp"
#include "kage/geometry.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

constexpr int kWidth = 640;
constexpr int kHeight = 480;

// Positions are quotients of numbers with some 110 bits, those of corners that clipping makes with up to some 330. One
// so close to half a subpixel is there exactly, and is rounded up.
const Real kExact("1e-85");

/// A point from the eye: right, up and forward.
struct Point {
  Real x, y, w;
};

struct Mesh {
  explicit Mesh(const SceneFrame& f) {
    const Camera& c = f.camera;
    points.reserve(f.vertices.size());
    for (const glm::dvec3& v : f.vertices) {
      const Real x = Real(v.x) - Real(c.eye.x);
      const Real y = Real(v.y) - Real(c.eye.y);
      const Real z = Real(v.z) - Real(c.eye.z);
      const auto along = [&](const glm::dvec3& a) { return x * Real(a.x) + y * Real(a.y) + z * Real(a.z); };
      points.push_back({along(c.right), along(c.up), along(c.forward)});
    }
  }

  std::vector<Point> points;
};

/// Of a polygon what has inside(p) >= 0.
template <class Inside>
void cut(std::vector<Point>& polygon, Inside inside) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const Real da = inside(a);
    const Real db = inside(b);
    if (da >= 0) kept.push_back(a);
    if ((da >= 0) == (db >= 0)) continue;
    const Real t = da / (da - db);
    kept.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.w + t * (b.w - a.w)});
  }
  polygon = std::move(kept);
}

class Screen {
 public:
  explicit Screen(const Camera& c) : perspective_(c.perspective), half_height_(c.half_height) {}

  [[nodiscard]] Real scale(const Point& p) const { return perspective_ ? p.w : Real(1); }

  /// The place on the screen, in pixels, times scale().
  [[nodiscard]] Real x(const Point& p) const { return p.x * (kHeight / 2) / half_height_ + scale(p) * (kWidth / 2); }
  [[nodiscard]] Real y(const Point& p) const { return scale(p) * (kHeight / 2) - p.y * (kHeight / 2) / half_height_; }

  [[nodiscard]] ScreenVertex snap(const Point& p) const {
    const auto rounded = [](const Real& v) {
      const Real half_up = v * 256 + Real(0.5);
      return static_cast<std::int32_t>(Real(floor(half_up + kExact)).convert_to<double>());
    };
    return {rounded(x(p) / scale(p)), rounded(y(p) / scale(p))};
  }

  /// What of a polygon lies within `limit` pixels of the screen's upper left corner and from `near` on.
  void clip(std::vector<Point>& polygon, double near) const {
    const Real limit = kGuard;
    cut(polygon, [&](const Point& p) { return p.w - Real(near); });
    cut(polygon, [&](const Point& p) { return y(p) + limit * scale(p); });
    cut(polygon, [&](const Point& p) { return limit * scale(p) - y(p); });
    cut(polygon, [&](const Point& p) { return x(p) + limit * scale(p); });
    cut(polygon, [&](const Point& p) { return limit * scale(p) - x(p); });
  }

  /// What of it lies in the picture.
  void to_picture(std::vector<Point>& polygon, double near) const {
    cut(polygon, [&](const Point& p) { return p.w - Real(near); });
    cut(polygon, [&](const Point& p) { return y(p); });
    cut(polygon, [&](const Point& p) { return kHeight * scale(p) - y(p); });
    cut(polygon, [&](const Point& p) { return x(p); });
    cut(polygon, [&](const Point& p) { return kWidth * scale(p) - x(p); });
  }

 private:
  bool perspective_;
  Real half_height_;
};

std::vector<Point> outline(const SceneFrame& f, const Mesh& mesh, std::uint32_t polygon) {
  std::vector<Point> all;
  for (const std::uint32_t v : f.outline(f.polygons[polygon])) all.push_back(mesh.points[v]);
  return all;
}

/// Where depth begins, by docs/numbers.md.
double begin(const SceneFrame& f, const Mesh& mesh, const Screen& screen) {
  Real nearest = -1;
  Real far = 0;
  for (const Point& p : mesh.points) far = std::max(far, p.w);
  far *= 1 + Real(1e-6);
  for (std::uint32_t i = 0; i < f.polygons.size(); ++i) {
    std::vector<Point> p = outline(f, mesh, i);
    screen.to_picture(p, f.camera.near);
    for (const Point& c : p)
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
    const Mesh mesh(f);
    const Screen screen(f.camera);
    Config config;
    config.max_width = 2047;
    const double near = begin(f, mesh, screen);
    CHECK(near == depth_range(given, config, kWidth, kHeight, {}, eye_points(given)).near);
    const FrameGeometry g = make_geometry(given, config, kWidth, kHeight);
    for (const ScreenPolygon& p : g.polygons) {
      if (p.source == ~0U) continue;
      std::vector<Point> truth = outline(f, mesh, p.source);
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
