// SPDX-License-Identifier: Apache-2.0
//
// Registers that are read and cleared in the very clock in which something happens.
#pragma once

#include <cstdint>

#include "cosim/register_port.hpp"
#include "kage/config.hpp"

namespace kage::cosim {

/// Each kind of interrupt happens again and again, and in every clock round it IRQ is read, its counter is read, and
/// IRQ is cleared. A value that is read has the event from the clock in which the pin rises. A bit that is cleared
/// stays cleared if the event came before. If the event comes in the clock of the clearing or later, the bit is set: an
/// event is never lost (docs/rtl.md has the clocks that an access takes). The core comes right out of reset; throws as
/// RegisterPort does.
void check_clocks(const RegisterPort& port, const Config& config);

}  // namespace kage::cosim
