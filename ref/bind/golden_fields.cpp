// SPDX-License-Identifier: Apache-2.0
#include "golden_fields.hpp"

#include "kage/golden.h"

bool has_pixel_field(const kage::Config& c, int field) {
  if (field >= KAGE_PIXEL_COUNT) return c.count_bits > 0 && field - KAGE_PIXEL_COUNT < c.lights;
  if (field == KAGE_PIXEL_FSF) return c.fsf > 0;
  if (field >= KAGE_PIXEL_CLASS) return c.dsf_bits > 0;
  return field < KAGE_PIXEL_COLOR + c.channels;
}

long long token_field(const kage::Token& t, int kind, int field) {
  const auto channel = [&](const auto& of, int first) { return of[static_cast<std::size_t>(field - first)]; };
  if (field >= KAGE_TOKEN_COLOR && field < KAGE_TOKEN_DCOLOR)
    return kind == KAGE_KIND_FACE ? channel(t.segment.color, KAGE_TOKEN_COLOR)
                                  : channel(t.span.color, KAGE_TOKEN_COLOR);
  if (field >= KAGE_TOKEN_DCOLOR && field < KAGE_TOKEN_ALPHA) return channel(t.span.dcolor, KAGE_TOKEN_DCOLOR);
  if (field >= KAGE_TOKEN_SHARE && field < KAGE_TOKEN_Y) return channel(t.table.share, KAGE_TOKEN_SHARE);
  switch (field) {
    case KAGE_TOKEN_XL:
      return t.span.xl;
    case KAGE_TOKEN_XR:
      return t.span.xr;
    case KAGE_TOKEN_Z:
      return kind == KAGE_KIND_SEG ? t.segment.z : t.span.z;
    case KAGE_TOKEN_DZ:
      return kind == KAGE_KIND_FACE ? t.segment.dz : t.span.dz;
    case KAGE_TOKEN_W:
      return t.span.w;
    case KAGE_TOKEN_CLASS:
      return kind == KAGE_KIND_FACE    ? t.segment.normal_class
             : kind == KAGE_KIND_TABLE ? t.table.normal_class
                                       : t.span.normal_class;
    case KAGE_TOKEN_ALPHA:
      return t.span.alpha;
    case KAGE_TOKEN_SHADE:
      return t.shade;
    case KAGE_TOKEN_LIGHT:
      return t.table.light;
    case KAGE_TOKEN_Y:
      return t.y;
    case KAGE_TOKEN_UNIT:
      return t.segment.unit;
    case KAGE_TOKEN_FACE:
      return t.segment.face;
    case KAGE_TOKEN_INDEX:
      return t.segment.index;
    case KAGE_TOKEN_DX:
      return t.segment.dx;
    case KAGE_TOKEN_SYNC:
      return t.segment.sync ? 1 : 0;
    default:
      return 0;
  }
}

int pixel_field(const kage::Config& config, const kage::LineView& line, int x, int field) {
  const kage::PixelState p = line.pixel(x);
  const bool clear = p.z == (1U << config.z_bits) - 1;
  if (field >= KAGE_PIXEL_COUNT) return static_cast<int>(p.counts[static_cast<std::size_t>(field - KAGE_PIXEL_COUNT)]);
  switch (field) {
    case KAGE_PIXEL_Z:
      return static_cast<int>(p.z);
    case KAGE_PIXEL_CLASS:
      return clear ? int{KAGE_PIXEL_ANY} : static_cast<int>(p.normal_class);
    case KAGE_PIXEL_DSF:
      return static_cast<int>(p.dsf);
    case KAGE_PIXEL_FSF:
      return static_cast<int>(p.fsf);
    default:
      return clear && !line.painted() ? int{KAGE_PIXEL_ANY}
                                      : p.color[static_cast<std::size_t>(field - KAGE_PIXEL_COLOR)];
  }
}
