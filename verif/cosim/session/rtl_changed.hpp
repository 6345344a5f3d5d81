// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kage/cosim.hpp"

namespace kage::cosim {

/// Whether the RTL that is run is other than the one of the commit at hand: by a deliberate defect, or because files of
/// its folder were changed since. False where git, or a commit, is not there to say so.
bool rtl_changed(const RtlRun& rtl);

}  // namespace kage::cosim
