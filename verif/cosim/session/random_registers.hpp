// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "cosim/compare.hpp"
#include "cosim/model/rtl.hpp"
#include "kage/config.hpp"

namespace kage::cosim {

/// The register check of random:mixed, once its frames are the same: a new core gets some random frames, sound and
/// damaged, and its registers are held against what they must say (cosim::wrong_register). A difference is one of
/// cosim::kBehindFrames, with the register in its remark. `wait` as of wrong_register().
std::optional<Difference> register_difference(const std::filesystem::path& library, const Config& config,
                                              const RtlOptions& options, const std::function<void()>& wait);

}  // namespace kage::cosim
