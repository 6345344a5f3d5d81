// SPDX-License-Identifier: Apache-2.0
// Where the clocks of a frame go: each token's clocks by design (docs/rtl.md), summed by phase, beside the clocks that
// the RTL takes for the whole frame. 640x480, the first frame of each scene.
#include "cosim/phases.hpp"

#include <fmt/format.h>

#include "cosim/core.hpp"
#include "cosim/model/model.hpp"
#include "cosim/model/rtl.hpp"
#include "kage/config.hpp"
#include "kage/pipeline.hpp"

namespace {

using namespace kage;

PhaseSums sums_of(const Config& c, std::span<const std::uint32_t> words) {
  const Layout layout(c);
  PhaseCounter counter(c);
  counter.start(FrameHeader::read(words).width);
  TokenWalk walk(layout, words);
  for (auto token = walk.next(); !token.empty(); token = walk.next()) counter.token(decode(c, layout, token));
  return counter.sums();
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{:<13} {:<12} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10} {:>11} {:>9}\n", "scene", "config",
             "state", "opaque", "volumes", "EV", "ES", "TP", "line out", "video", "sum", "RTL clocks", "SP+NC/px");
  std::vector<std::string> scenes(argv + 1, argv + argc);
  if (scenes.empty()) scenes = builtin_scenes();
  for (const std::string& name : scenes) {
    const auto scene = std::make_shared<const Scene>(Scene::load(name));
    const DrawOptions draw{.width = 640, .height = 480, .threads = 1};
    const NamedConfig config = choose_config(*scene, draw);
    const Config& c = config.config;
    const auto words = SceneFrames(scene, c, draw).words(0);
    const PhaseSums s = sums_of(c, words);
    const auto clocks = [&](Phase phase) { return s.of[static_cast<std::size_t>(phase)].clocks; };
    const auto rtl = cosim::make_rtl(cosim::find_model(c).library, c);
    const std::uint64_t cycles = rtl->frame(words, [](int, std::span<const std::uint8_t>) {}).cycles;
    fmt::print("{:<13} {:<12} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10} {:>11} {:>9.2f}\n", name,
               config.name, clocks(Phase::state), clocks(Phase::opaque), clocks(Phase::volumes),
               clocks(Phase::volume_ends), clocks(Phase::samples), clocks(Phase::translucent), clocks(Phase::line_out),
               s.video, s.clocks(), cycles,
               static_cast<double>(s.of[static_cast<std::size_t>(Phase::volumes)].pixels) / (640.0 * 480));
  }
  return 0;
}
