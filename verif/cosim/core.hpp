// SPDX-License-Identifier: Apache-2.0
//
// Anything that turns the words of a frame into pixels and a status: the golden model, the RTL. What compares them
// knows no more.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "kage/core.hpp"
#include "kage/defs.hpp"
#include "kage/image.hpp"

namespace kage::cosim {

/// What a core made of a frame.
struct FrameResult {
  FrameStatus status;
  Image image;                ///< 0 x 0 after an error in the header
  std::uint64_t missing = 0;  ///< pixels at the picture's end that never came; they are black in `image`
  std::string misconduct;     ///< what was wrong with how the pixels came: "TLAST wrong on 2 pixels"; empty if nothing
  double seconds = 0;         ///< wall time inside the core
  std::uint64_t cycles = 0;   ///< core clock edges; 0 for a core without clock
  std::uint64_t starved = 0;  ///< of them, waiting for input
  std::uint64_t blocked = 0;  ///< of them, waiting for output
};

class Core {
 public:
  Core() = default;
  virtual ~Core() = default;
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  /// Work through one frame: all its words, TLAST with the beat of the last. Frames follow each other without a reset.
  virtual FrameResult frame(std::span<const std::uint32_t> words) = 0;
};

/// The golden model.
std::unique_ptr<Core> make_golden(const Config& config);

/// "ORDER at line 3, token 17: a token where its phase does not allow it", or "no error".
std::string describe(const FrameStatus& status);

}  // namespace kage::cosim
