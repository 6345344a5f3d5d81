// SPDX-License-Identifier: Apache-2.0
// Cost of the exact order of translucent faces, and errors of the orders that others use: 640x480, the scene's own
// frames. A pixel is wrong if it differs from that of the exact order.
#include <fmt/format.h>

#include <filesystem>

#include "bench/timer.hpp"
#include "kage/core.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"

namespace {

using namespace kage;

struct Run {
  std::uint64_t faces = 0;
  std::uint64_t fragments = 0;
  std::uint64_t spans = 0;
  double geometry = 0;  // seconds, but for the first frame's tree
  double tree = 0;
  double front_end = 0;
  double core = 0;
  std::vector<std::vector<std::uint8_t>> pictures;
};

Run run(const Scene& scene, TranslucentWay way) {
  Config config;
  config.translucency = 1;
  Look look;
  look.translucent = way;
  TranslucentOrder order;
  Run r;
  const int frames = scene.frame_count();
  for (int i = 0; i < frames; ++i) {
    const SceneFrame f = scene.frame(i, frames);
    bench::Timer timer;
    FrameGeometry g = make_geometry(f, config, 640, 480, {.look = look, .order = &order});
    if (i == 0) {  // with the tree; once more without
      r.tree = timer.seconds();
      timer = {};
      g = make_geometry(f, config, 640, 480, {.look = look, .order = &order});
      r.tree -= timer.seconds();
    }
    r.geometry += timer.seconds();
    r.fragments += g.fragments.size();
    for (const Component& c : f.components) r.faces += c.translucent ? c.polygon_count : 0;
    std::vector<std::uint32_t> words;
    timer = {};
    make_frame(g, config, static_cast<std::uint32_t>(i), words, {.threads = 1});
    r.front_end += timer.seconds();
    r.spans += check_frame(config, words, "frame", 0).of_kind[static_cast<std::size_t>(Kind::TP)];
    GoldenCore core(config);
    timer = {};
    std::vector<std::uint8_t> picture;
    (void)core.frame(words,
                     [&](int, std::span<const std::uint8_t> p) { picture.insert(picture.end(), p.begin(), p.end()); });
    r.core += timer.seconds();
    r.pictures.push_back(std::move(picture));
  }
  return r;
}

void compare(const std::string& name, double alpha) {
  const Scene scene = Scene::load(name, {alpha});
  const int frames = scene.frame_count();
  const Run exact = run(scene, TranslucentWay::exact);
  fmt::print(
      "{}: {} frames, {} translucent faces, {} fragments a frame; milliseconds a frame: geometry and order {:.2f}, "
      "front end {:.2f}, golden core {:.2f}; tree, once, {:.1f}\n",
      std::filesystem::path(name).filename().string(), frames, exact.faces / static_cast<std::uint64_t>(frames),
      exact.fragments / static_cast<std::uint64_t>(frames), 1e3 * exact.geometry / frames,
      1e3 * exact.front_end / frames, 1e3 * exact.core / frames, 1e3 * exact.tree);
  for (const auto& [way, called] :
       {std::pair{TranslucentWay::centroid, "centroid"}, {TranslucentWay::submission, "submission"}}) {
    const Run other = run(scene, way);
    std::uint64_t wrong = 0;
    int most = 0;
    for (std::size_t k = 0; k < exact.pictures.size(); ++k)
      for (std::size_t i = 0; i < exact.pictures[k].size(); i += 3) {
        int off = 0;
        for (std::size_t c = 0; c < 3; ++c)
          off = std::max(off, std::abs(exact.pictures[k][i + c] - other.pictures[k][i + c]));
        wrong += off > 0 ? 1 : 0;
        most = std::max(most, off);
      }
    fmt::print("  by {:<10} {:>8} wrong pixels of {}, by up to {} LSB; {:.0f} % of the spans\n", called, wrong,
               307200 * static_cast<std::uint64_t>(frames), most,
               100.0 * static_cast<double>(other.spans) / static_cast<double>(exact.spans));
  }
}

}  // namespace

int main() {
  compare("glass", 1);
  for (const char* mesh : {"horse.3ds", "bunny.obj"})
    if (const std::string path = std::string("/usr/share/glmark2/models/") + mesh; std::filesystem::exists(path))
      compare(path, 0.5);
  return 0;
}
