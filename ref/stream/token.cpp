// SPDX-License-Identifier: Apache-2.0
// Tokens to words and back.
#include <fmt/format.h>

#include <cmath>

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

/// Depth and colour, which OP and TP have alike: call put with name, value and Field of each in turn.
template <class Put>
void put_ramps(Put put, const Config& config, const SpanToken& s, Field z, Field dz, const Field (&color)[3],
               const Field (&dcolor)[3]) {
  put("z", s.z, z);
  put("dz", s.dz, dz);
  const auto channels = static_cast<std::size_t>(config.channels);
  for (std::size_t c = 0; c < channels; ++c) put("color", s.color[c], color[c]);
  for (std::size_t c = 0; c < channels; ++c) put("dcolor", s.dcolor[c], dcolor[c]);
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

/// Writes a token. `fields` calls its argument with name, value and Field of each field in turn. They are checked as
/// they go by, with one question at the end.
template <typename Fields>
void TokenWriter::pack(Kind kind, const Fields& fields) {
  std::array<std::uint32_t, 16> words;  // more than the longest token; only those written are read
  BitPacker p(words.data());
  p.put(code(kind), Field{0, 4, false});
  fields([&p](const char*, std::int64_t value, Field f) { p.put(value, f); });
  const std::uint32_t* end = p.close();
  if (!p.whole()) [[unlikely]]
    fields([kind](const char* name, std::int64_t value, Field f) {
      if (beyond(value, f) != 0) refuse(kind, name, value, f);
    });
  // Few words: not worth the call that inserting a range is.
  std::vector<std::uint32_t>& out = *out_;
  for (const std::uint32_t* w = words.data(); w != end; ++w) out.push_back(*w);
}

void TokenWriter::shade(std::uint32_t shade) {
  pack(Kind::SHADE, [&](auto put) { put("shade", shade, layout_.shade_shade); });
}

void TokenWriter::table(const TableToken& entry) {
  pack(Kind::TABLE, [&](auto put) {
    put("class", entry.normal_class, layout_.table_class);
    put("light", entry.light, layout_.table_light);
    for (std::size_t c = 0; c < static_cast<std::size_t>(config_.channels); ++c)
      put("share", entry.share[c], layout_.table_share[c]);
  });
}

void TokenWriter::face(const SegmentToken& face) {
  pack(Kind::FACE, [&](auto put) {
    put("unit", face.unit, layout_.face_unit);
    put("face", face.face, layout_.face_face);
    put("index", face.index, layout_.face_index);
    put("class", layout_.face_class.bits != 0 ? face.normal_class : 0, layout_.face_class);
    put("dz", face.dz, layout_.face_dz);
    for (std::size_t c = 0; c < static_cast<std::size_t>(config_.channels); ++c)
      put("color", face.color[c], layout_.face_color[c]);
  });
}

void TokenWriter::seg(const SegmentToken& segment) {
  pack(Kind::SEG, [&](auto put) {
    put("unit", segment.unit, layout_.seg_unit);
    put("pad", 0, layout_.seg_pad);
    put("z", segment.z, layout_.seg_z);
    put("sync", segment.sync ? 1 : 0, layout_.seg_sync);
    put("dx", segment.dx, layout_.seg_dx);
    put("face", segment.face, layout_.seg_face);
  });
}

void TokenWriter::tree() { out_->push_back(code(Kind::TREE)); }

void TokenWriter::op(const SpanToken& s) {
  pack(Kind::OP, [&](auto put) {
    put("xl", s.xl, layout_.op_xl);
    put("xr", s.xr, layout_.op_xr);
    put("class", layout_.op_class.bits != 0 ? s.normal_class : 0, layout_.op_class);
    put_ramps(put, config_, s, layout_.op_z, layout_.op_dz, layout_.op_color, layout_.op_dcolor);
  });
}

void TokenWriter::sp(const SpanToken& s) {
  pack(Kind::SP, [&](auto put) {
    put("xl", s.xl, layout_.sp_xl);
    put("xr", s.xr, layout_.sp_xr);
    put("w", s.w, layout_.sp_w);
    put("z", s.z, layout_.sp_z);
    put("dz", s.dz, layout_.sp_dz);
  });
}

void TokenWriter::nc(int xl, int xr, int w) {
  pack(Kind::NC, [&](auto put) {
    put("xl", xl, layout_.nc_xl);
    put("xr", xr, layout_.nc_xr);
    put("w", w, layout_.nc_w);
  });
}

void TokenWriter::inside(int w) {
  pack(Kind::IF, [&](auto put) { put("w", w, layout_.if_w); });
}

void TokenWriter::ev(int xl, int xr) {
  pack(Kind::EV, [&](auto put) {
    put("xl", xl, layout_.ev_xl);
    put("xr", xr, layout_.ev_xr);
  });
}

void TokenWriter::es(int xl, int xr, int light) {
  pack(Kind::ES, [&](auto put) {
    put("xl", xl, layout_.es_xl);
    put("xr", xr, layout_.es_xr);
    put("light", light, layout_.es_light);
  });
}

void TokenWriter::resolve() { out_->push_back(code(Kind::RESOLVE)); }

void TokenWriter::tp(const SpanToken& s) {
  pack(Kind::TP, [&](auto put) {
    put("xl", s.xl, layout_.tp_xl);
    put("xr", s.xr, layout_.tp_xr);
    put("alpha", s.alpha, layout_.tp_alpha);
    put_ramps(put, config_, s, layout_.tp_z, layout_.tp_dz, layout_.tp_color, layout_.tp_dcolor);
  });
}

void TokenWriter::eol(int y) {
  pack(Kind::EOL, [&](auto put) { put("y", y, layout_.eol_y); });
}

void TokenWriter::end() { out_->push_back(code(Kind::END)); }

void decode(const Config& config, const Layout& l, std::span<const std::uint32_t> words, Token& t) {
  t.kind = static_cast<Kind>(words[0] & 15U);
  BitUnpacker in(words);
  static_cast<void>(in.take(Field{0, 4, false}));
  const auto get = [&](Field f) { return in.take(f); };
  const auto geti = [&](Field f) { return static_cast<int>(in.take(f)); };
  const auto channels = static_cast<std::size_t>(config.channels);
  const auto range = [&](Field xl, Field xr) {
    t.span.xl = geti(xl);
    t.span.xr = geti(xr);
  };
  const auto ramps = [&](Field z, Field dz, const Field(&color)[3], const Field(&dcolor)[3]) {
    t.span.z = get(z);
    t.span.dz = get(dz);
    for (std::size_t c = 0; c < channels; ++c) t.span.color[c] = geti(color[c]);
    for (std::size_t c = 0; c < channels; ++c) t.span.dcolor[c] = geti(dcolor[c]);
  };
  switch (t.kind) {
    case Kind::SHADE:
      t.shade = static_cast<std::uint32_t>(get(l.shade_shade));
      break;
    case Kind::TABLE:
      t.table.normal_class = geti(l.table_class);
      t.table.light = geti(l.table_light);
      for (std::size_t c = 0; c < channels; ++c) t.table.share[c] = static_cast<std::uint32_t>(get(l.table_share[c]));
      break;
    case Kind::FACE:
      t.segment.unit = geti(l.face_unit);
      t.segment.face = geti(l.face_face);
      t.segment.index = geti(l.face_index);
      t.segment.normal_class = geti(l.face_class);
      t.segment.dz = get(l.face_dz);
      for (std::size_t c = 0; c < channels; ++c) t.segment.color[c] = geti(l.face_color[c]);
      break;
    case Kind::SEG:
      t.segment.unit = geti(l.seg_unit);
      static_cast<void>(get(l.seg_pad));
      t.segment.z = get(l.seg_z);
      t.segment.sync = get(l.seg_sync) != 0;
      t.segment.dx = geti(l.seg_dx);
      t.segment.face = geti(l.seg_face);
      break;
    case Kind::OP:
      range(l.op_xl, l.op_xr);
      t.span.normal_class = geti(l.op_class);
      ramps(l.op_z, l.op_dz, l.op_color, l.op_dcolor);
      break;
    case Kind::SP:
      range(l.sp_xl, l.sp_xr);
      t.span.w = geti(l.sp_w);
      t.span.z = get(l.sp_z);
      t.span.dz = get(l.sp_dz);
      break;
    case Kind::TP:
      range(l.tp_xl, l.tp_xr);
      t.span.alpha = geti(l.tp_alpha);
      ramps(l.tp_z, l.tp_dz, l.tp_color, l.tp_dcolor);
      break;
    case Kind::NC:
      range(l.nc_xl, l.nc_xr);
      t.span.w = geti(l.nc_w);
      break;
    case Kind::IF:
      t.span.w = geti(l.if_w);
      break;
    case Kind::EV:
      range(l.ev_xl, l.ev_xr);
      break;
    case Kind::ES:
      range(l.es_xl, l.es_xr);
      t.table.light = geti(l.es_light);
      break;
    case Kind::EOL:
      t.y = geti(l.eol_y);
      break;
    default:
      break;
  }
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
