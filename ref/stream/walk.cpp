// SPDX-License-Identifier: Apache-2.0
// Frames that may break any rule, token by token.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "kage/stream.hpp"
#include "number/counted.hpp"
#include "polygon/span_tokens.hpp"
#include "stream/count.hpp"

namespace kage {

TokenWalk::TokenWalk(const Layout& layout, std::span<const std::uint32_t> words)
    : layout_(&layout),
      level_(FrameHeader::read(words).level()),
      rest_(words.subspan(std::min<std::size_t>(words.size(), kHeaderWords))) {}

std::span<const std::uint32_t> TokenWalk::peek() const {
  if (ended_ || rest_.empty()) return {};
  const auto length = layout_->words_of(rest_[0], level_);
  return length > rest_.size() ? std::span<const std::uint32_t>() : rest_.first(length);
}

std::span<const std::uint32_t> TokenWalk::next() {
  const auto token = peek();
  if (token.empty()) return {};
  ended_ = kind_of(token[0]) == Kind::END;
  rest_ = rest_.subspan(token.size());
  return token;
}

std::string TokenWalk::rest_text() const {
  if (rest_.empty()) return "";
  if (ended_) return counted(rest_.size(), "word") + " behind END";
  const Kind kind = kind_of(rest_[0], level_);
  const std::size_t length = layout_->words_of(rest_[0], level_);
  if (length == 0) return fmt::format("kind {}, which is no token here", code_of(kind));
  return fmt::format("{} of {} words, cut after {}", kKindNames[static_cast<std::size_t>(kind)], length, rest_.size());
}

std::string words_text(std::span<const std::uint32_t> words) { return fmt::format("{:#010x}", fmt::join(words, " ")); }

TokenCounts count_tokens(const Config& config, std::span<const std::uint32_t> words) {
  const Layout layout(config);
  TokenCounts counts;
  counts.words = words.size();
  TokenWalk walk(layout, words);
  SpanTokens spans(config);
  spans.start(FrameHeader::read(words));
  bool refused = false;  // by the front end
  for (auto token = walk.next(); !token.empty(); token = walk.next()) {
    const Token t = decode(config, layout, token, walk.level());
    ++counts.of_kind[static_cast<std::size_t>(t.kind)];
    const auto count = [&](const Token& of_spans, bool made) { count_span(counts, of_spans, made); };
    refused = refused || spans.add(t, count) != ErrorCode::NONE;
    if (t.kind == Kind::FACE) counts.units = std::max(counts.units, t.segment.unit + 1);
  }
  if (spans.level() == Level::polygons) counts.active = static_cast<int>(spans.most());
  return counts;
}

}  // namespace kage
