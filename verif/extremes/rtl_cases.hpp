// SPDX-License-Identifier: Apache-2.0
//
// Cases of families 12, 29 and 39 - 41 on models of the whole RTL.
#pragma once

#include <vector>

#include "extremes/family.hpp"

namespace kage::verif {

/// The models that cases are run on, by the names that verif/test/rtl/CMakeLists.txt gives them.
const std::vector<const char*>& model_names();

}  // namespace kage::verif
