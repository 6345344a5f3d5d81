// SPDX-License-Identifier: Apache-2.0
// The strict check of a frame, as files get it.
#include <fmt/format.h>

#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "number/bits.hpp"
#include "stream/rules.hpp"

namespace kage {
namespace {

/// True if start + k * step fits `bits` for k = 0 .. count - 1. The sum is linear in k, so its ends decide.
bool span_fits(std::int64_t start, std::int64_t step, int count, unsigned bits) {
  if (count <= 1) return true;
  const Int128 end = static_cast<Int128>(start) + static_cast<Int128>(step) * (count - 1);
  const Int128 limit = static_cast<Int128>(1) << (bits - 1);
  return end >= -limit && end < limit;
}

/// True if the bits of the token past its last field are zero.
bool padding_is_zero(std::span<const std::uint32_t> words, unsigned bits) {
  const unsigned tail = bits % 32;
  return tail == 0 || (words.back() >> tail) == 0;
}

}  // namespace

TokenCounts& TokenCounts::operator+=(const TokenCounts& other) {
  for (std::size_t k = 0; k < of_kind.size(); ++k) of_kind[k] += other.of_kind[k];
  words += other.words;
  spans += other.spans;
  span_pixels += other.span_pixels;
  return *this;
}

TokenCounts check_frame(const Config& config, std::span<const std::uint32_t> words, const std::string& where,
                        std::uint64_t offset, FrameHeader* header) {
  TokenCounts counts;
  counts.words = words.size();
  const Layout layout(config);
  std::uint32_t frame = 0;
  std::uint32_t token = 0;
  std::size_t at = 0;
  TokenRules rules;
  const auto fail = [&](const std::string& cause) {
    throw Error(fmt::format("{}: frame {}, line {}, token {}, byte {}: {}", where, frame, rules.line(), token,
                            offset + at * 4, cause));
  };
  const auto fail_code = [&](ErrorCode e) {
    fail(fmt::format("{} ({})", kErrorTexts[static_cast<unsigned>(e)], kErrorNames[static_cast<unsigned>(e)]));
  };

  if (words.size() < kHeaderWords) fail("the header is cut");
  frame = words[4];
  if (words[0] != (kStreamMagic << 16 | kStreamVersion)) fail_code(ErrorCode::HEADER);
  const int width = static_cast<int>(words[1] & 0xFFFFU);
  const int height = static_cast<int>(words[1] >> 16);
  if (width < 1 || height < 1 || width > config.max_width || height > 32767) fail_code(ErrorCode::SIZE);
  if (words[2] != param_hash(config)) fail_code(ErrorCode::PARAMS);
  if (words[3] >> 24 != 0) fail("background has bits past its channels");
  if (header != nullptr) *header = {width, height, words[3], words[4]};
  rules.start(config, width, height);
  at = kHeaderWords;
  for (token = 1;; ++token) {
    if (at >= words.size()) fail_code(ErrorCode::LAST_EARLY);
    const auto kind = words[at] & 15U;
    const std::size_t n = layout.words[kind];
    if (n == 0) fail_code(ErrorCode::KIND);
    if (at + n > words.size()) fail_code(ErrorCode::LAST_EARLY);
    const auto body = words.subspan(at, n);
    const Token t = decode(config, layout, body);
    if (const ErrorCode e = rules.accept(t); e != ErrorCode::NONE) fail_code(e);
    if (!padding_is_zero(body, layout.bits[kind])) fail("bits past the last field are not zero");
    ++counts.of_kind[kind];
    if (t.kind == Kind::OP || t.kind == Kind::SP || t.kind == Kind::NC) {
      const SpanToken& s = t.span;
      const int count = s.xr - s.xl;
      ++counts.spans;
      counts.span_pixels += static_cast<std::uint64_t>(count);
      if (!span_fits(s.z, s.dz, count, layout.op_z.bits)) fail("the span's depth overflows");
      if (config.smooth != 0 && t.kind == Kind::OP)
        for (std::size_t c = 0; c < static_cast<std::size_t>(config.channels); ++c)
          if (!span_fits(s.color[c], s.dcolor[c], count, layout.op_color[c].bits)) fail("the span's colour overflows");
    }
    at += n;
    if (t.kind == Kind::END) break;
  }
  if (at != words.size()) fail("words after END");
  return counts;
}

}  // namespace kage
