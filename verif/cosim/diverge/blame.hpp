// SPDX-License-Identifier: Apache-2.0
//
// Which module of rtl/ a difference between two stages, or a standstill, is the work of.
#pragma once

#include <optional>
#include <string>

#include "cosim/diverge/expected_events.hpp"

namespace kage::cosim {

/// Known facts of a difference.
struct Clue {
  std::optional<ExpectedEvent> expected;  ///< none: nothing more was to come
  std::optional<kage_rtl_event> actual;   ///< none: it never came
  int value = -1;                         ///< the first that differs
  std::optional<Kind> kind;               ///< of the token
  bool at_last = false;                   ///< END was said to be in TLAST's beat
  std::uint32_t lines = 0;                ///< that had ended before the token
  bool lines_done = false;                ///< and those were all
  bool again = false;                     ///< an error of a frame that has had its own
  bool of_token = false;                  ///< of a segment: it came as the token has it
  bool polygons = false;                  ///< of a frame at the polygon level
  bool dropping = false;                  ///< all input is in, and token_reader still drops it
};

/// The module, "pixel_banked"; its file under rtl/ is MODULE.sv.
std::string blame(const Config& config, const Clue& clue);

/// The module of an event of Stage::part.
std::string part_name(const Config& config, const kage_rtl_event& event);

/// Who waits for whom, of RtlCore::handshakes(): "frame_control's command waits for pixel_banked".
struct Waiting {
  std::string text;
  std::string module;       ///< the one furthest down the way that does not take what is offered; empty if none
  bool lacks_line = false;  ///< that is line_out, which has been given no line: if one is missing, it is not to blame
};
Waiting waiting(const Config& config, const Handshakes& handshakes);

}  // namespace kage::cosim
