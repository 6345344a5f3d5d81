// SPDX-License-Identifier: Apache-2.0
// Clocks of the front end in hardware beside the core behind it, by design (docs/rtl.md, "The front end"). For the
// first frame of all built-in scenes at 640x480, ACTIVE 512: clocks of front_end, of banked cores of 1, 4 and 8 lanes,
// and of the port at both levels. `front_end SCENE...` prints them for these scenes.
#include "polygon/front_end.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cost/line_clocks.hpp"
#include "kage/config.hpp"
#include "kage/frontend.hpp"
#include "kage/pipeline.hpp"

namespace {

using namespace kage;

// Clocks of a line in front_end, which the test rtl/front_end checks. kFirst: until the first polygon that crosses the
// line from the line above is there. The others: fewest clocks of a line that a polygon crosses, and of one that none
// crosses.
constexpr std::uint64_t kFirst = 3, kLeastCrossed = 6, kLeastLine = 3;

struct FrontEndClocks {
  std::uint64_t clocks = 0;
  std::uint64_t polygon_lines = 0;  // a polygon on a line
  std::uint64_t spans = 0;
};

/// Each token that comes takes a clock, each polygon of the line one, and each token that ends volumes one.
FrontEndClocks clocks_of(const Config& config, std::span<const std::uint32_t> words) {
  const Layout layout(config);
  FrontEnd front_end(config);
  front_end.start(FrameHeader::read(words).width);
  FrontEndClocks sums;
  std::uint64_t line = 0;
  TokenWalk walk(layout, words);
  for (auto token = walk.next(); !token.empty(); token = walk.next()) {
    const Token t = decode(config, layout, token, walk.level());
    line += 1;
    const auto crossing = front_end.crossing();
    if (t.kind == Kind::EOL) {
      line += crossing + (crossing > 0 ? kFirst : 0);
      sums.polygon_lines += crossing;
    }
    (void)front_end.accept(t, [&](const Token& of_spans, bool made) {
      const bool span = of_spans.kind == Kind::OP || of_spans.kind == Kind::SP || of_spans.kind == Kind::TP;
      sums.spans += span || of_spans.kind == Kind::NC ? 1 : 0;
      line += made && !span ? 1 : 0;
      return ErrorCode::NONE;
    });
    if (t.kind != Kind::EOL) continue;
    sums.clocks += std::max(line, crossing > 0 ? kLeastCrossed : kLeastLine);
    line = 0;
  }
  return sums;
}

void print(const std::string& name) {
  const auto scene = std::make_shared<const Scene>(Scene::load(name));
  DrawOptions draw{.width = 640, .height = 480, .threads = 1};
  const NamedConfig named = choose_config(*scene, draw);
  Config config = named.config;
  config.active = kUsualActive;
  const auto spans = SceneFrames(scene, config, draw).words(0).size();
  draw.level = Level::polygons;
  const auto words = SceneFrames(scene, config, draw).words(0);
  const FrontEndClocks front = clocks_of(config, words);
  const auto beat = static_cast<std::size_t>(config.beat_words);
  fmt::print("{:<13} {:<13} {:>8} {:>8} {:>9} {:>6.2f} {:>9} {:>9}", name, named.name, front.spans, front.polygon_lines,
             front.clocks, static_cast<double>(front.clocks) / static_cast<double>(front.spans), spans / beat,
             words.size() / beat);
  for (const int lanes : {1, 4, 8}) {
    Config core = config;
    core.lanes = lanes;
    LineClockCounter counter(core);
    counter.add(0, words);
    const auto clocks = counter.sums().clocks;
    fmt::print(" {:>9} {:>5.0f}", clocks, 100 * static_cast<double>(front.clocks) / static_cast<double>(clocks));
  }
  fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{:<13} {:<13} {:>8} {:>8} {:>9} {:>6} {:>9} {:>9} {:>9} {:>5} {:>9} {:>5} {:>9} {:>5}\n", "scene",
             "config", "spans", "polygons", "front end", "clocks", "port", "port", "1 lane", "", "4 lanes", "",
             "8 lanes", "");
  fmt::print("{:<13} {:<13} {:>8} {:>8} {:>9} {:>6} {:>9} {:>9} {:>9} {:>5} {:>9} {:>5} {:>9} {:>5}\n", "", "", "",
             "x lines", "clocks", "a span", "spans", "polygons", "clocks", "%", "clocks", "%", "clocks", "%");
  std::vector<std::string> scenes(argv + 1, argv + argc);
  if (scenes.empty()) scenes = kage::builtin_scenes();
  for (const std::string& scene : scenes) print(scene);
  return 0;
}
