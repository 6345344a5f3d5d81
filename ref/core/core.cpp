// SPDX-License-Identifier: Apache-2.0
// Frame control: header, order of tokens, errors, and the lines of a frame.
#include "kage/core.hpp"

#include <vector>

#include "core/pixel_line.hpp"
#include "kage/stream.hpp"
#include "stream/rules.hpp"

namespace kage {

struct GoldenCore::Data {
  explicit Data(const Config& c) : config(c), layout(c), pixels(c) {}

  Config config;
  Layout layout;
  PixelLine pixels;
  TokenRules rules;
  std::vector<std::uint8_t> out;
  std::vector<std::uint32_t> filled;

  /// The error of a header that arrived whole.
  [[nodiscard]] ErrorCode check_header(std::span<const std::uint32_t> words) const {
    if (words[0] != (kStreamMagic << 16 | kStreamVersion)) return ErrorCode::HEADER;
    const int width = static_cast<int>(words[1] & 0xFFFFU);
    const int height = static_cast<int>(words[1] >> 16);
    if (width < 1 || width > config.max_width || height < 1 || height > 32767) return ErrorCode::SIZE;
    return words[2] == param_hash(config) ? ErrorCode::NONE : ErrorCode::PARAMS;
  }

  void apply(const Token& t) {
    switch (t.kind) {
      case Kind::SHADE:
        pixels.set_shade(t.shade);
        break;
      case Kind::OP:
        pixels.op(t.span);
        break;
      case Kind::SP:
        pixels.sp(t.span);
        break;
      case Kind::NC:
        pixels.nc(t.span.xl, t.span.xr, t.span.w);
        break;
      case Kind::IF:
        pixels.inside(t.span.w);
        break;
      case Kind::EV:
        pixels.ev(t.span.xl, t.span.xr);
        break;
      case Kind::RESOLVE:
        pixels.resolve();
        break;
      default:
        break;
    }
  }

  void emit(int y, bool blank, const LineSink& sink) {
    pixels.finish(blank, out);
    sink(y, out);
  }
};

GoldenCore::GoldenCore(const Config& config) : data_(std::make_unique<Data>(config)) {}
GoldenCore::~GoldenCore() = default;
GoldenCore::GoldenCore(GoldenCore&&) noexcept = default;
GoldenCore& GoldenCore::operator=(GoldenCore&&) noexcept = default;

FrameStatus GoldenCore::frame(std::span<const std::uint32_t> words, const LineSink& sink) {
  Data& d = *data_;
  const auto beat = static_cast<std::size_t>(d.config.beat_words);
  if (words.size() % beat != 0) {
    d.filled.assign(words.begin(), words.end());
    d.filled.resize((words.size() + beat - 1) / beat * beat, 0);
    words = d.filled;
  }

  FrameStatus status;
  std::uint32_t number = 0;
  const auto fail = [&](ErrorCode e, std::uint32_t line, std::uint32_t token) {
    status.error = e;
    status.frame = number;
    status.line = line;
    status.token = token;
  };
  if (words.size() < kHeaderWords) {
    fail(ErrorCode::LAST_EARLY, 0, 0);
    return status;
  }
  number = words[4];
  if (const ErrorCode e = d.check_header(words); e != ErrorCode::NONE) {
    fail(e, 0, 0);
    return status;
  }
  status.width = static_cast<int>(words[1] & 0xFFFFU);
  status.height = static_cast<int>(words[1] >> 16);
  d.rules.start(d.config, status.width, status.height);
  d.pixels.start(status.width, words[3], 0);
  d.out.resize(static_cast<std::size_t>(status.width) * static_cast<std::size_t>(d.config.channels));

  std::size_t at = kHeaderWords;
  for (std::uint32_t token = 1;; ++token) {
    const auto line = static_cast<std::uint32_t>(d.rules.line());
    ErrorCode e = ErrorCode::NONE;
    std::size_t n = 0;
    Token t;
    if (at >= words.size()) {
      e = ErrorCode::LAST_EARLY;
    } else if (n = d.layout.words[words[at] & 15U]; n == 0) {
      e = ErrorCode::KIND;
    } else if (at + n > words.size()) {
      e = ErrorCode::LAST_EARLY;
    } else {
      t = decode(d.config, d.layout, words.subspan(at, n));
      e = d.rules.accept(t);
    }
    if (e != ErrorCode::NONE) {
      fail(e, line, token);
      for (int y = d.rules.line(); y < status.height; ++y) d.emit(y, true, sink);
      return status;
    }
    if (t.kind == Kind::END) {
      if (at / beat != words.size() / beat - 1) fail(ErrorCode::LAST_LATE, line, token);
      return status;
    }
    if (t.kind == Kind::EOL)
      d.emit(t.y, false, sink);
    else
      d.apply(t);
    at += n;
  }
}

}  // namespace kage
