// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "cosim/core.hpp"

namespace kage::cosim {

struct RtlOptions {
  std::uint64_t seed = 1;        ///< of initial register contents and stalls
  int idle_percent = 0;          ///< share of clocks without input offered
  int backpressure_percent = 0;  ///< share of clocks without output taken
};

/// The RTL, simulated by the model library that find_model() gave. Throws Error if the library does not fit, and from
/// frame() if the core hangs.
std::unique_ptr<Core> make_rtl(const std::filesystem::path& library, const Config& config,
                               const RtlOptions& options = {});

}  // namespace kage::cosim
