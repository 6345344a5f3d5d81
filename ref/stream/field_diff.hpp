// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "contract/fields.hpp"
#include "number/bits.hpp"

namespace kage {

/// A field that two tokens have different.
struct FieldDiff {
  std::string name;  ///< as docs/stream.md names it, "color[1]" for channel 1; "kind"
  std::int64_t a = 0;
  std::int64_t b = 0;
};

/// The first field in which two tokens differ; nothing if they are equal up to their last field. Tokens of two kinds
/// differ in their kind and need not be of one length.
inline std::optional<FieldDiff> first_field_diff(const Config& config, const Layout& layout,
                                                 std::span<const std::uint32_t> a, std::span<const std::uint32_t> b,
                                                 Level level = Level::spans) {
  BitUnpacker of_a(a);
  BitUnpacker of_b(b);
  std::optional<FieldDiff> found = FieldDiff{"kind", of_a.take(kKindField), of_b.take(kKindField)};
  if (found->a != found->b) return found;
  const Kind of = kind_of(static_cast<std::uint32_t>(found->a), level);
  found.reset();
  each_field(config, layout, of, [&](const char* name, int channel, Field f) {
    if (found) return;
    const std::int64_t va = of_a.take(f);
    const std::int64_t vb = of_b.take(f);
    if (va != vb) found = FieldDiff{channel < 0 ? std::string(name) : fmt::format("{}[{}]", name, channel), va, vb};
  });
  return found;
}

}  // namespace kage
