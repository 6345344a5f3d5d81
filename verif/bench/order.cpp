// SPDX-License-Identifier: Apache-2.0
// Visibility order on real meshes of Debian packages (tools/deps test): builds, and every way against the two
// recursions.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "bench/timer.hpp"
#include "geometry/order_mesh.hpp"
#include "order/baseline.hpp"
#include "order/measure.hpp"

namespace {

using namespace kage;

/// How a build grows: the first faces of a mesh, which lie together.
void grow(const std::filesystem::path& path) {
  const Scene scene = Scene::load(path.string());
  const OrderMesh whole = order_mesh(scene.frame(0, 1));
  fmt::print("\n{:<22} {:>7} {:>8} {:>6} {:>7} {:>15}\n", "first faces of", "nodes", "per face", "depth", "build s",
             "us a face");
  for (std::size_t n = 5000;; n *= 2) {
    OrderMesh part = whole;
    part.polygons.resize(std::min(n, whole.polygons.size()));
    const bench::Timer timer;
    const OrderTree tree = OrderTree::build(part);
    const double seconds = timer.seconds();
    const auto faces = static_cast<double>(part.polygons.size());
    fmt::print("{:<22} {:>7} {:>8.2f} {:>6} {:>7.2f} {:>15.1f}\n", fmt::format("{} {}", path.stem().string(), faces),
               tree.stats().nodes, static_cast<double>(tree.stats().nodes) / faces, tree.stats().depth, seconds,
               1e6 * seconds / faces);
    if (n >= whole.polygons.size()) break;
  }
}

int run(const std::filesystem::path& cgal) {
  fmt::print("A: {}, {} bytes\nB: the best recursion in preorder, {} bytes a node\n", order::BaselineA::kNodeText,
             sizeof(order::BaselineA::Node), sizeof(order::BaselineB::Node));
  fmt::print("{:<22} {:>6} {:>7} {:>8} {:>6} {:>8} {:>8} {:>8} {:>7} {:>7}   bytes a node: A, fast\n", "mesh", "faces",
             "nodes", "per face", "frags", "per face", "splits", "depth", "build s", "exact");
  struct Row {
    std::string name;
    order::Measured measured;
  };
  std::vector<Row> rows;
  bool identical = true;
  for (const std::filesystem::path& path :
       {cgal / "rotor_small.off", cgal / "mech-holes-shark.off", cgal / "refined_elephant.off",
        std::filesystem::path("/usr/share/glmark2/models/bunny.obj"),
        std::filesystem::path("/usr/share/glmark2/models/horse.3ds")}) {
    const Scene scene = Scene::load(path.string());
    const OrderMesh mesh = order_mesh(scene.frame(0, 1));
    const bench::Timer timer;
    const OrderTree tree = OrderTree::build(mesh);
    const double seconds = timer.seconds();
    rows.push_back({path.filename().string(), order::measure(tree, {})});
    const order::Measured& m = rows.back().measured;
    const OrderBuildStats& s = tree.stats();
    const auto per = [](std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); };
    fmt::print("{:<22} {:>6} {:>7} {:>8.2f} {:>6} {:>8.2f} {:>8} {:>8} {:>7.2f} {:>7}   {:.1f} {:.1f}\n",
               rows.back().name, s.faces, s.nodes, per(s.nodes, s.faces), s.fragments, per(s.fragments, s.faces),
               s.splits, s.depth, seconds, s.exact_tests, per(m.baseline_a_bytes, s.nodes), per(m.fast_bytes, s.nodes));
  }
  grow(cgal / "refined_elephant.off");
  fmt::print(
      "\nmicroseconds a step, from the eye to the order; in brackets with a walk over it; processor time, least of 5 "
      "times 199 "
      "steps\n");
  fmt::print("{:<22} {:>7} {:>8} {:>19} {:>17} {:>17} {:>17} {:>15} {:>15}\n", "mesh", "degrees", "flips %", "A", "B",
             "paper's list", "fast", "A / fast", "B / fast");
  for (const Row& row : rows)
    for (const order::MeasureRow& r : row.measured.rows) {
      const auto both = [&](const order::WaySeconds& w) {
        return fmt::format("{:.1f} ({:.1f})", w.order / r.steps * 1e6, w.walk / r.steps * 1e6);
      };
      const auto times = [&](const order::WaySeconds& w) {
        return fmt::format("{:.1f} ({:.1f})", w.order / r.fast.order, w.walk / r.fast.walk);
      };
      fmt::print("{:<22} {:>7} {:>8.3f} {:>19} {:>17} {:>17} {:>17} {:>15} {:>15}{}\n", row.name,
                 r.degrees < 0 ? "random" : fmt::format("{:g}", r.degrees), 100 * r.flips_share, both(r.baseline_a),
                 both(r.baseline_b), both(r.list), both(r.fast), times(r.baseline_a), times(r.baseline_b),
                 r.identical ? "" : "  NOT IDENTICAL");
      identical = identical && r.identical;
    }
  return identical ? 0 : 1;
}

}  // namespace

int main() {
  const auto dir = std::filesystem::temp_directory_path() / ("kage-order-" + std::to_string(::getpid()));
  std::filesystem::create_directories(dir);
  const std::string unpack = "tar xzf /usr/share/doc/libcgal-demo/data.tar.gz -C " + dir.string() + " data/meshes";
  int result = 2;
  try {
    if (std::system(unpack.c_str()) == 0) result = run(dir / "data/meshes");
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
  }
  std::filesystem::remove_all(dir);
  return result;
}
