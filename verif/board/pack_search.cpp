// SPDX-License-Identifier: Apache-2.0
//
// Search for the cause of a wrong line, and of a memory that gave other words than it got.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "board/generated/board_registers.h"
#include "board/pack_play.hpp"
#include "kage/error.hpp"

namespace kage::board {

/// The frames `first` to that of the line once more, on a core that was reset, and that line.
PackPlay::Replay PackPlay::replay(const PackRun& run, std::uint64_t first, Place line) {
  PackRun part = run;
  part.first = first;
  part.frames = line.frame + 1 - first;
  const std::uint64_t before = lines_before(part, line.frame);
  const std::uint64_t lines = before + pack_.frames[line.frame].lines();
  const auto number = static_cast<std::uint32_t>(before + static_cast<std::uint64_t>(line.line));
  now_at("played " + frames_text(part) + " again");
  if (!run.direct) {
    player_.control(0);
    const std::uint32_t end = 0;
    player_.load(address_of(run, line.frame + 1), std::span(&end, 1));
  }
  player_.set(KAGE_BOARD_CAPTURE_LINE, number);
  player_.restart(run.direct ? KAGE_BOARD_CONTROL_DIRECT_MASK : 0);
  player_.start(address_of(run, first));
  if (run.direct) player_.direct(list_of(run));
  Replay got;
  got.ended = wait_for(lines, lines, part.frames).ended;
  got.signature = player_.get(KAGE_BOARD_SIGNATURES + 4 * number);
  got.pixels = player_.captured(verdict_.board.pixels, got.came);
  return got;
}

/// The first pixel of the line that is not the pack's.
std::optional<cosim::Difference> PackPlay::pixel_difference(Place place, const Replay& got) const {
  static constexpr std::array kColors{"red", "green", "blue"};
  const auto width = static_cast<std::size_t>(pack_.frames[place.frame].status.width);
  const auto channels = static_cast<std::size_t>(pack_.config.channels);
  const std::vector<std::uint8_t> wanted = answers_.pixels(place.frame, place.line, 1);
  cosim::Difference d;
  d.frame = static_cast<int>(place.frame);
  d.line = place.line;
  for (std::size_t x = 0; x < std::min(width, got.pixels.size()); ++x) {
    const std::uint32_t pixel = got.pixels[x];
    d.x = static_cast<int>(x);
    for (std::size_t c = 0; c < channels; ++c) {
      d.expected = wanted[x * channels + c];
      d.actual = pixel >> (8 * c) & 0xFF;
      d.field = channels == 1 ? "grey" : kColors.at(c);
      if (d.expected != d.actual) return d;
    }
    d.field = "port";
    const bool user = (pixel & KAGE_BOARD_PIXELS_USER_MASK) != 0;
    const bool last = (pixel & KAGE_BOARD_PIXELS_LAST_MASK) != 0;
    d.expected = x == 0 && place.line == 0 ? 1 : 0;
    d.actual = user ? 1 : 0;
    d.remark = fmt::format("TUSER is {}, and must be {}", d.actual, d.expected);
    if (d.expected != d.actual) return d;
    d.expected = x + 1 == width ? 1 : 0;
    d.actual = last ? 1 : 0;
    d.remark = fmt::format("TLAST is {}, and must be {}", d.actual, d.expected);
    if (d.expected != d.actual) return d;
    d.remark.clear();
  }
  d.x = -1;
  if (got.came == width) return std::nullopt;
  d.field = got.came < width ? "missing" : "width";
  d.expected = static_cast<std::int64_t>(width);
  d.actual = got.came;
  return d;
}

void PackPlay::keep(Place place, const Replay& got) {
  CapturedLine line{place.frame, place.line, {}};
  for (const std::uint32_t pixel : got.pixels)
    for (int c = 0; c < pack_.config.channels; ++c) line.pixels.push_back(static_cast<std::uint8_t>(pixel >> (8 * c)));
  verdict_.captured.push_back(std::move(line));
}

/// The line's frame alone, then behind those of its list that come before it: which pixel it is, or that it does not
/// repeat. `wrong_lines` of the frame are fetched too, as far as there is room.
void PackPlay::look_into(const PackRun& run, Place place, std::uint32_t expected, std::optional<std::uint32_t> got,
                         const std::vector<int>& wrong_lines) {
  cosim::Difference d;
  d.frame = static_cast<int>(place.frame);
  d.line = place.line;
  // In a repetition, the board tells only that the line was wrong.
  const std::string repetition = got ? "" : "its signature was wrong in a repetition; ";
  d.field = got ? "signature" : "port";
  d.expected = got ? expected : 0;
  d.actual = got.value_or(0);
  d.remark = repetition;
  verdict_.first = d;
  std::uint64_t from = place.frame;
  Replay again = replay(run, from, place);
  if (again.ended && again.signature == expected && run.first < place.frame) {
    from = run.first;
    again = replay(run, from, place);
    if (again.signature != expected)
      verdict_.notes.push_back(fmt::format("frame {} alone comes out right: it is wrong behind frame {}{}", place.frame,
                                           place.frame - 1, place.frame - 1 == from ? "" : " and those before it"));
  }
  if (!again.ended) {
    verdict_.first->remark = repetition + "played again, the frame does not end";
    return;
  }
  if (again.signature == expected) {
    verdict_.first->remark =
        repetition +
        "played again, the line comes out right: the fault does not repeat, so look at timing, supply "
        "and temperature";
    return;
  }
  if (verdict_.board.pixels == 0) {
    verdict_.first->remark = repetition + "the board keeps no pixels, so it is the line's signature that tells";
    return;
  }
  const auto pixel = pixel_difference(place, again);
  if (pixel) {
    const bool other = got && again.signature != *got;
    verdict_.first = pixel;
    if (other)
      verdict_.first->remark +=
          fmt::format("{}the line comes out otherwise each time", verdict_.first->remark.empty() ? "" : "; ");
  } else {
    verdict_.first->remark =
        again.came > again.pixels.size()
            ? fmt::format("the first {} pixels, which is what the board can capture, are right", again.pixels.size())
            : "its pixels are right: line_signature or its memory is wrong";
  }
  keep(place, again);
  for (const int line : wrong_lines) {
    if (line == place.line) continue;
    if (verdict_.captured.size() >= options_.most_captured) break;
    const Replay more = replay(run, from, {place.frame, line});
    if (!more.ended) break;
    keep({place.frame, line}, more);
  }
  if (verdict_.captured.size() < wrong_lines.size())
    verdict_.notes.push_back(
        fmt::format("{} of {} wrong lines of frame {} were captured: in pictures of it the others are "
                    "as they must be",
                    verdict_.captured.size(), wrong_lines.size(), place.frame));
}

void PackPlay::blame_memory(const PackRun& run) {
  // Whether the first `frames` of the list leave the memory as they went in.
  const auto right = [&](std::uint64_t frames) {
    PackRun part = run;
    part.frames = frames;
    const std::uint32_t at = address_of(run, run.first + frames);
    const std::uint32_t end = 0;
    const std::uint32_t there =
        frames == run.frames ? 0 : static_cast<std::uint32_t>(pack_.frames[run.first + frames].words);
    player_.load(at, std::span(&end, 1));
    player_.restart();
    player_.start(0);
    const Waited waited = wait_for(0, lines_before(run, part.end()), frames);
    player_.restart();  // whoever hangs lets go of the memory
    player_.load(at, std::span(&there, 1));
    return waited.ended && waited.state.played == frames && waited.state.play_crc == words_crc(run, frames);
  };
  now_at("played " + frames_text(run) + " again");
  std::string where = "not in the same place each time";
  if (!right(run.frames)) {
    std::uint64_t good = 0;
    std::uint64_t bad = run.frames;
    while (bad - good > 1) {
      const std::uint64_t middle = good + (bad - good) / 2;
      (right(middle) ? good : bad) = middle;
    }
    const std::uint64_t frame = run.first + bad - 1;
    where = fmt::format("first in frame {} ({})", frame, pack_.frames[frame].what);
  }
  throw Error(
      fmt::format("{}: board {}: the memory gives other words than were loaded into it, {}: look at its clock, supply "
                  "and pins; the core is not to blame",
                  player_.port(), verdict_.board.name, where));
}

/// Throws where the player waits for words of the memory and the core for its input: the memory has stopped, and no
/// core hangs. If the core has no open frame, nothing tells whether it is offered a word, so either may be to blame.
/// `frame` is the one behind those that were given whole, and `crc_before` is PLAY_CRC behind these.
void PackPlay::blame_silent_memory(const PackRun& run, const PlayState& state, std::uint64_t frame,
                                   std::uint32_t crc_before) {
  if (!state.playing) return;
  const std::uint32_t status = player_.get(KAGE_REG_STATUS);
  const bool waits = status == 0 || (status & KAGE_STATUS_WAITING_INPUT_MASK) != 0;
  if (!waits) return;
  // Which word of that frame was the last.
  std::uint64_t given = 0;
  if (state.play_crc != crc_before) {
    const std::vector<std::uint32_t> words = frame < run.end() ? answers_.words(frame) : std::vector<std::uint32_t>{};
    std::uint32_t crc = crc_before;
    while (given < words.size() && crc != state.play_crc) crc = crc_of(std::span(words).subspan(given++, 1), crc);
    if (crc != state.play_crc) blame_memory(run);
  }
  const std::string where = given != 0           ? fmt::format("word {} of frame {}", given, frame)
                            : frame == run.first ? "the start of the list"
                                                 : fmt::format("frame {}", frame - 1);
  if (status == 0)
    throw Error(
        fmt::format("{}: board {}: no word comes to the core behind {}: the memory gives none, or the core takes none: "
                    "look at the memory's clock, supply and pins, and play the pack in simulation",
                    player_.port(), verdict_.board.name, where));
  throw Error(
      fmt::format("{}: board {}: the memory gives no more words behind {}, and the core waits for them: look at the "
                  "memory's clock, supply and pins; the core is not to blame",
                  player_.port(), verdict_.board.name, where));
}

}  // namespace kage::board
