// SPDX-License-Identifier: Apache-2.0
// Tokens to words and back.
#include "kage/token.hpp"

#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <iterator>

#include "contract/derived.hpp"
#include "contract/fields.hpp"
#include "contract/token_text.hpp"
#include "kage/error.hpp"
#include "number/bits.hpp"

namespace kage {
namespace {

constexpr unsigned code(Kind k) { return static_cast<unsigned>(k); }

[[noreturn, gnu::cold, gnu::noinline]] void refuse(Kind kind, const char* name, std::int64_t value, Field f) {
  throw Error(fmt::format("{}: {} is {}, which {}{} bits do not hold", kKindNames[code(kind)], name, value,
                          f.is_signed ? "signed " : "", f.bits));
}

/// The forms of a token's text (`text` in rtl/defs/kage.yaml).
class TokenText {
 public:
  explicit TokenText(const Config& config)
      : config_(config), z_unit_(std::ldexp(1.0, -config.z_frac)), color_unit_(std::ldexp(1.0, -config.color_frac)) {}

  void text(std::string_view text) { s_ += text; }

  void as_plain(std::integral auto value) { add("{}", value); }
  template <class V>
  void as_plain(const std::array<V, 3>& channels) {
    each_channel([&](std::size_t c) { add("{}", channels[c]); });
  }
  void as_plane(std::int64_t value) { add("{}", std::ldexp(static_cast<double>(value), -kPlaneFrac)); }
  void as_subpixel(int value) { add("{}", value / 256.0); }
  void as_sign(int value) { add("{:+}", value); }
  void as_depth(std::int64_t value) { add("{}", static_cast<double>(value) * z_unit_); }
  void as_share(const auto& value) {
    as_plain(value);
    add("/{}", derived::whole_share(config_));
  }
  void as_ramp(const std::array<std::int32_t, 3>& color, const std::array<std::int32_t, 3>& slope) {
    each_channel([&](std::size_t c) {
      add("{}", color[c] * color_unit_);
      if (config_.smooth != 0) add("{:+}", slope[c] * color_unit_);
    });
  }
  /// Nothing in a core whose spans have none.
  void as_class(int normal_class) {
    if (derived::class_field_bits(config_) == 0) return;
    if (!derived::has_table(config_))
      text(normal_class != 0 ? " lit" : " unlit");
    else
      add(" class {}", normal_class);
  }
  void as_face(int face, std::int64_t z) {
    if (face == derived::blank_face(config_)) return text(" blank");
    add(" face {} z ", face);
    as_depth(z);
  }
  void as_samples(int samples) {
    if (derived::pass_samples_bits(config_) > 0) add(" {}", samples);
  }
  void as_flag(std::string_view name, bool set) {
    if (set) add(" {}", name);
  }

  /// The text; that of what is no kind.
  [[nodiscard]] std::string take() { return s_.empty() ? std::string(kKindNames[0]) : std::move(s_); }

 private:
  template <class V>
  void add(fmt::format_string<const V&> form, const V& value) {
    fmt::format_to(std::back_inserter(s_), form, value);
  }
  void each_channel(const auto& f) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(config_.channels); ++c) {
      if (c > 0) s_ += ',';
      f(c);
    }
  }

  const Config& config_;
  double z_unit_;
  double color_unit_;
  std::string s_;
};

}  // namespace

TokenWriter::TokenWriter(const Config& config, std::vector<std::uint32_t>& out)
    : config_(config), layout_(config), out_(&out) {}

void TokenWriter::header(const FrameHeader& h) {
  const auto check = [](const char* name, int value, Field f) {
    if (beyond(value, f) != 0)
      throw Error(fmt::format("header: {} is {}, which {} bits do not hold", name, value, f.bits));
  };
  check("width", h.width, FrameHeader::kWidth);
  check("height", h.height, FrameHeader::kHeight);
  FrameHeader whole = h;
  whole.param_hash = param_hash(config_);
  std::array<std::uint32_t, kHeaderWords> words{};
  whole.write(words);
  out_->insert(out_->end(), words.begin(), words.end());
}

/// Writes a token of kind K, of which `t` has the members. Values are checked as they go by, with one question at the
/// end.
template <Kind K, class T>
void TokenWriter::pack(const T& t) {
  std::array<std::uint32_t, kMostTokenWords> words;  // only those written are read
  BitPacker p(words.data());
  p.put(code_of(K), kKindField);
  visit_fields<K>(config_, layout_, t, [&p](const char*, int, const auto& value, Field f) { p.put(value, f); });
  const std::uint32_t* end = p.close();
  if (!p.whole()) [[unlikely]]
    visit_fields<K>(config_, layout_, t, [](const char* name, int, const auto& value, Field f) {
      if (beyond(value, f) != 0) refuse(K, name, value, f);
    });
  // Few words: not worth the call that inserting a range is.
  std::vector<std::uint32_t>& out = *out_;
  for (const std::uint32_t* w = words.data(); w != end; ++w) out.push_back(*w);
}

namespace {

// Arguments of pack(), in place of a whole Token: only the fields that a kind has.
struct OfSpan {
  const SpanToken& span;
};
struct OfSegment {
  const SegmentToken& segment;
};
struct OfTable {
  const TableToken& table;
};
struct OfPolygon {
  const PolygonToken& polygon;
};
struct OfRange {
  struct {
    int xl, xr, w;
  } span;
};

}  // namespace

void TokenWriter::shade(std::uint32_t shade) {
  const struct { std::uint32_t shade; } t{shade};
  pack<Kind::SHADE>(t);
}
void TokenWriter::table(const TableToken& entry) { pack<Kind::TABLE>(OfTable{entry}); }
void TokenWriter::face(const SegmentToken& face) { pack<Kind::FACE>(OfSegment{face}); }
void TokenWriter::seg(const SegmentToken& segment) { pack<Kind::SEG>(OfSegment{segment}); }
void TokenWriter::tree() { pack<Kind::TREE>(0); }
void TokenWriter::op(const SpanToken& s) { pack<Kind::OP>(OfSpan{s}); }
void TokenWriter::sp(const SpanToken& s) { pack<Kind::SP>(OfSpan{s}); }
void TokenWriter::nc(int xl, int xr, int w) { pack<Kind::NC>(OfRange{{xl, xr, w}}); }
void TokenWriter::inside(int w) { pack<Kind::IF>(OfRange{{0, 0, w}}); }
void TokenWriter::ev(int xl, int xr) { pack<Kind::EV>(OfRange{{xl, xr, 0}}); }
void TokenWriter::es(int xl, int xr, int light) {
  const struct {
    struct {
      int xl, xr;
    } span;
    struct {
      int light;
    } table;
  } t{{xl, xr}, {light}};
  pack<Kind::ES>(t);
}
void TokenWriter::resolve(int samples) {
  const struct { int samples; } t{samples};
  pack<Kind::RESOLVE>(t);
}
void TokenWriter::tp(const SpanToken& s) { pack<Kind::TP>(OfSpan{s}); }
void TokenWriter::eol(int y) {
  const struct { int y; } t{y};
  pack<Kind::EOL>(t);
}
void TokenWriter::end() { pack<Kind::END>(0); }
void TokenWriter::at(const PolygonToken& place, int light) {
  const struct {
    const PolygonToken& polygon;
    struct {
      int light;
    } table;
  } t{place, {light}};
  pack<Kind::AT>(t);
}
void TokenWriter::polygon(const PolygonToken& plane, const SpanToken& look) {
  const struct {
    const PolygonToken& polygon;
    const SpanToken& span;
  } t{plane, look};
  pack<Kind::POLYGON>(t);
}
void TokenWriter::edge(const PolygonToken& edge) { pack<Kind::EDGE>(OfPolygon{edge}); }
void TokenWriter::gradient(const PolygonToken& plane) { pack<Kind::GRADIENT>(OfPolygon{plane}); }
void TokenWriter::token(const Token& token) {
  with_kind(token.kind, [&]<Kind K>() { pack<K>(token); });
}

void decode(const Config& config, const Layout& layout, std::span<const std::uint32_t> words, Token& t, Level level) {
  t.kind = kind_of(words[0], level);
  BitUnpacker in(words);
  with_kind(t.kind, [&]<Kind K>() {
    visit_fields<K>(config, layout, t, [&in](const char*, int, auto& value, Field f) {
      value = static_cast<std::remove_reference_t<decltype(value)>>(in.take(f));
    });
  });
}

Token decode(const Config& config, const Layout& layout, std::span<const std::uint32_t> words, Level level) {
  Token t;
  decode(config, layout, words, t, level);
  return t;
}

std::string to_string(const Config& config, const Token& t) {
  TokenText text(config);
  tell_token(text, t);
  return text.take();
}

}  // namespace kage
