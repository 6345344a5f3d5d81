// SPDX-License-Identifier: Apache-2.0
#include "device_clock.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "json/foreign_json.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::cli {

DeviceClock device_clock(const std::string& device, bool front_end) {
  const std::string path = (data_directory() / "constraints/figures.json").string();
  DeviceClock slowest;
  std::set<std::string> devices;
  const nlohmann::ordered_json figures = read_json(path);
  try {
    for (const auto& row : figures) {
      devices.insert(row.at("device").get<std::string>());
      const double mhz = row.at("clock_mhz").get<double>();
      if (row.value("front_end", false) && !front_end) continue;
      if (row.at("device") != device || (!slowest.core.empty() && mhz >= slowest.mhz)) continue;
      slowest = {mhz, row.at("core").get<std::string>()};
    }
  } catch (const nlohmann::ordered_json::exception& e) {
    throw Error(fmt::format("{}: {}", path, e.what()));
  }
  if (slowest.core.empty())
    throw Error(fmt::format("--device {}: no core was placed there; there are {}", device, fmt::join(devices, ", ")));
  return slowest;
}

}  // namespace kage::cli
