// SPDX-License-Identifier: Apache-2.0
//
// Which deliberate error each family's check must see, and whether it does: a check that cannot fail is none.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "extremes/family.hpp"

namespace kage::verif {

/// The error that a family's check must see; Injection::none: there is none for it.
Injection injection_for(const Family& family);
/// Its name, as --inject takes it; "none".
const char* name_of(Injection injection);

/// How a check that must see its family's error fared.
struct InjectionTrial {
  Injection injection = Injection::none;
  std::optional<std::uint64_t> seen;  ///< the first start in which the case with the error fails
};

/// Runs up to `starts` starts of a family with its error, until one fails.
InjectionTrial try_injection(const Family& family, std::uint64_t seed, std::uint64_t starts, Context context,
                             const std::function<bool()>& stop);

}  // namespace kage::verif
