// SPDX-License-Identifier: Apache-2.0
//
// The registers held against what rtl/defs/kage.yaml says of them, by what the ports show.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cosim/model/rtl.hpp"
#include "kage/config.hpp"

namespace kage::cosim {

/// A frame, and how the golden core ends it.
struct KnownFrame {
  std::vector<std::uint32_t> words;
  FrameEnd end;
};

/// Asks the golden core, whose lines go to `sink`.
KnownFrame known_frame(const Config& config, std::vector<std::uint32_t> words, const LineSink& sink = kNowhere);

/// The first register that is not as it must be: "FRAMES: expected 3, got 2". `rtl` is new; it is given the frames, and
/// some of its own, so that input is dropped, units wait, and either port stands still. Things looked at:
/// * constants, and bytes that are written alone
/// * counters, lost clocks, and the newest error
/// * every interrupt with every enable, and the watchdog's report of a standstill
/// * writes to read-only registers, and all addresses behind the last register
/// * the values that a reset leaves
/// * accesses in every clock round an event (register_clocks.hpp)
///
/// Throws CoreFailure as Core does. `wait` is called often while the frames are fed; what it throws ends the check.
std::optional<std::string> wrong_register(
    RtlCore& rtl, const Config& config, std::span<const KnownFrame> frames, const std::function<void()>& wait = [] {});

}  // namespace kage::cosim
