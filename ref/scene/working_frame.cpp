// SPDX-License-Identifier: Apache-2.0
#include "working_frame.hpp"

#include <array>
#include <cmath>
#include <cstdlib>

namespace kage::scene {
namespace {

constexpr double kFar = 0x1p12;  // of the scene's size: 12 bits of 53 are spent on where it is, and no more
constexpr int kLong = 64;  // of the exponent of a scene that stays as it is, whose products are far from all limits

// The unevaluated sum high + low of two doubles, |low| at most half a unit in the last place of high: 106 bits.
struct Pair {
  double high = 0;
  double low = 0;
};

// Exact [Knuth, The Art of Computer Programming, 4.2.2].
Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

// Exact [Dekker, A floating-point technique for extending the available precision, 1971].
Pair two_product(double a, double b) {
  const auto split = [](double v) {
    const double c = 0x1.0000002p27 * v;
    const double high = c - (c - v);
    return Pair{high, v - high};
  };
  const Pair x = split(a);
  const Pair y = split(b);
  const double product = a * b;
  return {product, ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

Pair operator+(const Pair& a, const Pair& b) {
  const Pair s = two_sum(a.high, b.high);
  const double low = s.low + (a.low + b.low);
  return two_sum(s.high, low);
}

/// A node's map with its place in pairs.
struct Placed {
  Affine map;  // without its origin
  std::array<Pair, 3> origin{};
};

Placed operator*(const Placed& outer, const Affine& inner) {
  Placed p;
  p.map = {outer.map.vector(inner.x), outer.map.vector(inner.y), outer.map.vector(inner.z), {0, 0, 0}};
  for (int i = 0; i < 3; ++i)
    p.origin[static_cast<std::size_t>(i)] =
        outer.origin[static_cast<std::size_t>(i)] + two_product(outer.map.x[i], inner.origin.x) +
        two_product(outer.map.y[i], inner.origin.y) + two_product(outer.map.z[i], inner.origin.z);
  return p;
}

glm::dvec3 scaled(const glm::dvec3& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

}  // namespace

double WorkingFrame::length(double of_file) const { return std::ldexp(of_file, -exponent); }

glm::dvec3 working_origin(const SpaceBox& box) {
  const glm::dvec3 middle = box.low + (box.high - box.low) * 0.5;
  return largest(middle) > kFar * largest(box.high - box.low) ? middle : glm::dvec3{0, 0, 0};
}

int working_exponent(const SpaceBox& box) {
  const double size = largest(box.high - box.low);
  if (!(size > 0) || !std::isfinite(size)) return 0;
  const int exponent = std::ilogb(size);
  return std::abs(exponent) > kLong ? exponent : 0;
}

std::vector<Affine> placed(const RawScene& scene, const std::vector<Affine>& own, const WorkingFrame& frame) {
  std::vector<Affine> world;
  world.reserve(own.size());
  std::vector<Placed> exact;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const std::int32_t parent = scene.nodes[i].parent;
    if (!frame.is_moved()) {
      world.push_back(parent < 0 ? own[i] : world[static_cast<std::size_t>(parent)] * own[i]);
      continue;
    }
    exact.push_back((parent < 0 ? Placed{} : exact[static_cast<std::size_t>(parent)]) * own[i]);
    world.push_back(exact.back().map);
    for (int k = 0; k < 3; ++k) {
      const Pair here = exact.back().origin[static_cast<std::size_t>(k)] + Pair{-frame.origin[k], 0};
      world.back().origin[k] = here.high + here.low;
    }
  }
  if (frame.exponent != 0)
    for (Affine& a : world)
      for (glm::dvec3* v : {&a.x, &a.y, &a.z, &a.origin}) *v = scaled(*v, -frame.exponent);
  return world;
}

}  // namespace kage::scene
