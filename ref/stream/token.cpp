// SPDX-License-Identifier: Apache-2.0
// Tokens to words and back.
#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "kage/stream.hpp"
#include "number/bits.hpp"

namespace kage {
namespace {

constexpr unsigned code(Kind k) { return static_cast<unsigned>(k); }

}  // namespace

TokenWriter::TokenWriter(const Config& config, std::vector<std::uint32_t>& out)
    : config_(config), layout_(config), out_(&out) {}

void TokenWriter::header(const FrameHeader& h) {
  out_->push_back(kStreamMagic << 16 | kStreamVersion);
  out_->push_back(static_cast<std::uint32_t>(h.height) << 16 | static_cast<std::uint32_t>(h.width));
  out_->push_back(param_hash(config_));
  out_->push_back(h.background);
  out_->push_back(h.frame);
}

void TokenWriter::shade(std::uint32_t shade) {
  BitPacker p(*out_);
  p.put(code(Kind::SHADE), 4);
  p.put(shade, layout_.shade_shade.bits);
  p.close();
}

void TokenWriter::op(const SpanToken& s) {
  assert(fits_signed(s.z, layout_.op_z.bits) && fits_signed(s.dz, layout_.op_dz.bits) && s.xl >= 0 && s.xl <= s.xr);
  BitPacker p(*out_);
  p.put(code(Kind::OP), 4);
  p.put(static_cast<unsigned>(s.xl), layout_.op_xl.bits);
  p.put(static_cast<unsigned>(s.xr), layout_.op_xr.bits);
  p.put(s.lit ? 1 : 0, layout_.op_lit.bits);
  p.put_signed(s.z, layout_.op_z.bits);
  p.put_signed(s.dz, layout_.op_dz.bits);
  const auto channels = static_cast<std::size_t>(config_.channels);
  for (std::size_t c = 0; c < channels; ++c) p.put_signed(s.color[c], layout_.op_color[c].bits);
  for (std::size_t c = 0; c < channels; ++c) p.put_signed(s.dcolor[c], layout_.op_dcolor[c].bits);
  p.close();
}

void TokenWriter::sp(const SpanToken& s) {
  assert(fits_signed(s.z, layout_.sp_z.bits) && fits_signed(s.dz, layout_.sp_dz.bits) && s.xl >= 0 && s.xl <= s.xr);
  BitPacker p(*out_);
  p.put(code(Kind::SP), 4);
  p.put(static_cast<unsigned>(s.xl), layout_.sp_xl.bits);
  p.put(static_cast<unsigned>(s.xr), layout_.sp_xr.bits);
  p.put_signed(s.w, layout_.sp_w.bits);
  p.put_signed(s.z, layout_.sp_z.bits);
  p.put_signed(s.dz, layout_.sp_dz.bits);
  p.close();
}

void TokenWriter::nc(int xl, int xr, int w) {
  BitPacker p(*out_);
  p.put(code(Kind::NC), 4);
  p.put(static_cast<unsigned>(xl), layout_.nc_xl.bits);
  p.put(static_cast<unsigned>(xr), layout_.nc_xr.bits);
  p.put_signed(w, layout_.nc_w.bits);
  p.close();
}

void TokenWriter::inside(int w) {
  BitPacker p(*out_);
  p.put(code(Kind::IF), 4);
  p.put_signed(w, layout_.if_w.bits);
  p.close();
}

void TokenWriter::ev(int xl, int xr) {
  BitPacker p(*out_);
  p.put(code(Kind::EV), 4);
  p.put(static_cast<unsigned>(xl), layout_.ev_xl.bits);
  p.put(static_cast<unsigned>(xr), layout_.ev_xr.bits);
  p.close();
}

void TokenWriter::resolve() { out_->push_back(code(Kind::RESOLVE)); }

void TokenWriter::eol(int y) { out_->push_back(code(Kind::EOL) | static_cast<std::uint32_t>(y) << layout_.eol_y.lsb); }

void TokenWriter::end() { out_->push_back(code(Kind::END)); }

Token decode(const Config& config, const Layout& l, std::span<const std::uint32_t> words) {
  Token t;
  t.kind = static_cast<Kind>(words[0] & 15U);
  const auto get = [&](Field f) { return extract(words, f); };
  const auto geti = [&](Field f) { return static_cast<int>(extract(words, f)); };
  const auto channels = static_cast<std::size_t>(config.channels);
  switch (t.kind) {
    case Kind::SHADE:
      t.shade = static_cast<std::uint32_t>(get(l.shade_shade));
      break;
    case Kind::OP:
      t.span = {geti(l.op_xl), geti(l.op_xr), get(l.op_z), get(l.op_dz), 0, get(l.op_lit) != 0, {}, {}};
      for (std::size_t c = 0; c < channels; ++c) {
        t.span.color[c] = geti(l.op_color[c]);
        t.span.dcolor[c] = geti(l.op_dcolor[c]);
      }
      break;
    case Kind::SP:
      t.span = {geti(l.sp_xl), geti(l.sp_xr), get(l.sp_z), get(l.sp_dz), geti(l.sp_w), false, {}, {}};
      break;
    case Kind::NC:
      t.span.xl = geti(l.nc_xl);
      t.span.xr = geti(l.nc_xr);
      t.span.w = geti(l.nc_w);
      break;
    case Kind::IF:
      t.span.w = geti(l.if_w);
      break;
    case Kind::EV:
      t.span.xl = geti(l.ev_xl);
      t.span.xr = geti(l.ev_xr);
      break;
    case Kind::EOL:
      t.y = geti(l.eol_y);
      break;
    default:
      break;
  }
  return t;
}

std::string to_string(const Config& config, const Token& t) {
  std::string s(kKindNames[code(t.kind)]);
  const double z_unit = std::ldexp(1.0, -config.z_frac);
  const SpanToken& p = t.span;
  switch (t.kind) {
    case Kind::SHADE:
      return s + fmt::format(" {}/{}", t.shade, 1U << config.shade_frac);
    case Kind::OP: {
      s += fmt::format(" [{}, {}) z {} dz {} color", p.xl, p.xr, static_cast<double>(p.z) * z_unit,
                       static_cast<double>(p.dz) * z_unit);
      const double c_unit = std::ldexp(1.0, -config.color_frac);
      for (std::size_t c = 0; c < static_cast<std::size_t>(config.channels); ++c) {
        s += fmt::format("{}{}", c == 0 ? " " : ",", p.color[c] * c_unit);
        if (config.smooth != 0) s += fmt::format("{:+}", p.dcolor[c] * c_unit);
      }
      return s + (config.dsf_bits == 0 ? "" : p.lit ? " lit" : " unlit");
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
    case Kind::EOL:
      return s + fmt::format(" {}", t.y);
    default:
      return s;
  }
}

}  // namespace kage
