// SPDX-License-Identifier: Apache-2.0
#include "golden_fields.hpp"

#include <string_view>

#include "contract/derived.hpp"
#include "contract/fields.hpp"
#include "generated/golden_names.hpp"
#include "kage/golden.h"

long long token_field(const kage::Config& config, const kage::Layout& layout, const kage::Token& t, int field) {
  if (field < 0 || field >= KAGE_TOKEN_FIELDS) return 0;
  const GoldenField& wanted = kGoldenFields[static_cast<std::size_t>(field)];
  long long value = 0;
  kage::with_kind(t.kind, [&]<kage::Kind K>() {
    kage::visit_fields<K>(config, layout, t, [&](std::string_view name, int channel, const auto& of, kage::Field) {
      if (name == wanted.name && channel == wanted.channel) value = static_cast<long long>(of);
    });
  });
  return value;
}

int pixel_field(const kage::Config& config, const kage::LineView& line, int x, int field) {
  const kage::PixelState p = line.pixel(x);
  const bool clear = p.z == kage::derived::clear_depth(config);
  if (field >= KAGE_PIXEL_COUNT && field < KAGE_PIXEL_SERVED)
    return static_cast<int>(p.counts[static_cast<std::size_t>(field - KAGE_PIXEL_COUNT)]);
  switch (field) {
    case KAGE_PIXEL_SERVED:
      return static_cast<int>(p.served);
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
