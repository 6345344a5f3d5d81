// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/option_names.hpp"

#include "kage/frontend.hpp"

namespace kage::cosim {
namespace {

template <class Value>
std::string name_in(const std::map<std::string, Value>& names, Value value) {
  for (const auto& [name, named] : names)
    if (named == value) return name;
  return {};
}

}  // namespace

const std::map<std::string, TranslucentWay>& translucent_ways() {
  static const std::map<std::string, TranslucentWay> kWays{{"exact", TranslucentWay::exact},
                                                           {"centroid", TranslucentWay::centroid},
                                                           {"submission", TranslucentWay::submission}};
  return kWays;
}

std::string name_of(TranslucentWay way) { return name_in(translucent_ways(), way); }

const std::map<std::string, Level>& levels() {
  static const std::map<std::string, Level> kLevels{{"spans", Level::spans}, {"polygons", Level::polygons}};
  return kLevels;
}

std::string name_of(Level level) { return name_in(levels(), level); }

const std::map<std::string, Level>& front_ends() {
  static const std::map<std::string, Level> kWho{{"host", Level::spans}, {"rtl", Level::polygons}};
  return kWho;
}

std::string front_end_of(Level level) { return name_in(front_ends(), level); }

bool give_front_end(Level level, Config& config) {
  if (level != Level::polygons || config.active > 0) return false;
  config.active = kUsualActive;
  return true;
}

}  // namespace kage::cosim
