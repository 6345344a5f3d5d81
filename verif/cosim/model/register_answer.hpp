// SPDX-License-Identifier: Apache-2.0
//
// Errors for register accesses that get no response.
#pragma once

#include <fmt/format.h>

#include <cstdint>

#include "cosim/core.hpp"
#include "cosim/model/driver/rtl_model.h"
#include "kage/registers.h"

namespace kage::cosim {

/// Throws RegisterError if `answer` (of kage_rtl_table) is no response; `name` is the register's.
inline void check_answer(const char* name, std::uint32_t address, int answer) {
  if (answer >= 0) return;
  const char* const kind = address <= KAGE_REG_LAST ? "register " : "";
  const char* const what = answer == KAGE_RTL_UNASKED    ? "answers before it is asked"
                           : answer == KAGE_RTL_UNSTABLE ? "takes back an answer that waits"
                                                         : "does not answer";
  throw RegisterError(fmt::format("{}{} ({:#04x}) {}", kind, name, address, what));
}

}  // namespace kage::cosim
