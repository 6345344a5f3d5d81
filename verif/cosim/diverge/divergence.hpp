// SPDX-License-Identifier: Apache-2.0
//
// The first divergence: after a frame has come out different, it is run again with monitors, and what passes between
// the RTL's modules is held against what the golden core says must.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cosim/diverge/replay.hpp"
#include "cosim/diverge/stages.hpp"
#include "cosim/run.hpp"

namespace kage::cosim {

/// Where the RTL first departs. First is in the order in which a token passes the stages, not in that of clocks. A
/// wrong stage's effects on the stages behind it come later in that order, however early they show.
struct Divergence {
  int frame = 0;
  int from = 0;   ///< the first frame of the replay that showed it
  int line = -1;  ///< -1: not of a line
  int x = -1;     ///< -1: not of a pixel
  Stage stage{};
  std::string module;    ///< of rtl/: "pixel_banked"
  std::string what;      ///< "state of a pixel"
  std::string field;     ///< "z"; "missing": it never came; "unexpected": nothing more was to come
  std::string expected;  ///< as a person reads it
  std::string actual;
  std::uint64_t cycle = 0;  ///< core clock edges since the frame's first word was offered
  std::uint64_t clock = 0;  ///< the same, since the replay's first
  std::uint32_t token = 0;  ///< index in the frame
  std::uint32_t nth = 0;    ///< the same behind the front end, as PixelTouch::nth
  std::string token_text;   ///< "SP [12, 40) ..."
  std::string source;       ///< the part of the scene it came from, if the caller knows it: find_divergence() does not
  std::string waits;        ///< of a core that hangs: who waits for whom
  bool ahead = false;       ///< it is in the frame that RtlOptions::prelude put right ahead of `frame`
  bool initial_state = false;  ///< it depends on what registers and memories hold at first
  std::string waveform;        ///< the FST file, empty if none was written: write_waveform()
  std::string save_file;       ///< the GTKWave save file beside it
};

/// Run frame `frame` again, alone on a fresh core; if that shows nothing, with the one of the run before it, then with
/// 2, 4, ... and at last all of them before it. Empty if the stages agree everywhere: then the difference lies where no
/// monitor looks (describe_none()).
std::optional<Divergence> find_divergence(int frame, const Feed& feed, const Config& config,
                                          const ReplayOptions& options);

/// An event of the RTL at a pixel, where the golden model's history has the same event.
struct RtlTouch {
  std::uint32_t token = 0;
  std::uint32_t nth = 0;    ///< as PixelTouch::nth
  Stage stage{};            ///< pixel, exit or out
  bool load = false;        ///< its colour came back from the way out
  std::uint64_t cycle = 0;  ///< core clock edges since the frame's first word was offered
  bool same = true;
  struct Value {
    std::string text;    ///< "z 812"
    std::string golden;  ///< "811", or empty where it is the golden model's too
  };
  std::vector<Value> values;

  /// "z 812 (golden 811), color 10,20,30, class 1, dsf 1, fsf 0"
  [[nodiscard]] std::string text() const;
};

/// Run the frames `from` .. `frame` with monitors and tell what they saw of pixel (x, y) in the last of them.
std::vector<RtlTouch> watch_pixel(int from, int frame, const Feed& feed, const Config& config,
                                  const ReplayOptions& options, int x, int y);

/// One line: "frame 0, line 17, x 204: state of a pixel (rtl/pixel_banked.sv), field dsf: expected 1, got 0, ...".
std::string describe(const Divergence& divergence);

/// One line for a difference of which find_divergence() finds nothing: where to look.
std::string describe_none(const Difference& difference);

}  // namespace kage::cosim
