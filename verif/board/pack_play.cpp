// SPDX-License-Identifier: Apache-2.0
#include "board/pack_play.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "board/generated/board_registers.h"
#include "kage/error.hpp"

namespace kage::board {
namespace {

/// A screen takes 17 ms, and counts a frame at its end: two of them, and some more.
constexpr std::uint64_t kScreensEnd = 50'000;

/// So many times the patience, in all, it is enough that words come.
constexpr std::uint64_t kWordsAlone = 4;

/// A counter modulo 2^16, since `from`.
struct Growth {
  std::uint32_t from;
  std::uint64_t most;      ///< that it may grow by
  std::uint64_t at = 0;    ///< as it was last
  std::uint64_t seen = 0;  ///< the most of what it may

  [[nodiscard]] std::uint64_t since(std::uint32_t count) const { return static_cast<std::uint16_t>(count - from); }
  /// Behind `most` it may have begun anew.
  [[nodiscard]] bool goes_back(std::uint32_t count) const { return at <= most && since(count) < at; }
  bool grows(std::uint32_t count) {
    at = since(count);
    if (std::min(at, most) <= seen) return false;
    seen = std::min(at, most);
    return true;
  }
};

std::string status_text(std::uint32_t status) {
  std::string text;
  const auto add = [&](std::uint32_t mask, const char* what) {
    if ((status & mask) != 0) text += fmt::format("{}{}", text.empty() ? "" : ", ", what);
  };
  add(KAGE_STATUS_OPEN_MASK, "a frame is open");
  add(KAGE_STATUS_DRAINING_MASK, "input is drained");
  add(KAGE_STATUS_WAITING_INPUT_MASK, "waiting for input");
  add(KAGE_STATUS_WAITING_OUTPUT_MASK, "waiting for output");
  return fmt::format("STATUS {:#x} ({})", status, text.empty() ? "idle" : text);
}

}  // namespace

PackPlay::PackPlay(Link& link, Transport& clock, const std::string& port, const std::filesystem::path& folder,
                   const vectors::Pack& pack, const PackRunOptions& options)
    : clock_(clock), pack_(pack), options_(options), player_(link, port, options.wait), answers_(folder, pack) {}

void PackPlay::now_at(const std::string& doing) {
  doing_ = doing;
  if (options_.progress) options_.progress(doing);
}

std::string PackPlay::frames_text(const PackRun& run) const {
  return run.frames == 1 ? fmt::format("frame {}", run.first)
                         : fmt::format("frames {} to {}", run.first, run.end() - 1);
}

void PackPlay::run() {
  get_ready();
  const std::vector<PackRun> runs = cut_into_runs(pack_, verdict_.board, player_.port());
  // The pack's register values are those of a core that got nothing but these frames since its reset.
  player_.restart();
  for (const PackRun& run : runs) {
    play(run);
    if (verdict_.first) break;
  }
  verdict_.host = player_.link().statistics();
  if (lost_) return;
  count_screen();
  if (!verdict_.first && options_.loop) loop();
  verdict_.host = player_.link().statistics();
  (void)player_.state();
  verdict_.link_good = player_.counts().link_good;
  verdict_.link_bad = player_.counts().link_bad;
  verdict_.link_overruns = player_.counts().link_overruns;
}

void PackPlay::get_ready() {
  verdict_.board = player_.identify();
  std::vector<std::uint32_t> refused;
  if (const auto frame = refused_for_size(pack_)) refused = answers_.words(*frame);
  const std::string unfit = why_unfit(pack_, verdict_.board, player_.port(), refused);
  if (!unfit.empty()) throw Error(unfit);
  const std::uint64_t begin = clock_.now();
  while (!player_.state().memory_ready) {
    wait();
    if (clock_.now() - begin > options_.timeout)
      throw Error(
          fmt::format("{}: board {}: its memory does not get ready in {} s: its clock is missing, or the bitstream is "
                      "of another board",
                      player_.port(), verdict_.board.name, static_cast<double>(options_.timeout) / 1e6));
  }
  before_ = player_.counts().screen;
}

std::vector<std::uint32_t> PackPlay::list_of(const PackRun& run) const {
  std::vector<std::uint32_t> list;
  list.reserve(run.words);
  for (std::uint64_t i = run.first; i < run.end(); ++i) {
    const std::vector<std::uint32_t> words = answers_.words(i);
    list.push_back(static_cast<std::uint32_t>(words.size()));
    list.insert(list.end(), words.begin(), words.end());
  }
  list.push_back(0);
  return list;
}

std::uint32_t PackPlay::words_crc(const PackRun& run, std::uint64_t frames) const {
  std::uint32_t crc = 0;
  for (std::uint64_t i = run.first; i < run.first + frames; ++i) crc = crc_of(answers_.words(i), crc);
  return crc;
}

std::uint32_t PackPlay::address_of(const PackRun& run, std::uint64_t frame) const {
  std::uint64_t address = 0;
  for (std::uint64_t i = run.first; i < frame; ++i) address += pack_.frames[i].words + 1;
  return static_cast<std::uint32_t>(address);
}

std::uint64_t PackPlay::lines_before(const PackRun& run, std::uint64_t frame) const {
  std::uint64_t lines = 0;
  for (std::uint64_t i = run.first; i < frame; ++i)
    if (pack_.frames[i].pixels() > 0) lines += pack_.frames[i].lines();
  return lines;
}

/// Behind the last line it is the last frame that brings any, and the line behind that.
PackPlay::Place PackPlay::place_of(const PackRun& run, std::uint64_t line) const {
  Place place{run.first, 0};
  std::uint64_t before = 0;
  for (std::uint64_t i = run.first; i < run.end(); ++i) {
    if (pack_.frames[i].pixels() == 0) continue;
    place = {i, static_cast<int>(line - before)};
    if (line < before + pack_.frames[i].lines()) break;
    before += pack_.frames[i].lines();
  }
  return place;
}

void PackPlay::video_lines(const PackRun& run) {
  if (verdict_.board.has_screen() && run.height > 0)
    player_.set(KAGE_BOARD_VIDEO_LINES, static_cast<std::uint32_t>(run.height));
}

void PackPlay::goes_back(const char* counter, std::uint32_t from, std::uint32_t to) const {
  throw Error(
      fmt::format("{}: board {}: {} goes back from {} to {} while it {}: the link checks what it brings, so it is the "
                  "board that says so: load a bitstream of tools/fpga",
                  player_.port(), verdict_.board.name, counter, from, to, doing_));
}

/// Only growth since `from` keeps it waiting, up to what a list brings: registers that alternate would for ever. Lines
/// and frames beyond are for the verdict.
PackPlay::Waited PackPlay::wait_for(std::uint64_t lines, std::uint64_t of_lines, std::uint64_t of_frames,
                                    const PlayState& from) {
  std::uint64_t moved = clock_.now();
  Growth line_growth{from.lines, of_lines};
  Growth frame_growth{from.played, of_frames};
  PlayState last = from;
  while (true) {
    wait();
    const PlayState s = player_.state();
    if (!s.playing && s.lines >= lines) return {true, s};
    const std::uint64_t now = clock_.now();
    if (line_growth.goes_back(s.lines)) goes_back("LINES", last.lines, s.lines);
    if (frame_growth.goes_back(s.played)) goes_back("PLAYED", last.played, s.played);
    const bool line = line_growth.grows(s.lines);
    const bool frame = frame_growth.grows(s.played);
    // A check of words tells that some came, and not how many.
    const bool words = s.play_crc != last.play_crc && words_alone_ < kWordsAlone * options_.timeout;
    if (words && !line && !frame) words_alone_ += now - moved;
    if (line || frame || words)
      moved = now;
    else if (now - moved >= options_.timeout)
      return {false, s};
    if (s.lines != last.lines && options_.progress)
      options_.progress(fmt::format("{}: line {} of {}", doing_, s.lines, of_lines));
    last = s;
  }
}

bool PackPlay::wait_for_frames(std::uint64_t frames) {
  const std::uint64_t begin = clock_.now();
  while (player_.get(KAGE_REG_FRAMES) != static_cast<std::uint32_t>(frames)) {
    wait();
    if (clock_.now() - begin >= options_.timeout) return false;
  }
  return true;
}

void PackPlay::play(const PackRun& run) {
  video_lines(run);
  const std::vector<std::uint32_t> list = list_of(run);
  if (!run.direct) {
    now_at("took the words of " + frames_text(run));
    player_.control(0);
    player_.load(0, list);
  } else {
    player_.control(KAGE_BOARD_CONTROL_DIRECT_MASK);
  }
  now_at("played " + frames_text(run));
  const std::uint64_t begin = clock_.now();
  player_.start(0);
  ++verdict_.runs;
  if (run.direct) {
    ++verdict_.direct;
    try {
      player_.direct(list);
    } catch (const LinkError& e) {
      if (e.failure != LinkFailure::stalled) throw;
      lost_ = true;  // whatever the host says waits behind these words
      hangs(run, {}, fmt::format("the core takes no more of its {} words", pack_.frames[run.first].words), false);
      return;
    }
  }
  // The words are looked at first: words other than those that were loaded bring other lines, or fewer.
  Waited waited = wait_for(0, run.lines, run.frames);
  const PlayState& given = waited.state;
  const bool whole = given.played == run.frames;
  if (!run.direct && (whole ? given.play_crc != words_crc(run, run.frames) : waited.ended)) blame_memory(run);
  if (!run.direct && !waited.ended && given.played <= run.frames)
    blame_silent_memory(run, given, run.first + given.played, words_crc(run, given.played));
  if (waited.ended) waited = wait_for(run.lines, run.lines, run.frames);
  verdict_.seconds += static_cast<double>(clock_.now() - begin) / 1e6;
  if (!waited.ended) {
    hangs(run, waited.state, "nothing more comes", true);
    return;
  }
  if (!wait_for_frames(run.end())) {
    hangs(run, waited.state, "the last frame does not end", true);
    return;
  }
  shown_ += static_cast<std::uint64_t>(std::count_if(pack_.frames.begin() + static_cast<std::ptrdiff_t>(run.first),
                                                     pack_.frames.begin() + static_cast<std::ptrdiff_t>(run.end()),
                                                     [](const vectors::PackFrame& f) { return f.pixels() > 0; }));
  judge_lines(run, player_.state().lines);
  if (!verdict_.first && pack_.frames[run.end() - 1].settles) judge_registers(run.end() - 1);
  if (!verdict_.first) verdict_.frames = run.end();
}

void PackPlay::judge_lines(const PackRun& run, std::uint64_t came) {
  std::vector<std::uint32_t> wanted = answers_.signatures(run.first, run.frames);
  wanted.resize(std::min<std::uint64_t>(wanted.size(), came));
  const std::vector<std::uint32_t> got = player_.signatures(wanted.size());
  verdict_.lines += wanted.size();
  std::optional<Place> first;
  std::vector<int> of_first;  // lines of that frame
  std::size_t at = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (got[i] == wanted[i]) continue;
    ++verdict_.wrong_lines;
    const Place place = place_of(run, i);
    if (!first) {
      first = place;
      at = i;
    }
    if (place.frame == first->frame) of_first.push_back(place.line);
  }
  if (first) {
    look_into(run, *first, wanted[at], got[at], of_first);
    verdict_.frames = first->frame + 1;
  } else if (came > run.lines) {
    const Place last = place_of(run, run.lines);
    cosim::Difference& d = verdict_.first.emplace();
    d.frame = static_cast<int>(last.frame);
    d.field = "height";
    d.expected = last.line;
    d.actual = last.line + static_cast<std::int64_t>(came - run.lines);
    d.remark = fmt::format("{} lines of the list came, {} must", came, run.lines);
    verdict_.frames = last.frame + 1;
  }
}

void PackPlay::judge_registers(std::uint64_t frame) {
  for (const vectors::RegisterRead& r : pack_.reads) {
    if (r.frame != frame) continue;
    // How the core is made decides no pixel, and was looked at before: it has to stay what it was.
    const bool shape = r.address == KAGE_REG_SHAPE;
    const std::uint32_t wanted = (shape ? verdict_.board.shape : r.value) & r.mask;
    const std::uint32_t got = player_.get(r.address) & r.mask;
    ++verdict_.registers;
    if (got == wanted) continue;
    cosim::Difference& d = verdict_.first.emplace();
    d.frame = static_cast<int>(frame);
    d.field = "register";
    d.expected = wanted;
    d.actual = got;
    d.remark = fmt::format("register {} ({:#x}): expected {:#x}, got {:#x}", r.name, r.address, wanted, got);
    verdict_.frames = frame + 1;
    return;
  }
}

void PackPlay::hangs(const PackRun& run, const PlayState& state, const std::string& how, bool judge) {
  Place place = place_of(run, state.lines);
  if (run.lines == 0 || state.lines >= run.lines) place = {std::min(run.first + state.played, run.end() - 1), 0};
  const vectors::PackFrame& frame = pack_.frames[place.frame];
  const std::string status =
      lost_ ? "its registers cannot be read behind these words" : status_text(player_.get(KAGE_REG_STATUS));
  const std::string text = fmt::format("the core hangs: {} in {} s: {}, line {} of {}, {} of {} frames taken", how,
                                       static_cast<double>(options_.timeout) / 1e6, status, state.lines, run.lines,
                                       state.played, run.frames);
  // A line that came out wrong before is the first difference.
  if (judge && !lost_) judge_lines(run, std::min<std::uint64_t>(state.lines, run.lines));
  if (verdict_.first) {
    verdict_.notes.push_back("behind that " + text);
    return;
  }
  cosim::Difference& d = verdict_.first.emplace();
  d.frame = static_cast<int>(place.frame);
  d.line = place.line;
  d.field = "missing";
  d.expected = static_cast<std::int64_t>(frame.pixels());
  d.actual = std::int64_t{place.line} * frame.status.width;
  d.remark = text;
  verdict_.frames = place.frame + 1;
}

void PackPlay::count_screen() {
  if (!verdict_.board.has_screen()) return;
  const std::uint64_t begin = clock_.now();
  do {
    (void)player_.state();
    verdict_.screen = player_.counts().screen - before_;
  } while (!verdict_.first && verdict_.screen.shown < shown_ && clock_.now() - begin < kScreensEnd);
}

}  // namespace kage::board
