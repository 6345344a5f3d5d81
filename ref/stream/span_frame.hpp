// SPDX-License-Identifier: Apache-2.0
//
// A frame at the polygon level, as the frame at the span level that it comes to.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kage/stream.hpp"
#include "kage/token.hpp"
#include "polygon/span_tokens.hpp"

namespace kage {

/// The words of that frame, header included, which begin like those of any frame at the span level.
/// @param words a frame at the polygon level, sound or not
/// @return nothing where the front end refuses a token, or END lacks; words behind END are left out
inline std::optional<std::vector<std::uint32_t>> span_frame(const Config& config,
                                                            std::span<const std::uint32_t> words) {
  const Layout layout(config);
  std::vector<std::uint32_t> made;
  TokenWriter writer(config, made);
  FrameHeader header = FrameHeader::read(words);
  SpanTokens spans(config);
  spans.start(header);
  header.version = kStreamVersion;
  writer.header(header);
  TokenWalk walk(layout, words);
  bool ended = false;
  for (auto token = walk.next(); !token.empty(); token = walk.next()) {
    const Token t = decode(config, layout, token, walk.level());
    ended = t.kind == Kind::END;
    if (spans.add(t, [&writer](const Token& of_spans, bool) { writer.token(of_spans); }) != ErrorCode::NONE)
      return std::nullopt;
  }
  if (!ended) return std::nullopt;
  return made;
}

}  // namespace kage
