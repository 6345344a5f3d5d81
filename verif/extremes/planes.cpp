// SPDX-License-Identifier: Apache-2.0
#include "extremes/planes.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include "extremes/plane_checks.hpp"
#include "geometry/plane.hpp"

namespace kage::verif {

// ---- plane

void PlaneCase::Corner::fields(Fields& f) {
  constexpr std::int64_t kLimit = std::int64_t{kGuard} * 256;
  f.number("x", x, -kLimit, kLimit);
  f.number("y", y, -kLimit, kLimit);
  f.number("z", z, 1 << 16, ((std::int64_t{1} << 28) - 2) << 16);
}

void PlaneCase::fields(Fields& f) {
  a.fields(f);
  b.fields(f);
  c.fields(f);
  f.number("pixel", x, 0, kMaxSize - 1);
  f.number("line", y, 0, kMaxSize - 1);
}

Outcome PlaneCase::check(const Context& context) const {
  using Number = boost::multiprecision::cpp_rational;
  const std::array<DepthVertex, 3> v{DepthVertex{{a.x, a.y}, a.z}, DepthVertex{{b.x, b.y}, b.z},
                                     DepthVertex{{c.x, c.y}, c.z}};
  auto plane = plane_through(v);
  Outcome o;
  if (!plane) return o;
  if (context.injected(Injection::tilted_plane)) plane->a += plane->a / 64;
  o.items = 1;
  // In subpixels from the first vertex, the exact plane has these slopes per subpixel, in 2^-16 LSB.
  const Number bx = b.x - a.x;
  const Number by = b.y - a.y;
  const Number cx = c.x - a.x;
  const Number cy = c.y - a.y;
  const Number area = bx * cy - cx * by;
  const Number slope_x = (Number(b.z - a.z) * cy - Number(c.z - a.z) * by) / area;
  const Number slope_y = (Number(c.z - a.z) * bx - Number(b.z - a.z) * cx) / area;
  const Number exact = Number(a.z) + slope_x * (256 * x + 128 - a.x) + slope_y * (256 * y + 128 - a.y);
  const Number got =
      (Number(plane->c) + Number(plane->a) * (x - plane->x0) + Number(plane->b) * (y - plane->y0)) / 256;  // in 2^-16
  const Number off = abs(got - exact) / 65536;
  // docs/numbers.md, "Depth": a unit for each column and line from the anchor, one from the vertex to the anchor's
  // centre, and one for C.
  const double pixels = std::abs(x - plane->x0) + std::abs(y - plane->y0) + 2;
  o.measure(off.convert_to<double>() * 0x1p25, pixels);
  return o;
}

// ---- plane unsnapped

void UnsnappedPlaneCase::Corner::fields(Fields& f) {
  f.real("x", x, -0.25, 1.25);
  f.real("y", y, -0.25, 1.25);
  f.real("w", w, 1, 100, 1);
}

void UnsnappedPlaneCase::fields(Fields& f) {
  f.flag("parallel", parallel);
  sub_bits_field(f, sub_bits);
  f.number("z_bits", z_bits, 8, 28, 24);
  f.number("width", width, 1, 2048, 64);
  f.number("steep", steep, 0, 40);
  a.fields(f);
  b.fields(f);
  c.fields(f);
}

SceneFrame UnsnappedPlaneCase::frame() const {
  SceneFrame f;
  f.camera.perspective = !parallel;
  f.camera.half_height = parallel ? 4 : 0.5;
  f.camera.near = 0.5;
  // Multiples of 2^-36 below 2^9, so that the fourth corner is exact, too.
  const auto place = [this, &f](const Corner& p) {
    const double size = 2 * f.camera.half_height * (parallel ? 1 : p.w);
    const auto whole = [](double v) { return std::round(v * 0x1p36) * 0x1p-36; };
    return glm::dvec3(whole((p.x - 0.5) * size), whole((0.5 - p.y) * size), -whole(p.w));
  };
  Corner third = c;
  third.x = (a.x + b.x) / 2 + std::ldexp(c.x - (a.x + b.x) / 2, -steep);
  third.y = (a.y + b.y) / 2 + std::ldexp(c.y - (a.y + b.y) / 2, -steep);
  const glm::dvec3 p = place(a);
  const glm::dvec3 q = place(b);
  const glm::dvec3 r = place(third);
  f.vertices = {p, q, r, p + (r - q)};
  f.shading.push_back({{0, 0, 1}, {1, 1, 1}});
  for (const std::uint32_t second : {1U, 2U}) {
    Triangle t{};  // all of one look
    t.vertex = {0, second, second + 1};
    f.triangles.push_back(t);
  }
  f.corners = {0, 1, 2, 3};
  f.polygons.push_back({0, 4, 0});
  Component part;
  part.count = 2;
  part.polygon_count = 1;
  f.components.push_back(part);
  return f;
}

Outcome UnsnappedPlaneCase::check(const Context& context) const {
  Config config;
  config.z_bits = z_bits;
  config.dsf_bits = 0;
  return unsnapped_planes_hold(frame(), config, width, width, look_of(sub_bits), context);
}

// ---- plane of a side

void SidePlaneCase::fields(Fields& f) {
  f.number("bits", bits, 1, 8, 1);
  f.number("width", width, 16, 2048, 64);
  scene.fields(f, 1, 3);
}

Outcome SidePlaneCase::check(const Context& context) const {
  Config config;
  config.dsf_bits = bits;
  return sides_hold(scene.frame(), config, width, width * 3 / 4, scene.look(), context);
}

void add_plane_families(Families& to) {
  add_family<PlaneCase>(to, {0, "plane", "a depth plane's coefficients rounded", "2^-25 LSB", 300, 0.5});
  add_family<UnsnappedPlaneCase>(
      to, {0, "plane unsnapped", "an unsnapped plane against its snapped corners' depths", "LSB", 300, 0.5});
  add_family<SidePlaneCase>(to,
                            {0, "plane side", "a volume's side against its snapped corners' depths", "LSB", 300, 0.5});
}

}  // namespace kage::verif
