// SPDX-License-Identifier: Apache-2.0

/// @file
/// The golden core: the pixels and the status that docs/stream.md demands for a frame of words, for any configuration.
/// It reads the words that the RTL reads and nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "kage/defs.hpp"

namespace kage {

/// How a frame ended. Without an error all but the size is 0.
struct FrameStatus {
  ErrorCode error = ErrorCode::NONE;  ///< what is wrong; NONE: nothing
  std::uint32_t frame = 0;  ///< number in the header of the erroneous frame; 0 when the header did not arrive whole
  std::uint32_t line = 0;   ///< EOLs accepted before the error
  std::uint32_t token = 0;  ///< index of the token in its frame; the header is 0
  std::uint32_t unit = 0;   ///< of SEGMENT, UNIT_LONG and UNIT_SHORT
  int width = 0;            ///< of the frame as it left the core; 0 x 0 after an error in the header
  int height = 0;           ///< likewise

  bool operator==(const FrameStatus&) const = default;
};

/// Puts a status in words.
/// @param status of any frame
/// @return "ORDER at line 3, token 17: a token where its phase does not allow it", or "no error"
std::string describe(const FrameStatus& status);

/// State that a core keeps for a pixel of the current line (docs/stream.md, "What a pixel does").
struct PixelState {
  std::uint32_t z = 0;  ///< 2^Z_BITS - 1: clear; then all below is 0 until a TP of the line has come
  /// By channel, 0 .. 255; with linear light until a TP of the line has come 0 .. 2^LINEAR_BITS - 1. One channel: the
  /// first.
  std::array<std::uint16_t, 3> color{};
  std::uint32_t normal_class = 0;         ///< 0 is unlit; without a table 1 is lit
  std::uint32_t dsf = 0;                  ///< modulo 2^DSF_BITS
  std::uint32_t fsf = 0;                  ///< 0 or 1
  std::array<std::uint32_t, 8> counts{};  ///< by light
  std::uint32_t served = 0;               ///< 0 or 1: the pass of its newest light, modulo 2

  bool operator==(const PixelState&) const = default;
};

struct Token;

/// The line at hand, between tokens. Valid while the observer's function runs, or until the core is fed again.
class LineView {
 public:
  /// @return lines that have ended, 0 .. height; the height after the last
  [[nodiscard]] int y() const;
  /// @return pixels of a line
  [[nodiscard]] int width() const;
  /// @return what IF has added up since the last EV or ES, modulo 2^DSF_BITS
  [[nodiscard]] std::uint32_t bias() const;
  /// @return the header's colour: channel c in bits 8c .. 8c + 7
  [[nodiscard]] std::uint32_t background() const;
  /// @return whether a TP of the line has come: clear pixels then have the background's colour
  [[nodiscard]] bool painted() const;
  /// A pixel's state. Not checked.
  /// @param x 0 .. width() - 1
  /// @return what the core keeps of it
  [[nodiscard]] PixelState pixel(int x) const;

  /// A unit at fault drops its SEGs until the frame ends.
  /// @return whether the SEG that has just been accepted goes to its unit
  [[nodiscard]] bool segment_taken() const;

  /// Depth and draw index, colour and class of a unit's pixel before the tree merges them. Only after a TREE.
  struct UnitPixel {
    std::uint32_t z = 0;                   ///< 0 .. 2^Z_BITS - 1; all ones: the unit has nothing there
    std::uint32_t index = 0;               ///< draw index of its polyhedron
    std::array<std::uint16_t, 3> color{};  ///< by channel, as the pixel will hold it
    std::uint32_t normal_class = 0;        ///< 0 is unlit; without a table 1 is lit
  };
  /// A unit's pixel before the tree. Not checked; only after a TREE. [Ohno 1985]
  /// @param unit 0 .. UNITS - 1
  /// @param x 0 .. width() - 1
  /// @return what the unit's segments say of it
  [[nodiscard]] UnitPixel unit_pixel(int unit, int x) const;
  /// The pixel that the tree hands on: that of the nearest unit.
  /// @param x 0 .. width() - 1
  /// @return what the tree hands on
  [[nodiscard]] UnitPixel tree_pixel(int x) const;

 private:
  friend class GoldenCore;  // which alone makes views
  struct Parts;
  explicit LineView(const Parts& parts) : parts_(&parts) {}
  const Parts* parts_;
};

/// Observer of the golden core, called for each token. A core without an observer runs at full speed.
class CoreObserver {
 public:
  CoreObserver() = default;
  virtual ~CoreObserver() = default;
  CoreObserver(const CoreObserver&) = delete;
  CoreObserver& operator=(const CoreObserver&) = delete;

  /// The header, token 0, has been accepted.
  /// @param words the header's
  /// @param line before the first token
  virtual void header([[maybe_unused]] std::span<const std::uint32_t> words, [[maybe_unused]] const LineView& line) {}
  /// A token of the frame has been accepted and is about to do what it does.
  /// @param index of the token in the frame, from 1
  /// @param token what it says
  /// @param words the token's
  /// @param line as the token finds it
  virtual void before([[maybe_unused]] std::uint32_t index, [[maybe_unused]] const Token& token,
                      [[maybe_unused]] std::span<const std::uint32_t> words, [[maybe_unused]] const LineView& line) {}
  /// A token of a frame at the polygon level is there whole, and its kind is one that the configuration has. Then
  /// before() and after() are called, with this index, for each token of the span level that the front end makes of it.
  /// @param index of the token in the frame, from 1
  /// @param token what it says
  /// @param words the token's; before() has these very words, and not a copy, if the token goes on as it came
  virtual void came([[maybe_unused]] std::uint32_t index, [[maybe_unused]] const Token& token,
                    [[maybe_unused]] std::span<const std::uint32_t> words) {}
  /// The token has taken effect; not called for END. After an EOL the line is cleared already.
  /// @param index of the token in the frame, from 1
  /// @param token what it says
  /// @param line as the token leaves it
  virtual void after([[maybe_unused]] std::uint32_t index, [[maybe_unused]] const Token& token,
                     [[maybe_unused]] const LineView& line) {}
  /// The frame has an error: the lines that have not ended are background.
  /// @param status the error, and where it is
  /// @param words of the token at which the error shows, as many as there are; none in the header and behind END
  /// @param line as the last accepted token left it; of no frame if the error is in the header
  virtual void failed([[maybe_unused]] const FrameStatus& status, [[maybe_unused]] std::span<const std::uint32_t> words,
                      [[maybe_unused]] const LineView& line) {}
};

/// Takes the lines of a frame from top to bottom: the number `y` of each, and its `pixels`, width x CHANNELS bytes.
using LineSink = std::function<void(int y, std::span<const std::uint8_t> pixels)>;

/// The golden core. Not for use by two threads at once; independent objects are independent.
class GoldenCore {
 public:
  /// A core between frames.
  /// @param config a legal configuration (validate())
  explicit GoldenCore(const Config& config);
  ~GoldenCore();
  GoldenCore(GoldenCore&&) noexcept;
  GoldenCore& operator=(GoldenCore&&) noexcept;

  /// Takes the next words of the frame at hand, in pieces of any size. No more than a line and a token are kept. Errors
  /// in the words are no exceptions but a status, and background pixels.
  /// @param words those that follow
  /// @param sink gets the lines as they end; what it throws goes through, and the frame cannot go on
  void feed(std::span<const std::uint32_t> words, const LineSink& sink);

  /// Ends the frame: its words have all been fed, TLAST with the beat of the last. That beat is filled with zeros up to
  /// BEAT_WORDS, as the port does it. The words that are fed next are the next frame's.
  /// @param sink gets the lines that are still to come, after an error
  /// @return how the frame ended
  FrameStatus finish(const LineSink& sink);

  /// Sets the observer, which is called for each event of the core from now on.
  /// @param observer must outlive its use; nullptr: no one
  void observe(CoreObserver* observer);

  /// The line at hand, as the last token that was accepted left it: of an accepted header or later.
  /// @return valid until the core is fed again
  [[nodiscard]] LineView line() const;

  /// A frame whose words are all there: what was fed before without finish() is forgotten, then feed() and finish().
  /// @param words the whole frame
  /// @param sink gets its lines
  /// @return how the frame ended
  FrameStatus frame(std::span<const std::uint32_t> words, const LineSink& sink);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage
