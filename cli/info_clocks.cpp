// SPDX-License-Identifier: Apache-2.0
#include "info_clocks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cosim/phases.hpp"
#include "kage/error.hpp"
#include "kage/explain.hpp"
#include "signals.hpp"
#include "text.hpp"

namespace kage::cli {

StreamClocks clocks_of(const std::string& name, const StreamFile& file, const Config& config) {
  StreamClocks all;
  all.config = config;
  const Layout layout(config);
  cosim::PhaseCounter counter(config);
  std::uint64_t lines = 0;
  std::uint64_t sum = 0;
  for (int f = 0; f < file.frame_count(); ++f) {
    check_interrupt();
    if (file.is_port_frame(f)) continue;
    const auto words = file.frame(f);
    const FrameHeader header = FrameHeader::read(words);
    if (header.width > config.max_width)
      throw Error(fmt::format("{}: frame {} is {} pixels wide; the configuration's MAX_WIDTH is {}", name, f,
                              header.width, config.max_width));
    counter.start(header.width);
    TokenWalk walk(layout, words);
    for (auto token = walk.next(); !token.empty(); token = walk.next()) counter.token(decode(config, layout, token));
    ++all.frames;
    all.height = std::max(all.height, static_cast<int>(header.height));
    std::uint64_t frame = 0;
    for (std::size_t i = 0; i < counter.lines().size(); ++i) {
      const std::uint64_t clocks = counter.lines()[i];
      frame += clocks;
      if (clocks > all.worst.clocks) all.worst = {.frame = f, .line = static_cast<int>(i), .clocks = clocks};
    }
    const auto window = std::min<std::size_t>(StreamClocks::kWindow, counter.lines().size());
    all.worst_window = std::max(all.worst_window, static_cast<double>(cosim::worst_window(counter.lines(), window)) /
                                                      static_cast<double>(std::max<std::size_t>(1, window)));
    all.worst_frame = std::max(all.worst_frame, frame);
    lines += counter.lines().size();
    sum += frame;
  }
  if (lines > 0) all.mean = static_cast<double>(sum) / static_cast<double>(lines);
  return all;
}

std::string to_text(const StreamClocks& c) {
  if (c.frames == 0) return "clocks: no frame is sound, so none has clocks";
  return fmt::format(
      "clocks of a line (LANES {}, BEAT_WORDS {}): mean {:.0f}, worst {} (line {} of frame {}), worst {} neighbours "
      "{:.0f} "
      "each\nclocks of the worst frame: {}",
      c.config.lanes, c.config.beat_words, c.mean, c.worst.clocks, c.worst.line, c.worst.frame,
      std::min(StreamClocks::kWindow, c.height), c.worst_window, c.worst_frame);
}

Json to_json(const StreamClocks& c) {
  Json j;
  j["config"] = cli::to_json(c.config);
  j["frames"] = c.frames;
  j["height"] = c.height;
  j["mean_line"] = c.mean;
  j["worst_line"] = {{"clocks", c.worst.clocks}, {"frame", c.worst.frame}, {"line", c.worst.line}};
  j["worst_window"] = {{"lines", std::min(StreamClocks::kWindow, c.height)}, {"clocks_each", c.worst_window}};
  j["worst_frame"] = c.worst_frame;
  return j;
}

}  // namespace kage::cli
