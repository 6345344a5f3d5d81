// SPDX-License-Identifier: Apache-2.0
//
// Values of options by the names that command lines and reports have for them.
#pragma once

#include <map>
#include <string>

#include "kage/cosim.hpp"

namespace kage::cosim {

/// By --order's names.
const std::map<std::string, TranslucentWay>& translucent_ways();
std::string name_of(TranslucentWay way);

/// By --level's names.
const std::map<std::string, Level>& levels();
std::string name_of(Level level);

/// By --front-end's names: who makes spans of polygons.
const std::map<std::string, Level>& front_ends();
std::string front_end_of(Level level);

/// Gives the core of frames at the polygon level a front end, of kUsualActive polygons, if the configuration has none.
/// Returns whether it did.
bool give_front_end(Level level, Config& config);

}  // namespace kage::cosim
