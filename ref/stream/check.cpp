// SPDX-License-Identifier: Apache-2.0
// The strict check of a frame, as files get it.
#include <fmt/format.h>

#include <algorithm>

#include "contract/derived.hpp"
#include "contract/fields.hpp"
#include "contract/rules.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "number/bits.hpp"
#include "number/first_centre.hpp"
#include "number/packed_color.hpp"
#include "polygon/span_tokens.hpp"
#include "stream/count.hpp"
#include "stream/cutter.hpp"

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
  made += other.made;
  words += other.words;
  spans += other.spans;
  span_pixels += other.span_pixels;
  units = std::max(units, other.units);
  active = std::max(active, other.active);
  return *this;
}

struct FrameChecker::Data {
  Data(const Config& c, std::string w, std::uint64_t o)
      : config(c), layout(c), where(std::move(w)), offset(o), spans(c) {}

  Config config;
  Layout layout;
  std::string where;
  std::uint64_t offset;
  TokenRules rules;
  SpanTokens spans;  // that tokens come to
  WordCutter cutter;
  TokenCounts counts;
  std::vector<std::vector<std::int64_t>> faces;  // dz, of each unit
  FrameHeader header;
  bool header_seen = false;
  bool ended = false;
  std::uint32_t token = 0;
  std::uint64_t at = 0;  // word of the frame where the token begins

  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(fmt::format("{}: frame {}, line {}, token {}, byte {}: {}", where, header.frame, rules.line(), token,
                            offset + at * 4, cause));
  }
  [[noreturn]] void fail(ErrorCode e) const {
    fail(fmt::format("{} ({})", kErrorTexts[static_cast<unsigned>(e)], kErrorNames[static_cast<unsigned>(e)]));
  }

  void check_header(std::span<const std::uint32_t> words) {
    header = FrameHeader::read(words);
    if (!header.known() || (header.level() == Level::polygons && config.active == 0)) fail(ErrorCode::HEADER);
    if (header.width < 1 || header.height < 1 || header.width > config.max_width || header.height > kMaxHeight)
      fail(ErrorCode::SIZE);
    if (header.param_hash != param_hash(config)) fail(ErrorCode::PARAMS);
    if (header.background >> kPackedBits != 0) fail("background has bits past its channels");
    header_seen = true;
    rules.start(config, header.width, header.height);
    spans.start(header);
    faces.assign(static_cast<std::size_t>(config.units), {});
    at = kHeaderWords;
    token = 1;
  }

  void check_pads(Kind kind, std::span<const std::uint32_t> body) const {
    with_kind(kind, [&]<Kind K>() {
      visit_pads<K>(layout, [&](Field pad) {
        if (bits_at(body, pad) != 0) fail(fmt::format("{}'s pad is not zero", kKindNames[static_cast<std::size_t>(K)]));
      });
    });
  }

  void check_segment(const SegmentToken& s) const {
    if (s.face == derived::blank_face(config)) return;
    const std::int64_t dz = faces[static_cast<std::size_t>(s.unit)][static_cast<std::size_t>(s.face)];
    if (!span_fits(s.z, dz, s.dx, layout.op_z.bits)) fail("the segment's depth overflows");
  }

  void check_token(std::span<const std::uint32_t> body) {
    const Token t = decode(config, layout, body, spans.level());
    if (!padding_is_zero(body, layout.bits[static_cast<std::size_t>(t.kind)]))
      fail("bits past the last field are not zero");
    check_pads(t.kind, body);
    ++counts.of_kind[static_cast<std::size_t>(t.kind)];
    if (t.kind == Kind::EDGE) check_edge(t.polygon);
    const ErrorCode e = spans.add(t, [this](const Token& of_spans, bool made) { return check_spans(of_spans, made); });
    if (e != ErrorCode::NONE) fail(e);
    at += body.size();
    counts.active = static_cast<int>(spans.most());
    if (t.kind == Kind::END)
      ended = true;
    else
      ++token;
  }

  /// The front end divides by an edge's height and walks it from the line at hand on.
  void check_edge(const PolygonToken& t) const {
    const int y = rules.line();
    if (t.top_y >= t.bottom_y || first_centre(t.top_y) > y || first_centre(t.bottom_y) <= y)
      fail("the edge does not go down through the centre of the line");
  }

  /// A token of the span level, made by the front end or not.
  ErrorCode check_spans(const Token& t, bool made) {
    if (const ErrorCode e = rules.accept(t, token); e != ErrorCode::NONE) return e;
    const KindInfo& info = info_of(t.kind);
    if (!info.state && rules.class_cut()) fail("the light table ends within a class");
    if (t.kind == Kind::FACE) {
      auto& of_unit = faces[static_cast<std::size_t>(t.segment.unit)];
      if (of_unit.empty()) ++counts.units;
      of_unit.push_back(t.segment.dz);
    }
    if (t.kind == Kind::SEG && !rules.outcome().taken) fail(rules.outcome().fault);
    if (t.kind == Kind::SEG) check_segment(t.segment);
    count_span(counts, t, made);
    const SpanToken& s = t.span;
    const int count = s.xr - s.xl;
    if (info.depth && !span_fits(s.z, s.dz, count, layout.op_z.bits)) fail("the span's depth overflows");
    if (info.color && config.smooth != 0)
      for (std::size_t c = 0; c < static_cast<std::size_t>(config.channels); ++c)
        if (!span_fits(s.color[c], s.dcolor[c], count, layout.op_color[c].bits)) fail("the span's colour overflows");
    return ErrorCode::NONE;
  }
};

FrameChecker::FrameChecker(const Config& config, std::string where, std::uint64_t offset)
    : data_(std::make_unique<Data>(config, std::move(where), offset)) {}
FrameChecker::~FrameChecker() = default;

void FrameChecker::feed(std::span<const std::uint32_t> words) {
  Data& d = *data_;
  d.counts.words += words.size();
  d.cutter.feed(words);
  if (!d.header_seen) {
    const auto header = d.cutter.take(kHeaderWords);
    if (header.empty()) return;
    d.check_header(header);
  }
  while (const std::uint32_t* first = d.cutter.peek()) {
    if (d.ended) d.fail("words after END");
    const std::size_t n = d.layout.words_of(*first, d.spans.level());
    if (n == 0) d.fail(ErrorCode::KIND);
    const auto body = d.cutter.take(n);
    if (body.empty()) return;
    d.check_token(body);
  }
}

TokenCounts FrameChecker::finish(FrameHeader* header) {
  Data& d = *data_;
  if (!d.header_seen) d.fail("the header is cut");
  if (!d.ended) d.fail(ErrorCode::LAST_EARLY);
  if (header != nullptr) *header = d.header;
  return d.counts;
}

TokenCounts check_frame(const Config& config, std::span<const std::uint32_t> words, const std::string& where,
                        std::uint64_t offset, FrameHeader* header) {
  FrameChecker checker(config, where, offset);
  checker.feed(words);
  return checker.finish(header);
}

}  // namespace kage
