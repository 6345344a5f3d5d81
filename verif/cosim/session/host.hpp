// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kage/cosim.hpp"

namespace kage::cosim {

/// Host::say(), once in the life of the program: scenes of a run may have the same trouble.
void say_once(Host& host, const std::string& line);

}  // namespace kage::cosim
