// SPDX-License-Identifier: Apache-2.0
// The table of docs/order.md on triangles that all go through one another: how the fragments that they are cut into,
// the time and the memory of the build grow with their number.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdio>

#include "kage/order.hpp"
#include "stimulus/order_meshes.hpp"

namespace {

using namespace kage;

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// The most that the process had so far.
double megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Share of the pairs of triangles that meet.
double crossing_share(const OrderMesh& mesh) {
  // Two triangles meet if an edge of one goes through the other.
  const auto corner = [&](std::size_t t, std::size_t i) { return mesh.vertices[mesh.corners[3 * t + i % 3]]; };
  const auto side = [](const OrderPoint& a, const OrderPoint& b, const OrderPoint& c, const OrderPoint& p) {
    OrderPoint d{}, e{}, f{};
    for (std::size_t i = 0; i < 3; ++i) d[i] = b[i] - a[i], e[i] = c[i] - a[i], f[i] = p[i] - a[i];
    return (d[1] * e[2] - d[2] * e[1]) * f[0] + (d[2] * e[0] - d[0] * e[2]) * f[1] + (d[0] * e[1] - d[1] * e[0]) * f[2];
  };
  const auto pierces = [&](std::size_t s, std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const OrderPoint p = corner(s, k);
      const OrderPoint q = corner(s, k + 1);
      if ((side(corner(t, 0), corner(t, 1), corner(t, 2), p) > 0) ==
          (side(corner(t, 0), corner(t, 1), corner(t, 2), q) > 0))
        continue;
      int turns = 0;
      for (std::size_t i = 0; i < 3; ++i) turns += side(p, q, corner(t, i), corner(t, i + 1)) > 0 ? 1 : 0;
      if (turns % 3 == 0) return true;
    }
    return false;
  };
  const std::size_t n = mesh.polygons.size();
  std::size_t pairs = 0;
  for (std::size_t s = 0; s < n; ++s)
    for (std::size_t t = 0; t < s; ++t) pairs += pierces(s, t) || pierces(t, s) ? 1 : 0;
  return static_cast<double>(pairs) / (static_cast<double>(n) * static_cast<double>(n - 1) / 2);
}

}  // namespace

int main() {
  fmt::print("{:>9} {:>15} {:>9} {:>8} {:>17} {:>9} {:>8}\n", "triangles", "pairs that meet", "fragments", "a face",
             "of the bound, %", "build, s", "MB");
  for (const int n : {25, 50, 75, 100, 150, 200, 250}) {
    verif::Random random(1);
    const OrderMesh mesh = verif::mutually_crossing(random, n);
    const double share = crossing_share(mesh);
    const double start = processor_seconds();
    const OrderTree tree = OrderTree::build(mesh);
    const double seconds = processor_seconds() - start;
    const auto fragments = static_cast<double>(tree.stats().fragments);
    const double bound = n * (double(n) * n - n + 2) / 2;
    fmt::print("{:>9} {:>13.0f} % {:>9} {:>8.0f} {:>17.1f} {:>9.2f} {:>8.0f}\n", n, 100 * share, tree.stats().fragments,
               fragments / n, 100 * fragments / bound, seconds, megabytes());
    (void)std::fflush(stdout);
  }
  return 0;
}
