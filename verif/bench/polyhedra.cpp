// SPDX-License-Identifier: Apache-2.0
// What scan conversion of polyhedra to segments costs, by faces; against the 1/20 s that a 10-face polyhedron took in
// [Ohno 1985], and against the clocks that a line has.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "frontend/tree_plan.hpp"
#include "kage/geometry.hpp"
#include "kage/stream.hpp"
#include "support/shapes.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

/// A prism with `n` sides: n + 2 faces once its triangles are put together.
Solid prism(unsigned n) {
  Solid s;
  for (unsigned i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n;
    s.vertices.emplace_back(std::cos(a), -1, std::sin(a));
    s.vertices.emplace_back(std::cos(a), 1, std::sin(a));
  }
  for (unsigned i = 0; i < n; ++i) {
    const unsigned j = (i + 1) % n;
    s.faces.push_back({2 * i, 2 * i + 1, 2 * j + 1});
    s.faces.push_back({2 * i, 2 * j + 1, 2 * j});
    if (i >= 2) {
      s.faces.push_back({1, 2 * i + 1, 2 * i - 1});
      s.faces.push_back({0, 2 * i - 2, 2 * i});
    }
  }
  return s;
}

template <class Work>
double least_seconds(Work work) {
  double best = 1e300;
  for (int i = 0; i < 20; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

}  // namespace

int main() {
  constexpr int kWidth = 640;
  constexpr int kHeight = 480;
  Config config;
  config.units = 1;
  config.seg_bits = 10;
  config.face_bits = 10;
  fmt::print("one prism on {}x{}, one thread, least of 20 runs; plan: faces, edges and units, with a scan of its own\n",
             kWidth, kHeight);
  fmt::print("{:>6} {:>8} {:>9} {:>14} {:>9} {:>11} {:>11} {:>15} {:>12}\n", "faces", "visible", "segments",
             "segments/line", "plan us", "segments us", "ns/segment", "words/line", "times 1/20 s");
  for (const unsigned faces : {5U, 10U, 15U, 30U, 60U, 126U, 252U, 504U}) {
    SceneFrame f;
    add_solid(f, prism(faces - 2), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.6, 0.3});
    look_at(f.camera, {0.3, 1.2, 3.2}, {0, 0, 0});
    const FrameGeometry g = make_geometry(f, config, kWidth, kHeight);
    if (g.polyhedra.size() != 1 || f.polygons.size() != faces) {
      fmt::print("{} faces: not one polyhedron of so many\n", faces);
      return 1;
    }
    const double plan_seconds = least_seconds([&] { (void)TreePlan(g, config); });
    const TreePlan plan(g, config);
    std::vector<std::vector<std::uint32_t>> lines;
    const double seconds = least_seconds([&] { plan.segments(0, kHeight, lines); });
    std::size_t words = 0;
    for (const auto& l : lines) words += l.size();
    const double segments = static_cast<double>(words) / Layout(config).words[static_cast<std::size_t>(Kind::SEG)];
    fmt::print("{:>6} {:>8} {:>9.0f} {:>14.1f} {:>9.1f} {:>11.1f} {:>11.1f} {:>15.1f} {:>12.0f}\n", faces,
               g.polyhedra[0].polygon_count, segments, segments / kHeight, plan_seconds * 1e6, seconds * 1e6,
               seconds * 1e9 / segments, static_cast<double>(words) / kHeight, 0.05 / (plan_seconds + seconds));
  }
  return 0;
}
