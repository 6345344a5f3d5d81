// SPDX-License-Identifier: Apache-2.0
//
// Frames played over and over, compared by the board itself.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "board/generated/board_registers.h"
#include "board/pack_play.hpp"

namespace kage::board {
namespace {

/// No board plays more frames than this within a time of kLook: a step that is larger goes back, modulo 2^16.
constexpr std::uint16_t kMostAtOnce = 0x7FFF;
constexpr std::uint64_t kLook = 20'000;

/// The CRC-32 of a run of bytes, and how long that is: two of them, one behind the other, are another.
struct Crc {
  std::uint32_t crc = 0;
  std::uint64_t bytes = 0;

  [[nodiscard]] Crc then(const Crc& next) const {
    return {static_cast<std::uint32_t>(crc32_combine(crc, next.crc, static_cast<z_off_t>(next.bytes))),
            bytes + next.bytes};
  }
  [[nodiscard]] Crc times(std::uint64_t n) const {
    Crc all;
    for (Crc power = *this; n != 0; n >>= 1U, power = power.then(power))
      if ((n & 1U) != 0) all = all.then(power);
    return all;
  }
};

}  // namespace

void PackPlay::loop() {
  const auto loop = loop_of(pack_, verdict_.board);
  if (!loop) {
    verdict_.notes.emplace_back(
        "nothing is played over and over: the board has no room for the first frame, or it brings no line");
    return;
  }
  const PackRun& run = *loop;
  const bool screen = verdict_.board.has_screen();
  LoopVerdict& v = verdict_.loop.emplace();
  v.frames = run.frames;
  now_at("took the words of " + frames_text(run));
  player_.restart();
  video_lines(run);
  player_.load(0, list_of(run));
  player_.expect(answers_.signatures(run.first, run.frames));
  player_.set(KAGE_BOARD_LOOP_LINES, static_cast<std::uint32_t>(run.lines));
  player_.control(KAGE_BOARD_CONTROL_CHECK_MASK | KAGE_BOARD_CONTROL_LOOP_MASK |
                  (screen ? KAGE_BOARD_CONTROL_PACED_MASK : 0));
  now_at("played " + frames_text(run) + " over and over");
  const std::uint64_t begin = clock_.now();
  std::uint64_t moved = begin;
  std::uint64_t looked = begin;
  std::uint64_t played = 0;
  std::uint32_t lines_at = 0;    // when a frame was played last
  std::uint32_t most_lines = 0;  // that came since
  PlayState last;
  std::optional<ScreenCounts> first_screen;
  bool hung = false;
  player_.start(0);
  while (true) {  // what would end another run ends the loop, and enough() knows
    const PlayState s = player_.state();
    const std::uint64_t now = clock_.now();
    // The board counts modulo 2^16. Frames are fewer than lines, so it is they that are counted on.
    const auto more = static_cast<std::uint16_t>(s.played - last.played);
    if (more > kMostAtOnce && now - looked < kLook) goes_back("PLAYED", last.played, s.played);
    looked = now;
    played += more;
    const auto lines = static_cast<std::uint16_t>(s.lines - lines_at);
    if (more != 0) {
      lines_at = s.lines;
      most_lines = 0;
      moved = now;
    } else if (lines > most_lines && lines <= run.lines) {
      most_lines = lines;
      moved = now;
    }
    last = s;
    v.repetitions = played / run.frames;
    v.mismatches = player_.get(KAGE_BOARD_MISMATCHES);
    if (screen && !first_screen && v.repetitions > 0) first_screen = player_.counts().screen;
    if (options_.progress)
      options_.progress(fmt::format("{}: {} times, {} wrong lines", doing_, v.repetitions, v.mismatches));
    hung = now - moved >= options_.timeout;
    const bool over = *options_.loop != 0 && now - begin >= *options_.loop;
    if (hung || over || v.mismatches != 0 || (options_.enough && options_.enough())) break;
  }
  v.lines = lines_of(run, played);
  v.seconds = static_cast<double>(clock_.now() - begin) / 1e6;
  if (first_screen) {
    (void)player_.state();
    v.screen = player_.counts().screen - *first_screen;
  }
  v.left = options_.leave && !hung && v.mismatches == 0;
  if (!v.left) end_loop(run, v, hung, played, last);
}

/// Lines of the first `frames` frames of a list that begins anew at its end.
std::uint64_t PackPlay::lines_of(const PackRun& run, std::uint64_t frames) const {
  return frames / run.frames * run.lines + lines_before(run, run.first + frames % run.frames);
}

void PackPlay::end_loop(const PackRun& run, LoopVerdict& v, bool hung, std::uint64_t played, const PlayState& last) {
  player_.stop();
  const Waited stopped = wait_for(0, run.lines, run.frames, player_.state());
  played += static_cast<std::uint16_t>(stopped.state.played - last.played);
  v.repetitions = played / run.frames;
  v.lines = lines_of(run, played);
  // The core may still draw what it was given last.
  const std::uint64_t begin = clock_.now();
  std::uint32_t lines = stopped.state.lines;
  bool ended = stopped.ended && !hung;
  while (ended && static_cast<std::uint16_t>(lines - v.lines) != 0) {
    wait();
    lines = player_.state().lines;
    ended = clock_.now() - begin < options_.timeout;
  }
  // CRC of the words that the core was given since the start: whole repetitions, and the frames behind them.
  const auto crc_of_frames = [&](std::uint64_t frames) {
    return Crc{words_crc(run, frames), 4 * (address_of(run, run.first + frames) - frames)};
  };
  const Crc given = crc_of_frames(run.frames).times(v.repetitions).then(crc_of_frames(played % run.frames));
  if (!ended) {
    blame_silent_memory(run, stopped.state, run.first + played % run.frames, given.crc);
    PlayState in_list = stopped.state;
    in_list.played = static_cast<std::uint32_t>(played % run.frames);
    // Counts within the current repetition, as far as the counters' 16 bits tell.
    const std::uint64_t whole = v.repetitions * run.lines;
    in_list.lines =
        std::min<std::uint32_t>(static_cast<std::uint16_t>(lines - whole), static_cast<std::uint32_t>(run.lines));
    hangs(run, in_list, fmt::format("repetition {}: nothing more comes", v.repetitions + 1), false);
    return;
  }
  v.mismatches = player_.get(KAGE_BOARD_MISMATCHES);
  if (v.mismatches == 0) return;
  const bool memory = given.crc != stopped.state.play_crc;
  const std::uint32_t at = player_.get(KAGE_BOARD_MISMATCH_LINE);
  const Place place = place_of(run, at);
  const std::vector<std::uint32_t> wanted = answers_.signatures(run.first, run.frames);
  verdict_.wrong_lines += v.mismatches;
  look_into(run, place, wanted.at(at), std::nullopt, {place.line});
  verdict_.frames = place.frame + 1;
  if (memory)
    verdict_.notes.emplace_back("the memory gave other words than were loaded into it: the core may not be to blame");
}

}  // namespace kage::board
