// SPDX-License-Identifier: Apache-2.0
// stream_player between a memory, a link, a screen that asks for frames and a core that takes beats, all of which
// stall.
#include <deque>
#include <functional>
#include <utility>

#include "Vplayer1.h"
#include "Vplayer2.h"
#include "Vplayer4.h"
#include "Vplayer_long.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

using Words = std::vector<std::uint32_t>;
using Frames = std::vector<Words>;

template <class Model>
constexpr int run_bits() {
  for (const Given& g : kGiven<Model>)
    if (g.name == "RUN_BITS") return g.value;
  return 15;
}

/// Everything around the player. Its output is collected, and forbidden behaviour is refused in every clock.
template <class Model>
class Stage {
 public:
  static constexpr std::size_t kBeat = parameter<Model>("BEAT_WORDS");
  static constexpr std::size_t kPlaces = std::size_t{1} << parameter<Model>("ADDR_BITS");
  static constexpr std::size_t kRun = std::size_t{1} << run_bits<Model>();

  explicit Stage(Dice& dice) : top(dice), memory(kPlaces), dice_(dice), run_offer_(0), link_offer_(0) {
    for (auto& word : memory) word = static_cast<std::uint32_t>(dice.bits(32));
    top->rst_ni = 1;
    stalls(true);
  }

  /// Chooses new stalls; none at all if not `any`.
  void stalls(bool any) {
    const auto stall = [&] { return any ? stall_percent(dice_) : 0; };
    sink_stall = stall();
    run_stall_ = stall();
    rd_stall_ = stall();
    link_offer_ = Offer(stall());
    latency_ = any ? dice_.below(30) : 0;
  }

  void clock(bool start = false, bool stop = false, bool request = false) {
    top->start_i = start ? 1 : 0;
    top->stop_i = stop ? 1 : 0;
    top->frame_req_valid_i = request ? 1 : 0;
    top->m_axis_tready_i = dice_.percent(sink_stall) ? 0 : 1;
    const bool link_on = link_offer_(dice_, !link.empty());
    top->link_valid_i = link_on ? 1 : 0;
    top->link_data_i = link_on ? link.front() : static_cast<IData>(dice_.bits(32));
    // The memory: a run is accepted when the last word of the former has left, or leaves.
    if (run_left_ > 0 && !rd_on_ && wait_-- <= 0) rd_on_ = !dice_.percent(rd_stall_);
    top->rd_valid_i = rd_on_ ? 1 : 0;
    top->rd_data_i = rd_on_ ? memory[run_at_] : static_cast<IData>(dice_.bits(32));
    top->run_ready_i = 0;
    top.settle();
    const bool leaves = run_left_ == 1 && rd_on_ && top->rd_ready_o;
    top->run_ready_i = (run_left_ == 0 || leaves) && !dice_.percent(run_stall_) ? 1 : 0;
    top.settle();
    REQUIRE(top->frame_req_ready_o);
    if (beat_waits_) {
      REQUIRE(top->m_axis_tvalid_o);
      REQUIRE(beat() == waiting_);
    }
    if (run_waits_) REQUIRE((top->run_valid_o && run() == waiting_run_));
    beat_waits_ = top->rst_ni && top->m_axis_tvalid_o && !top->m_axis_tready_i;
    waiting_ = beat();
    run_waits_ = top->rst_ni && top->run_valid_o && !top->run_ready_i;
    waiting_run_ = run();
    if (top->m_axis_tvalid_o && top->m_axis_tready_i && top->rst_ni) {
      beats.push_back(waiting_);
      beat_clocks.push_back(top.clocks);
    }
    if (top->word_o) passed.push_back(top->data_o);
    if (top->word_o) word_clocks.push_back(top.clocks);
    if (top->rd_valid_i && top->rd_ready_o) {
      run_at_ = (run_at_ + 1) % kPlaces;
      --run_left_;
      rd_on_ = false;
    }
    if (top->run_valid_o && top->run_ready_i) {
      REQUIRE(run_left_ == 0);
      REQUIRE(top->run_words_o >= 1);
      REQUIRE(top->run_words_o <= kRun);
      runs.push_back(run());
      run_clocks.push_back(top.clocks);
      run_at_ = top->run_addr_o;
      run_left_ = top->run_words_o;
      wait_ = dice_.percent(50) ? latency_ : dice_.below(latency_ + 1);
    }
    if (link_on && top->link_ready_o) {
      link.pop_front();
      link_offer_.taken();
    }
    top.edge();
    top->start_i = 0;
    top->stop_i = 0;
    top->frame_req_valid_i = 0;
    top.settle();
  }

  /// Resets the player alone, as a host that holds the core does.
  void reset(int clocks) {
    top->rst_ni = 0;
    for (int i = 0; i < clocks; ++i) {
      clock();
      REQUIRE(!top->m_axis_tvalid_o);
      REQUIRE(!top->playing_o);
    }
    top->rst_ni = 1;
    forget();
    REQUIRE(top->played_o == 0);
  }
  void forget() {
    beats.clear();
    beat_clocks.clear();
    passed.clear();
    word_clocks.clear();
    runs.clear();
    run_clocks.clear();
    beat_waits_ = run_waits_ = false;
  }

  struct Beat {
    Words words;
    bool last;
    bool operator==(const Beat&) const = default;
  };
  using Run = std::pair<std::size_t, std::size_t>;

  Beat beat() {
    Beat is{Words(kBeat), top->m_axis_tlast_o != 0};
    for (std::size_t w = 0; w < kBeat; ++w)
      is.words[w] = static_cast<std::uint32_t>(get(top->m_axis_tdata_o, static_cast<int>(32 * w), 32));
    return is;
  }
  Run run() { return {top->run_addr_o, top->run_words_o}; }

  /// The beats of a frame: zeros behind its last word.
  static std::vector<Beat> beats_of(const Words& frame) {
    std::vector<Beat> is;
    for (std::size_t at = 0; at < frame.size(); at += kBeat) {
      Beat next{Words(kBeat), at + kBeat >= frame.size()};
      for (std::size_t w = 0; w < kBeat && at + w < frame.size(); ++w) next.words[w] = frame[at + w];
      is.push_back(next);
    }
    return is;
  }

  /// The output is `count` whole frames of the list, which begins anew behind its end.
  void require_frames(const Frames& frames, std::size_t count) {
    std::vector<Beat> expected;
    Words words;
    for (std::size_t f = 0; f < count; ++f) {
      const Words& frame = frames[f % frames.size()];
      const auto more = beats_of(frame);
      expected.insert(expected.end(), more.begin(), more.end());
      words.insert(words.end(), frame.begin(), frame.end());
    }
    REQUIRE(beats.size() == expected.size());
    REQUIRE(beats == expected);
    REQUIRE(passed == words);
    REQUIRE(top->played_o == count % 65536);
  }
  /// And the memory was asked for these frames from `address` on, in runs as long as they may be, and then `rest` more
  /// times for a number of words.
  void require_runs(const Frames& frames, std::size_t count, std::size_t address, std::size_t rest) {
    std::vector<Run> expected;
    std::size_t at = address;
    for (std::size_t f = 0; f < count; ++f) {
      const std::size_t size = frames[f % frames.size()].size();
      if (f > 0 && f % frames.size() == 0) {
        expected.emplace_back(at % kPlaces, 1);  // the 0 at the list's end
        at = address;
      }
      expected.emplace_back(at++ % kPlaces, 1);
      for (std::size_t left = size; left > 0; left -= std::min(left, kRun), at += kRun)
        expected.emplace_back(at % kPlaces, std::min(left, kRun));
      at -= (kRun - size % kRun) % kRun;
    }
    REQUIRE(runs.size() >= expected.size());
    REQUIRE(runs.size() <= expected.size() + rest);
    for (std::size_t i = 0; i < expected.size(); ++i) REQUIRE(runs[i] == expected[i]);
  }

  Bench<Model> top;
  std::vector<std::uint32_t> memory;
  std::deque<std::uint32_t> link;
  std::vector<Beat> beats;
  std::vector<std::uint64_t> beat_clocks, word_clocks, run_clocks;
  Words passed;
  std::vector<Run> runs;
  int sink_stall = 0;

 private:
  Dice& dice_;
  int run_stall_ = 0, rd_stall_ = 0, latency_ = 0, wait_ = 0;
  Offer run_offer_, link_offer_;
  std::size_t run_at_ = 0, run_left_ = 0;
  bool rd_on_ = false, beat_waits_ = false, run_waits_ = false;
  Beat waiting_{};
  Run waiting_run_{};
};

Words words_of(const Frames& frames, Dice& dice, bool end) {
  Words list;
  for (const Words& frame : frames) {
    // The upper byte of N says nothing.
    list.push_back(static_cast<std::uint32_t>(frame.size()) | static_cast<std::uint32_t>(dice.bits(8)) << 24);
    list.insert(list.end(), frame.begin(), frame.end());
  }
  if (end) list.push_back(static_cast<std::uint32_t>(dice.bits(8)) << 24);
  return list;
}

Frames some_frames(Dice& dice, int count, int most) {
  Frames frames(static_cast<std::size_t>(count));
  for (Words& frame : frames) {
    frame.resize(static_cast<std::size_t>(dice.between(1, most)));
    for (auto& word : frame) word = static_cast<std::uint32_t>(dice.bits(32));
  }
  return frames;
}

enum class End { list, stop, reset };

/// One list after another: from memory or link, to its end, stopped, or cut by a reset.
template <class Model>
void lists() {
  each_seed(60, [](Dice& dice) {
    Stage<Model> stage(dice);
    auto& top = stage.top;
    for (int round = 0; round < 12; ++round) {
      stage.stalls(true);
      const bool direct = dice.percent(40);
      const bool loop = dice.percent(40);
      const bool paced = dice.percent(40);
      const int asks = dice.between(1, 30);  // percent of the clocks in which the screen asks
      const Frames frames = some_frames(dice, dice.between(1, 6), dice.percent(30) ? 3 : 40);
      const std::size_t address = static_cast<std::size_t>(dice.bits(parameter<Model>("ADDR_BITS")));
      top->direct_i = direct ? 1 : 0;
      top->loop_i = loop ? 1 : 0;
      top->paced_i = paced ? 1 : 0;
      top->address_i = static_cast<IData>(address);
      // With loop_i the player passes over the end of the link's list: it is sent three times, and more is awaited
      // until somebody stops.
      Words list = words_of(frames, dice, true);
      stage.link.clear();
      if (direct) {
        if (loop)
          for (int copies = 0; copies < 3; ++copies) stage.link.insert(stage.link.end(), list.begin(), list.end());
        else
          stage.link.assign(list.begin(), list.end());
      } else {
        for (std::size_t i = 0; i < list.size(); ++i) stage.memory[(address + i) % stage.kPlaces] = list[i];
      }
      const End end = dice.percent(30) ? End::reset : loop || dice.percent(30) ? End::stop : End::list;
      const std::size_t total = frames.size() * (loop ? 3 : 1);
      const int until = end == End::list ? 1 << 30 : dice.below(dice.percent(50) ? 60 : 1500);

      stage.forget();
      // Nothing moves before start_i, and a stop_i then says nothing.
      for (int i = dice.below(4); i > 0; --i) stage.clock(false, dice.percent(50));
      REQUIRE(stage.passed.empty());
      stage.clock(true);
      REQUIRE(top->playing_o);
      REQUIRE(top->played_o == 0);
      int clocks = 0;
      for (; top->playing_o && clocks < until; ++clocks) {
        stage.clock(false, false, dice.percent(asks));
        REQUIRE(clocks < 60000);
        if (loop && stage.passed.size() > 4 * list.size()) break;
      }
      if (end == End::reset) {
        const Words words = stage.passed;  // what was sent until then is the list's beginning
        std::size_t at = 0;
        for (std::size_t f = 0; at < words.size(); ++f)
          for (const std::uint32_t word : frames[f % frames.size()])
            if (at < words.size()) REQUIRE(words[at++] == word);
        stage.reset(dice.between(1, 3));
        continue;
      }
      std::size_t frames_out = total;
      if (end == End::stop && top->playing_o) {
        // A frame that has begun comes whole. One whose words nobody has seen may have begun too.
        std::size_t begun = 0;
        for (std::size_t at = 0; at < stage.passed.size(); ++begun) at += frames[begun % frames.size()].size();
        stage.clock(false, true, dice.percent(asks));
        for (int i = 0; top->playing_o; ++i) {
          stage.clock(false, false, dice.percent(asks));
          REQUIRE(i < 20000);
        }
        frames_out = top->played_o;
        REQUIRE(frames_out >= begun);
        REQUIRE(frames_out <= begun + 1);
      } else if (loop) {
        frames_out = top->played_o;
      }
      // The last beat may still wait for the core.
      for (int i = 0; top->m_axis_tvalid_o; ++i) {
        stage.clock();
        REQUIRE(i < 2000);
      }
      stage.require_frames(frames, frames_out);
      if (!direct) stage.require_runs(frames, frames_out, address, 2);
      if (direct) REQUIRE(stage.runs.empty());
      if (end == End::list && direct) REQUIRE(stage.link.empty());
      if (direct) stage.reset(1);
    }
  });
}

/// Plays in pace: without a request nothing comes; one is kept; two are as good as one.
template <class Model>
void pace() {
  each_seed(30, [](Dice& dice) {
    for (const bool direct : {false, true}) {
      Stage<Model> stage(dice);
      auto& top = stage.top;
      stage.stalls(false);
      const Frames frames = some_frames(dice, 40, 12);
      const Words list = words_of(frames, dice, true);
      if (direct)
        stage.link.assign(list.begin(), list.end());
      else
        std::copy(list.begin(), list.end(), stage.memory.begin());
      top->direct_i = direct ? 1 : 0;
      top->paced_i = 1;
      top->loop_i = 0;
      top->address_i = 0;
      const auto quiet = [&] {
        for (int i = 0; i < 60; ++i) stage.clock();
      };
      std::size_t out = 0;
      const bool early = dice.percent(50);  // the screen may ask before there is a list
      if (early) stage.clock(false, false, true);
      stage.clock(true);
      quiet();
      if (early) ++out;
      REQUIRE(top->played_o == out);
      for (int i = 0; i < 10; ++i) {
        // The core stops in the midst of a frame, and the screen asks once, twice, thrice, or not at all.
        stage.sink_stall = 100;
        stage.clock(false, false, true);
        quiet();
        const int more = dice.below(4);
        for (int r = 0; r < more; ++r) {
          stage.clock(false, false, true);
          for (int wait = dice.below(3); wait > 0; --wait) stage.clock();
        }
        quiet();
        stage.sink_stall = 0;
        quiet();
        quiet();
        // A frame of a beat has gone into the player before the core took it, and so has the next one.
        ++out;
        const std::size_t begun = more > 0 ? out + 1 : out;
        const std::size_t first = frames[out - 1].size();
        if (first <= Stage<Model>::kBeat && more > 1) {
          // The first of the requests may have begun the next frame already, which one more is then kept for.
          REQUIRE((top->played_o == begun || top->played_o == begun + 1));
          out = top->played_o;
        } else {
          REQUIRE(top->played_o == begun);
          out = begun;
        }
      }
      stage.require_frames(frames, out);
    }
  });
}

/// Clocks from the first word of a frame to its last, with nobody stalling.
template <class Model>
std::uint64_t clocks_of(int words, bool direct) {
  Dice dice(1);
  Stage<Model> stage(dice);
  stage.stalls(false);
  Frames frames(1, Words(static_cast<std::size_t>(words), 5));
  const Words list = words_of(frames, dice, true);
  stage.link.assign(list.begin(), list.end());
  std::copy(list.begin(), list.end(), stage.memory.begin());
  stage.top->direct_i = direct ? 1 : 0;
  stage.top->loop_i = 0;
  stage.top->paced_i = 0;
  stage.top->address_i = 0;
  const std::uint64_t start = stage.top.clocks;
  stage.clock(true);
  while (stage.top->playing_o) stage.clock();
  stage.clock();
  stage.require_frames(frames, 1);
  if (!direct) {
    REQUIRE(stage.run_clocks[0] == start + 1);
    REQUIRE(stage.run_clocks[1] == start + 4);  // N came a clock after it was asked for
  } else {
    REQUIRE(stage.word_clocks[0] == start + 3);
  }
  REQUIRE(stage.beat_clocks[0] == stage.word_clocks[Stage<Model>::kBeat - 1] + 1);
  return stage.word_clocks.back() - stage.word_clocks.front();
}

}  // namespace

TEST_CASE("stream_player plays lists, BEAT_WORDS 1", "[stream_player]") { lists<Vplayer1>(); }
TEST_CASE("stream_player plays lists, BEAT_WORDS 2", "[stream_player]") { lists<Vplayer2>(); }
TEST_CASE("stream_player plays lists, BEAT_WORDS 4", "[stream_player]") { lists<Vplayer4>(); }
TEST_CASE("stream_player keeps a screen's pace", "[stream_player]") {
  pace<Vplayer1>();
  pace<Vplayer4>();
}

TEST_CASE("stream_player ends a list without a frame at once", "[stream_player]") {
  for (const bool loop : {false, true}) {
    Dice dice(new_seed());
    Stage<Vplayer2> stage(dice);
    stage.top->direct_i = 0;
    stage.top->loop_i = loop ? 1 : 0;
    stage.top->paced_i = dice.percent(50) ? 1 : 0;
    stage.top->address_i = 9;
    stage.memory[9] = 0xAB000000;
    stage.clock(true);
    for (int i = 0; stage.top->playing_o; ++i) {
      stage.clock();
      REQUIRE(i < 1000);
    }
    REQUIRE(stage.top->played_o == 0);
    REQUIRE(stage.runs.size() == 1);
    REQUIRE(stage.beats.empty());
  }
}

TEST_CASE("stream_player is as fast as it says", "[stream_player]") {
  // From the link, for the runs of these models are short.
  REQUIRE(clocks_of<Vplayer1>(64, true) == 63);
  REQUIRE(clocks_of<Vplayer2>(64, true) == 31 * 3 + 1);
  REQUIRE(clocks_of<Vplayer4>(64, true) == 15 * 5 + 3);
  REQUIRE(clocks_of<Vplayer_long>(64, false) == 15 * 5 + 3);
}

TEST_CASE("stream_player reads frames longer than a run of 2^15 words", "[stream_player]") {
  Dice dice(new_seed());
  Stage<Vplayer_long> stage(dice);
  stage.stalls(false);
  Frames frames;
  for (const int words : {2 * 32768 + 5, 32768, 3}) {
    frames.emplace_back(static_cast<std::size_t>(words));
    for (auto& word : frames.back()) word = static_cast<std::uint32_t>(dice.bits(32));
  }
  const Words list = words_of(frames, dice, true);
  const std::size_t address = stage.memory.size() - 100;  // the memory's end lies within the list
  for (std::size_t i = 0; i < list.size(); ++i) stage.memory[(address + i) % stage.memory.size()] = list[i];
  stage.top->direct_i = 0;
  stage.top->loop_i = 0;
  stage.top->paced_i = 0;
  stage.top->address_i = static_cast<IData>(address);
  stage.clock(true);
  while (stage.top->playing_o) stage.clock();
  stage.clock();
  stage.require_frames(frames, frames.size());
  stage.require_runs(frames, frames.size(), address, 1);
}
