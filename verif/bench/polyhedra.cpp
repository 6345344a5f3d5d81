// SPDX-License-Identifier: Apache-2.0
// Cost of scan conversion of polyhedra to segments, by the number of faces. It is held against the 1/20 s that a
// 10-face polyhedron took in [Ohno 1985], and against the clocks of a line.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/timer.hpp"
#include "frontend/sweep.hpp"
#include "frontend/tree_layout.hpp"
#include "kage/geometry.hpp"
#include "kage/stream.hpp"
#include "stimulus/shapes.hpp"

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

/// A ball of `rings` rings of `n` faces: trapezia, and triangles at the poles. Few of its faces lie on a line.
Solid ball(unsigned n, unsigned rings) {
  Solid s;
  s.vertices.emplace_back(0, 1, 0);
  for (unsigned r = 1; r < rings; ++r)
    for (unsigned i = 0; i < n; ++i) {
      const double a = 2 * M_PI * i / n;
      const double b = M_PI * r / rings;
      s.vertices.emplace_back(std::cos(a) * std::sin(b), std::cos(b), std::sin(a) * std::sin(b));
    }
  s.vertices.emplace_back(0, -1, 0);
  const auto last = static_cast<unsigned>(s.vertices.size() - 1);
  for (unsigned i = 0; i < n; ++i) {
    const unsigned j = (i + 1) % n;
    s.faces.push_back({0, 1 + j, 1 + i});
    for (unsigned r = 1; r + 1 < rings; ++r) {
      const unsigned at = 1 + (r - 1) * n;
      s.faces.push_back({at + i, at + j, at + n + j});
      s.faces.push_back({at + i, at + n + j, at + n + i});
    }
    s.faces.push_back({last, last - n + i, last - n + j});
  }
  return s;
}

}  // namespace

int main() {
  constexpr int kWidth = 640;
  constexpr int kHeight = 480;
  Config config;
  config.units = 1;
  config.seg_bits = 10;
  config.face_bits = 12;
  fmt::print(
      "one body on {}x{}, one thread, least of 20 runs. Layout: faces, edges and units, with a scan of its own. "
      "Segments "
      "in bands of {} lines.\nFeeder: clocks of a line's SEGs, TREE and EOL at BEAT_WORDS 4, against the {} that the "
      "line takes at least\n",
      kWidth, kHeight, kBandLines, kWidth);
  fmt::print("{:>7} {:>6} {:>8} {:>9} {:>14} {:>8} {:>12} {:>11} {:>11} {:>13} {:>13}\n", "body", "faces", "visible",
             "segments", "segments/line", "layout us", "segments us", "ns/segment", "words/line", "feeder clocks",
             "times 1/20 s");
  const auto measure = [&](const char* what, const Solid& solid, std::size_t faces) {
    SceneFrame f;
    add_solid(f, solid, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.6, 0.3});
    look_at(f.camera, {0.3, 1.2, 3.2}, {0, 0, 0});
    const FrameGeometry g = make_geometry(f, config, kWidth, kHeight);
    if (g.polyhedra.size() != 1 || f.polygons.size() != faces) {
      fmt::print("{} {}: not one polyhedron of so many faces but {}\n", what, faces, f.polygons.size());
      return false;
    }
    const double layout_seconds = bench::least_seconds(20, [&] { (void)TreeLayout(g, config); });
    const TreeLayout layout(g, config);
    std::vector<std::vector<std::uint32_t>> lines;
    std::size_t words = 0;
    const double seconds = bench::least_seconds(20, [&] {
      words = 0;
      Sweep edges(kHeight / kBandLines, kHeight, layout.edge_lines());
      for (int y = 0; y < kHeight; y += kBandLines) {
        layout.segments(y, y + kBandLines, edges.next(), lines);
        for (const auto& l : lines) words += l.size();
      }
    });
    const double segments = static_cast<double>(words) / Layout(config).words[static_cast<std::size_t>(Kind::SEG)];
    fmt::print("{:>7} {:>6} {:>8} {:>9.0f} {:>14.1f} {:>8.1f} {:>12.1f} {:>11.1f} {:>11.1f} {:>13.1f} {:>13.0f}\n",
               what, faces, g.polyhedra[0].polygon_count, segments, segments / kHeight, layout_seconds * 1e6,
               seconds * 1e6, seconds * 1e9 / segments, static_cast<double>(words) / kHeight, segments / kHeight + 2,
               0.05 / (layout_seconds + seconds));
    return true;
  };
  // Once something large has been freed, glibc no longer gives small things back to the system band by band.
  std::vector<char>(std::size_t{16} << 20).clear();
  bool good = true;
  for (const unsigned faces : {5U, 10U, 15U, 30U, 60U, 126U, 252U, 504U})
    good = measure("prism", prism(faces - 2), faces) && good;
  for (const unsigned n : {8U, 16U, 32U, 64U, 80U}) good = measure("ball", ball(n, n), std::size_t{n} * n) && good;
  return good ? 0 : 1;
}
