// SPDX-License-Identifier: Apache-2.0
//
// The registers held against what rtl/defs/kage.yaml says of them, by what the ports show.
#pragma once

#include <optional>
#include <string>

#include "cosim/rtl.hpp"
#include "mutants/inputs.hpp"

namespace kage::verif {

/// The first register that is not as it must be: "FRAMES: expected 3, got 2". `rtl` is fresh; it is given a few frames.
std::optional<std::string> wrong_register(cosim::RtlCore& rtl, const Inputs& inputs);

}  // namespace kage::verif
