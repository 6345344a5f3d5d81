// SPDX-License-Identifier: Apache-2.0
//
// The parts of play_pack(): lists played and judged (pack_play.cpp), what is found out about a difference
// (pack_search.cpp), frames played over and over (pack_loop.cpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "board/pack_answers.hpp"
#include "board/pack_run.hpp"
#include "board/pack_runs.hpp"

namespace kage::board {

class PackPlay {
 public:
  PackPlay(Link& link, Transport& clock, const std::string& port, const std::filesystem::path& folder,
           const vectors::Pack& pack, const PackRunOptions& options);

  /// All of it. The board is as it was left last.
  void run();

  [[nodiscard]] PackVerdict& verdict() { return verdict_; }
  [[nodiscard]] Player& player() { return player_; }
  /// Current action of the board: "played frame 3".
  [[nodiscard]] const std::string& doing() const { return doing_; }

 private:
  struct Waited {
    bool ended = false;  // else nothing more came
    PlayState state;
  };
  struct Replay {
    bool ended = false;
    std::uint32_t signature = 0;
    std::uint32_t came = 0;             // pixels of the line
    std::vector<std::uint32_t> pixels;  // of them those that the board keeps
  };
  struct Place {
    std::uint64_t frame = 0;
    int line = 0;
  };

  void wait() const {
    if (options_.wait) options_.wait();
  }
  void now_at(const std::string& doing);
  [[nodiscard]] std::string frames_text(const PackRun& run) const;

  // pack_play.cpp
  void get_ready();
  void play(const PackRun& run);
  [[nodiscard]] std::vector<std::uint32_t> list_of(const PackRun& run) const;
  [[nodiscard]] std::uint32_t words_crc(const PackRun& run, std::uint64_t frames) const;
  [[nodiscard]] std::uint32_t address_of(const PackRun& run, std::uint64_t frame) const;
  [[nodiscard]] std::uint64_t lines_before(const PackRun& run, std::uint64_t frame) const;
  [[nodiscard]] Place place_of(const PackRun& run, std::uint64_t line) const;
  void video_lines(const PackRun& run);
  Waited wait_for(std::uint64_t lines, std::uint64_t of_lines, std::uint64_t of_frames, const PlayState& from = {});
  [[noreturn]] void goes_back(const char* counter, std::uint32_t from, std::uint32_t to) const;
  bool wait_for_frames(std::uint64_t frames);
  void judge_lines(const PackRun& run, std::uint64_t came);
  void judge_registers(std::uint64_t frame);
  void hangs(const PackRun& run, const PlayState& state, const std::string& how, bool judge);
  void count_screen();

  // pack_search.cpp
  Replay replay(const PackRun& run, std::uint64_t first, Place line);
  [[nodiscard]] std::optional<cosim::Difference> pixel_difference(Place place, const Replay& got) const;
  void look_into(const PackRun& run, Place place, std::uint32_t expected, std::optional<std::uint32_t> got,
                 const std::vector<int>& wrong_lines);
  [[noreturn]] void blame_memory(const PackRun& run);
  void blame_silent_memory(const PackRun& run, const PlayState& state, std::uint64_t frame, std::uint32_t crc_before);
  void keep(Place place, const Replay& got);

  // pack_loop.cpp
  void loop();
  [[nodiscard]] std::uint64_t lines_of(const PackRun& run, std::uint64_t frames) const;
  void end_loop(const PackRun& run, LoopVerdict& v, bool hung, std::uint64_t played, const PlayState& last);

  Transport& clock_;
  const vectors::Pack& pack_;
  const PackRunOptions& options_;
  Player player_;
  PackAnswers answers_;
  PackVerdict verdict_;
  std::string doing_ = "was asked what it is";
  bool lost_ = false;              // the link executes nothing more
  std::uint64_t words_alone_ = 0;  // time in which nothing but words came
  std::uint64_t shown_ = 0;        // frames with pixels that were played
  ScreenCounts before_;            // of the screen, ahead of the first list
};

}  // namespace kage::board
