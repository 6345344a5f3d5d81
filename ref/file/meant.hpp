// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace kage {

/// The one of `names` that was probably meant, or "": a beginning, or a name that two slips of the finger or one in a
/// short word turn into `text`.
std::string nearest(const std::string& text, const std::vector<std::string>& names);

/// " (did you mean NAME?)", or "" where nearest() has found none.
std::string meant(const std::string& name);

/// meant() of the nearest of `names`.
inline std::string meant(const std::string& text, const std::vector<std::string>& names) {
  return meant(nearest(text, names));
}

}  // namespace kage
