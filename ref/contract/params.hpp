// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "kage/config.hpp"

namespace kage {

/// The parameter whose value is in a member of Config.
inline const ParamInfo& info_of(int Config::*member) {
  return *std::find_if(kParams.begin(), kParams.end(), [&](const ParamInfo& p) { return p.member == member; });
}

}  // namespace kage
