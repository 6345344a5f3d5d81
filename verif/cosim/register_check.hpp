// SPDX-License-Identifier: Apache-2.0
//
// The registers held against what rtl/defs/kage.yaml says of them, by what the ports show.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cosim/model/rtl.hpp"
#include "kage/config.hpp"

namespace kage::cosim {

/// A frame, and what the golden core makes of it.
struct KnownFrame {
  std::vector<std::uint32_t> words;
  std::vector<std::vector<std::uint8_t>> lines;
  FrameEnd end;
};

/// Asks the golden core.
KnownFrame known_frame(const Config& config, std::vector<std::uint32_t> words);

/// The first register that is not as it must be: "FRAMES: expected 3, got 2". `rtl` is new; it is given the frames, and
/// some of its own. Constants, addresses without a register, bytes that are written
/// alone, counters, the newest error, interrupts, the clocks that are lost, and the watchdog are looked at, with input
/// that is dropped and units that wait among them. CoreFailure as of Core.
std::optional<std::string> wrong_register(RtlCore& rtl, const Config& config, std::span<const KnownFrame> frames);

}  // namespace kage::cosim
