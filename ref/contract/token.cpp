// SPDX-License-Identifier: Apache-2.0
// Tokens to words and back.
#include <fmt/format.h>

#include <cmath>

#include "contract/fields.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "number/bits.hpp"

namespace kage {
namespace {

constexpr unsigned code(Kind k) { return static_cast<unsigned>(k); }

[[noreturn, gnu::cold, gnu::noinline]] void refuse(Kind kind, const char* name, std::int64_t value, Field f) {
  throw Error(fmt::format("{}: {} is {}, which {}{} bits do not hold", kKindNames[code(kind)], name, value,
                          f.is_signed ? "signed " : "", f.bits));
}

/// What a class says at the end of OP and FACE: nothing in a core without shadows.
std::string class_text(const Config& config, int normal_class) {
  if (config.dsf_bits == 0) return "";
  if (config.class_bits == 1) return normal_class != 0 ? " lit" : " unlit";
  return fmt::format(" class {}", normal_class);
}

}  // namespace

TokenWriter::TokenWriter(const Config& config, std::vector<std::uint32_t>& out)
    : config_(config), layout_(config), out_(&out) {}

void TokenWriter::header(const FrameHeader& h) {
  for (const auto& [name, value] : {std::pair{"width", h.width}, {"height", h.height}})
    if (value < 0 || value > 0xFFFF)
      throw Error(fmt::format("header: {} is {}, which 16 bits do not hold", name, value));
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
  std::array<std::uint32_t, 16> words;  // more than the longest token; only those written are read
  BitPacker p(words.data());
  p.put(code(K), Field{0, 4, false});
  visit_fields<K>(config_, layout_, t, [&p](const char*, const auto& value, Field f) { p.put(value, f); });
  const std::uint32_t* end = p.close();
  if (!p.whole()) [[unlikely]]
    visit_fields<K>(config_, layout_, t, [](const char* name, const auto& value, Field f) {
      if (beyond(value, f) != 0) refuse(K, name, value, f);
    });
  // Few words: not worth the call that inserting a range is.
  std::vector<std::uint32_t>& out = *out_;
  for (const std::uint32_t* w = words.data(); w != end; ++w) out.push_back(*w);
}

namespace {

// What pack() is given in place of a whole Token.
struct OfSpan {
  const SpanToken& span;
};
struct OfSegment {
  const SegmentToken& segment;
};
struct OfTable {
  const TableToken& table;
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
void TokenWriter::resolve() { pack<Kind::RESOLVE>(0); }
void TokenWriter::tp(const SpanToken& s) { pack<Kind::TP>(OfSpan{s}); }
void TokenWriter::eol(int y) {
  const struct { int y; } t{y};
  pack<Kind::EOL>(t);
}
void TokenWriter::end() { pack<Kind::END>(0); }

void decode(const Config& config, const Layout& layout, std::span<const std::uint32_t> words, Token& t) {
  t.kind = static_cast<Kind>(words[0] & 15U);
  BitUnpacker in(words);
  static_cast<void>(in.take(Field{0, 4, false}));
  with_kind(t.kind, [&]<Kind K>() {
    visit_fields<K>(config, layout, t, [&in](const char*, auto& value, Field f) {
      value = static_cast<std::remove_reference_t<decltype(value)>>(in.take(f));
    });
  });
}

Token decode(const Config& config, const Layout& layout, std::span<const std::uint32_t> words) {
  Token t;
  decode(config, layout, words, t);
  return t;
}

std::string to_string(const Config& config, const Token& t) {
  std::string s(kKindNames[code(t.kind)]);
  const double z_unit = std::ldexp(1.0, -config.z_frac);
  const SpanToken& p = t.span;
  switch (t.kind) {
    case Kind::SHADE:
      return s + fmt::format(" {}/{}", t.shade, 1U << config.shade_frac);
    case Kind::TABLE:
      s += fmt::format(" class {} light {} share", t.table.normal_class, t.table.light);
      for (std::size_t c = 0; c < static_cast<std::size_t>(config.channels); ++c)
        s += fmt::format("{}{}", c == 0 ? " " : ",", t.table.share[c]);
      return s + fmt::format("/{}", 1U << config.shade_frac);
    case Kind::FACE: {
      const SegmentToken& f = t.segment;
      s += fmt::format(" unit {} face {} index {} dz {} color", f.unit, f.face, f.index,
                       static_cast<double>(f.dz) * z_unit);
      for (std::size_t c = 0; c < static_cast<std::size_t>(config.channels); ++c)
        s += fmt::format("{}{}", c == 0 ? " " : ",", f.color[c]);
      return s + class_text(config, f.normal_class);
    }
    case Kind::SEG: {
      const SegmentToken& g = t.segment;
      s += fmt::format(" unit {} dx {}", g.unit, g.dx);
      s += g.face == (1 << config.face_bits) - 1
               ? " blank"
               : fmt::format(" face {} z {}", g.face, static_cast<double>(g.z) * z_unit);
      return s + (g.sync ? " sync" : "");
    }
    case Kind::OP:
    case Kind::TP: {
      s += fmt::format(" [{}, {}) z {} dz {} color", p.xl, p.xr, static_cast<double>(p.z) * z_unit,
                       static_cast<double>(p.dz) * z_unit);
      const double c_unit = std::ldexp(1.0, -config.color_frac);
      for (std::size_t c = 0; c < static_cast<std::size_t>(config.channels); ++c) {
        s += fmt::format("{}{}", c == 0 ? " " : ",", p.color[c] * c_unit);
        if (config.smooth != 0) s += fmt::format("{:+}", p.dcolor[c] * c_unit);
      }
      if (t.kind == Kind::TP) return s + fmt::format(" alpha {}", p.alpha);
      return s + class_text(config, p.normal_class);
    }
    case Kind::SP:
      return s + fmt::format(" [{}, {}) w {:+} z {} dz {}", p.xl, p.xr, p.w, static_cast<double>(p.z) * z_unit,
                             static_cast<double>(p.dz) * z_unit);
    case Kind::NC:
      return s + fmt::format(" [{}, {}) w {:+}", p.xl, p.xr, p.w);
    case Kind::IF:
      return s + fmt::format(" w {:+}", p.w);
    case Kind::EV:
      return s + fmt::format(" [{}, {})", p.xl, p.xr);
    case Kind::ES:
      return s + fmt::format(" [{}, {}) light {}", p.xl, p.xr, t.table.light);
    case Kind::EOL:
      return s + fmt::format(" {}", t.y);
    default:
      return s;
  }
}

}  // namespace kage
