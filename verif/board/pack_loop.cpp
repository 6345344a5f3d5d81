// SPDX-License-Identifier: Apache-2.0
//
// Frames played over and over, compared by the board itself.
#include <fmt/format.h>
#include <zlib.h>

#include "board/board_registers.h"
#include "board/pack_play.hpp"

namespace kage::board {
namespace {

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
  const auto plan = plan_loop(pack_, verdict_.board);
  if (!plan) {
    verdict_.notes.emplace_back(
        "nothing is played over and over: the board has no room for the first frame, or it brings no line");
    return;
  }
  const PackRun& run = *plan;
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
  std::uint32_t last = 0;
  std::optional<ScreenCounts> first_screen;
  bool hung = false;
  player_.start(0);
  while (true) {  // what would end another run ends the loop, and enough() knows
    const PlayState s = player_.state();
    const std::uint64_t now = clock_.now();
    if (s.lines != last) moved = now;
    v.lines += static_cast<std::uint32_t>(s.lines - last);  // the board counts modulo 2^32
    last = s.lines;
    v.repetitions = v.lines / run.lines;
    v.mismatches = player_.get(KAGE_BOARD_MISMATCHES);
    if (screen && !first_screen && v.repetitions > 0) first_screen = player_.screen();
    if (options_.progress)
      options_.progress(fmt::format("{}: {} times, {} wrong lines", doing_, v.repetitions, v.mismatches));
    hung = now - moved >= options_.timeout;
    const bool over = *options_.loop != 0 && now - begin >= *options_.loop;
    if (hung || over || v.mismatches != 0 || (options_.enough && options_.enough())) break;
  }
  v.seconds = static_cast<double>(clock_.now() - begin) / 1e6;
  if (first_screen) {
    const ScreenCounts now = player_.screen();
    v.screen = {now.shown - first_screen->shown, now.late - first_screen->late,
                now.underrun_frames - first_screen->underrun_frames, now.underrun_lines - first_screen->underrun_lines};
  }
  v.left = options_.leave && !hung && v.mismatches == 0;
  if (!v.left) end_loop(run, v, hung);
}

void PackPlay::end_loop(const PackRun& run, LoopVerdict& v, bool hung) {
  player_.stop();
  Waited stopped = wait_for(0, run.lines);
  // The core may still draw what it was given last. The board counts modulo 2^32.
  const std::uint64_t in_last = stopped.state.played % run.frames;
  const std::uint64_t due = stopped.state.played / run.frames * run.lines + lines_before(run, run.first + in_last);
  if (stopped.ended) stopped = wait_for(static_cast<std::uint32_t>(due), run.lines);
  if (hung || !stopped.ended) {
    PlayState in_list = stopped.state;
    in_list.lines = static_cast<std::uint32_t>(v.lines % run.lines);
    in_list.played = static_cast<std::uint32_t>(in_last);
    hangs(run, in_list, fmt::format("repetition {}: nothing more comes", v.repetitions + 1), false);
    return;
  }
  v.mismatches = player_.get(KAGE_BOARD_MISMATCHES);
  if (v.mismatches == 0) return;
  // What the core was given since the start: whole repetitions, and the frames behind them.
  const auto crc_of_frames = [&](std::uint64_t frames) {
    return Crc{words_crc(run, frames), 4 * (address_of(run, run.first + frames) - frames)};
  };
  const Crc given = crc_of_frames(run.frames).times(stopped.state.played / run.frames).then(crc_of_frames(in_last));
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
