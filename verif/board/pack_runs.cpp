// SPDX-License-Identifier: Apache-2.0
#include "board/pack_runs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "board/connection.hpp"
#include "board/generated/board_registers.h"
#include "board/sim_board.hpp"
#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"

namespace kage::board {
namespace {

/// A count stands before each frame, and a 0 behind the last.
std::uint64_t list_words(std::uint64_t words_of_frame) { return words_of_frame + 2; }

/// The player counts a frame's words in 24 bits, and a list's frames in 16.
constexpr std::uint64_t kMostWords = (1U << 24U) - 1;
constexpr std::uint64_t kMostFrames = (1U << 16U) - 1;

std::uint64_t kept_lines(const Identity& board) {
  return std::min(board.lines, std::uint32_t{KAGE_BOARD_SIGNATURES_WORDS});
}

/// Whether the frame may follow those of the list.
bool fits(const PackRun& run, const vectors::PackFrame& frame, const Identity& board) {
  if (run.direct || run.frames >= kMostFrames || run.words + frame.words + 1 > board.memory_words ||
      run.lines + frame.lines() > kept_lines(board))
    return false;
  return !board.has_screen() || frame.pixels() == 0 || run.height == 0 || run.height == frame.status.height;
}

void append(PackRun& run, const vectors::PackFrame& frame) {
  if (run.frames == 0) run.words = 1;
  ++run.frames;
  run.words += frame.words + 1;
  if (frame.pixels() == 0) return;
  run.lines += frame.lines();
  run.height = frame.status.height;
}

/// The named configuration with that hash, to say what a board was made for.
std::string config_with(std::uint32_t hash) {
  for (const NamedConfig& c : named_configs())
    if (param_hash(c.config) == hash) return c.name;
  return {};
}

}  // namespace

std::vector<PackRun> cut_into_runs(const vectors::Pack& pack, const Identity& board, const std::string& port) {
  std::vector<PackRun> runs;
  PackRun run;
  const auto cut = [&] {
    if (run.frames > 0) runs.push_back(run);
    run = {};
    run.first = runs.empty() ? 0 : runs.back().end();
  };
  for (std::uint64_t i = 0; i < pack.frames.size(); ++i) {
    const vectors::PackFrame& frame = pack.frames[i];
    if (frame.words == 0)
      throw Error(fmt::format("{}: frame {} ({}) has no words: a board cannot play it", port, i, frame.what));
    if (frame.words > kMostWords)
      throw Error(
          fmt::format("{}: frame {} ({}) has {} words, and a board's player takes {}: make the pack with a smaller "
                      "--size",
                      port, i, frame.what, frame.words, kMostWords));
    if (frame.pixels() > 0 && frame.lines() > kept_lines(board))
      throw Error(
          fmt::format("{}: frame {} ({}) has {} lines, and board {} keeps signatures of {}: make the pack with a "
                      "smaller --size",
                      port, i, frame.what, frame.lines(), board.name, kept_lines(board)));
    if (run.frames > 0 && !fits(run, frame, board)) cut();
    append(run, frame);
    run.direct = list_words(frame.words) > board.memory_words;
    if (frame.settles || run.direct) cut();
  }
  cut();
  return runs;
}

std::optional<PackRun> loop_of(const vectors::Pack& pack, const Identity& board) {
  PackRun run;
  for (const vectors::PackFrame& frame : pack.frames) {
    const bool shown = frame.pixels() > 0 || !board.has_screen();
    if (!shown || frame.words + 2 > board.memory_words || (run.frames > 0 && !fits(run, frame, board))) break;
    append(run, frame);
  }
  if (run.lines == 0 || run.lines > kept_lines(board)) return std::nullopt;
  return run;
}

std::optional<std::uint64_t> refused_for_size(const vectors::Pack& pack) {
  for (std::uint64_t i = 0; i < pack.frames.size(); ++i)
    if (pack.frames[i].status.error == ErrorCode::SIZE) return i;
  return std::nullopt;
}

std::string why_unfit(const vectors::Pack& pack, const Identity& board, const std::string& port,
                      const std::vector<std::uint32_t>& widest_refused) {
  const std::uint32_t hash = param_hash(pack.config);
  if (board.param_hash != hash) {
    if (port.starts_with(kSimulated))
      return fmt::format(
          "{}: board {} has a core of PARAM_HASH {:08x}, and the pack is for {:08x} ({}): make the pack for the core "
          "of "
          "the simulation: kage vectors ... --config FILE, where FILE has the line {}",
          port, board.name, board.param_hash, hash, pack.config_name, sim_core(port.substr(kSimulated.size())));
    const std::string other = config_with(board.param_hash);
    return fmt::format(
        "{}: board {} has a core of PARAM_HASH {:08x}{}, and the pack is for {:08x} ({}): load a bitstream of "
        "{}, or make the pack with {}",
        port, board.name, board.param_hash, other.empty() ? "" : " (" + other + ")", hash, pack.config_name,
        pack.config_name,
        other.empty() ? "the configuration that this one was made of" : "kage vectors ... --config " + other);
  }
  const auto beat_words = KAGE_FIELD(board.shape, KAGE_SHAPE_BEAT_WORDS);
  if (beat_words != static_cast<std::uint32_t>(pack.config.beat_words))
    return fmt::format(
        "{}: board {} has a core of BEAT_WORDS {}, and the pack's is {}: load a bitstream of {}, or make the "
        "pack with a configuration of BEAT_WORDS {}",
        port, board.name, beat_words, pack.config.beat_words, pack.config_name, beat_words);
  const auto max_width = KAGE_FIELD(board.shape, KAGE_SHAPE_MAX_WIDTH);
  for (std::size_t i = 0; i < pack.frames.size(); ++i)
    if (static_cast<std::uint32_t>(pack.frames[i].status.width) > max_width)
      return fmt::format(
          "{}: board {} has a core of MAX_WIDTH {}, and frame {} ({}) is {} wide: load a bitstream of {}, or "
          "make the pack with a smaller --size",
          port, board.name, max_width, i, pack.frames[i].what, pack.frames[i].status.width, pack.config_name);
  if (!widest_refused.empty() && max_width != static_cast<std::uint32_t>(pack.config.max_width)) {
    Config wider = pack.config;
    wider.max_width = static_cast<int>(max_width);
    const FrameStatus status = GoldenCore(wider).frame(widest_refused, [](int, std::span<const std::uint8_t>) {});
    if (status.error != ErrorCode::SIZE)
      return fmt::format(
          "{}: board {} has a core of MAX_WIDTH {}, which does not refuse the pack's frame that is too wide "
          "for {}: make the pack with MAX_WIDTH {}, or with --sound-only",
          port, board.name, max_width, pack.config.max_width, max_width);
  }
  return {};
}

}  // namespace kage::board
