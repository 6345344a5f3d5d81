// SPDX-License-Identifier: Apache-2.0
//
// The tokens of a run's frames, packed for the report page, whose script tells a pixel's history from them.
#pragma once

#include <cstdint>
#include <cstdio>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cosim/phases.hpp"
#include "kage/stream.hpp"
#include "polygon/span_tokens.hpp"
#include "stream/cutter.hpp"

namespace kage::report {

/// Lines that are packed together.
inline constexpr int kBandLines = 16;

/// In the word ahead of a token: the front end made it.
inline constexpr std::uint32_t kMade = 1U << 31;

/// The tokens of kBandLines lines, or of the frame state. SEGs run a line ahead, so a band begins with those that
/// came before it and that its lines need.
struct Band {
  int frame = 0;
  int line = -1;            ///< the first; -1: the frame state
  std::uint32_t token = 0;  ///< index of its first token
  std::uint32_t ahead = 0;  ///< so many SEGs of earlier tokens stand before that one
  /// The frame is at the polygon level: its tokens are those of the span level, each behind a word. This word has the
  /// index of the stream's token in its lower bits, and kMade if the front end made the token, as IF of an NC.
  bool indexed = false;
  std::uint64_t offset = 0;  ///< of its text in the store
  std::size_t bytes = 0;     ///< of the text
};

/// Further facts of a frame, known from its words.
struct FrameTokens {
  PhaseSums phases;
  std::uint32_t tokens = 0;  ///< the header is one
  std::uint32_t background = 0;
};

/// Reads frames word by word; holds no more than a band in memory, and `budget` bytes packed in a file without a name.
/// Bands that no longer fit are left out, and all after them.
class TokenStore {
 public:
  /// Throws Error if there is no room for temporary files.
  TokenStore(const Config& config, std::size_t budget);

  /// Only bands for which it says so.
  void choose(std::function<bool(int frame, int line)> wanted) { wanted_ = std::move(wanted); }

  /// A frame: its number, its words in pieces, its end.
  void begin(int frame);
  void words(std::span<const std::uint32_t> piece);
  void end();

  /// Adds what the store of later frames has kept, of at most `frames` frames, as if this store had read them itself.
  void append(const TokenStore& later, std::size_t frames);

  [[nodiscard]] const std::vector<Band>& bands() const { return bands_; }
  [[nodiscard]] const std::vector<FrameTokens>& frames() const { return frames_; }  ///< by number

  /// A band's words: little-endian, deflated (zlib), in base64. Throws Error if they cannot be read again.
  [[nodiscard]] std::string text(const Band& band) const;

 private:
  void token(std::span<const std::uint32_t> words);
  void span_token(std::uint32_t index, const Token& t, bool made);
  void close_band();
  void keep(Band band, const std::string& text);
  void open_band(int line, std::uint32_t token);
  void segment(std::uint32_t index, std::span<const std::uint32_t> words);
  void tree();

  Config config_;
  Layout layout_;
  SpanTokens spans_;
  PhaseCounter counter_;
  std::size_t budget_;
  std::function<bool(int, int)> wanted_;
  std::vector<Band> bands_;
  std::vector<FrameTokens> frames_;
  std::size_t bytes_ = 0;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  bool full_ = false;

  // State of the frame at hand:
  WordCutter cutter_;
  bool header_ = true;  // it has yet to come
  bool broken_ = false;
  Level level_ = Level::spans;
  int line_ = 0;  // the one at hand
  Token t_;
  Band band_;
  int width_ = 0;
  std::vector<std::uint32_t> raw_;  // of the band
  TokenWriter writer_;              // into it
  struct Segment {
    std::uint32_t index = 0;
    std::vector<std::uint32_t> words;
    int dx = 0;
  };
  std::vector<std::deque<Segment>> ahead_;  // by unit: SEGs whose TREE has yet to come
};

/// RFC 4648 base64, padded.
std::string base64(std::span<const std::uint8_t> data);

}  // namespace kage::report
