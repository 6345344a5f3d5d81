// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "cosim/model/driver/rtl_model.h"

namespace kage::cosim {

/// FrameEnd::misconduct: `trouble`, and what the model has counted at the port of pixels.
inline std::string misconduct(const kage_rtl_stats& stats, const std::string& trouble) {
  std::string text = trouble;
  const auto add = [&](std::uint64_t n, const char* what) {
    if (n != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, what);
  };
  add(stats.user_errors, "pixels with a wrong TUSER");
  add(stats.last_errors, "pixels with a wrong TLAST");
  add(stats.extra_pixels, "pixels too many");
  add(stats.unstable, "clocks in which a waiting pixel changed");
  return text;
}

}  // namespace kage::cosim
