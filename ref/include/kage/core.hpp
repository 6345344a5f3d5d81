// SPDX-License-Identifier: Apache-2.0
//
// The golden core: the pixels and the status that docs/stream.md demands for a frame of words, for any configuration.
// It reads the words that the RTL reads and nothing else.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "kage/defs.hpp"

namespace kage {

/// How a frame ended. Without an error all but the size is 0.
struct FrameStatus {
  ErrorCode error = ErrorCode::NONE;
  std::uint32_t frame = 0;  ///< number in the header of the erroneous frame; 0 when the header did not arrive whole
  std::uint32_t line = 0;   ///< EOLs accepted before the error
  std::uint32_t token = 0;  ///< index of the token in its frame; the header is 0
  std::uint32_t unit = 0;   ///< of SEGMENT, UNIT_LONG and UNIT_SHORT
  int width = 0;            ///< of the frame as it left the core; 0 x 0 after an error in the header
  int height = 0;

  bool operator==(const FrameStatus&) const = default;
};

/// Takes the lines of a frame from top to bottom: `pixels` holds width x CHANNELS bytes.
using LineSink = std::function<void(int y, std::span<const std::uint8_t> pixels)>;

/// The golden core. Not for use by two threads at once; independent objects are independent.
class GoldenCore {
 public:
  /// `config` must be valid (config.hpp).
  explicit GoldenCore(const Config& config);
  ~GoldenCore();
  GoldenCore(GoldenCore&&) noexcept;
  GoldenCore& operator=(GoldenCore&&) noexcept;

  /// The next words of the frame at hand, in pieces of any size. Lines go to `sink` as they end; no more than a line
  /// and a token are kept. Errors in the words are no exceptions but a status, and background pixels.
  void feed(std::span<const std::uint32_t> words, const LineSink& sink);

  /// The frame's words have all been fed, TLAST with the beat of the last. That beat is filled with zeros up to
  /// BEAT_WORDS, as the port does it. What is fed next is the next frame.
  FrameStatus finish(const LineSink& sink);

  /// A frame whose words are all there: what was fed before without finish() is forgotten, then feed() and finish().
  FrameStatus frame(std::span<const std::uint32_t> words, const LineSink& sink);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage
