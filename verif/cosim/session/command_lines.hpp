// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kage/cosim.hpp"

namespace kage::cosim {

/// Lines of kage cosim and kage explain that do what the options say, as far as options are not those of every run.
/// None for a scene or parameters of the program's own, which no command line names.
CommandLines command_lines(const CosimOptions& options);

}  // namespace kage::cosim
