// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kage/cosim.hpp"

namespace kage::cli {

/// This program as a run knows it: progress and what is told go to standard error, signals end a run, and mapped files
/// are guarded (signals.hpp, mapped.hpp).
cosim::Host& terminal();

}  // namespace kage::cli
