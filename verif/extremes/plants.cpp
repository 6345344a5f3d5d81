// SPDX-License-Identifier: Apache-2.0
#include "extremes/plants.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "extremes/campaign.hpp"

namespace kage::verif {
namespace {

using Names = std::vector<std::string_view>;

const std::array<std::pair<Plant, Names>, 13>& all_plants() {
  static const std::array<std::pair<Plant, Names>, 13> all{
      {{Plant::wide_span, {"1", "2", "3", "4", "5", "6", "8", "9", "13"}},
       {Plant::moved_corner, {"7", "plane unsnapped"}},
       {Plant::tilted_plane, {"14 line", "plane", "plane side"}},
       {Plant::steep_step, {"15", "15 long"}},
       {Plant::wrong_pixel,
        {"11", "12", "15 end", "16", "17", "18", "19", "29", "29 frames", "29 core", "31", "32", "33", "34"}},
       {Plant::lost_layer, {"20", "20 deep"}},
       {Plant::lost_face, {"10 scale", "21", "21 rays", "22", "23", "24", "25", "26", "28"}},
       {Plant::near_cap, {"27"}},
       {Plant::finite_value, {"10"}},
       {Plant::lost_fragment, {"14", "14 screen"}},
       {Plant::swapped_pair, {"35", "36", "37", "38", "38 layers"}},
       {Plant::large_share, {"30", "curve"}},
       {Plant::lost_word, {"39", "40", "41"}}}};
  return all;
}

}  // namespace

Plant plant_for(const Family& family) {
  for (const auto& [plant, names] : all_plants())
    if (std::find(names.begin(), names.end(), family.info().name) != names.end()) return plant;
  return Plant::none;
}

const char* name_of(Plant plant) {
  return plant == Plant::none ? "none" : plant_names()[static_cast<std::size_t>(plant) - 1].c_str();
}

PlantTrial try_plant(const Family& family, std::uint64_t seed, std::uint64_t starts, Context context,
                     const std::function<bool()>& stop) {
  PlantTrial trial{plant_for(family), {}};
  context.plant = trial.plant;
  if (trial.plant == Plant::none) return trial;
  for (std::uint64_t index = 0; index < starts && !trial.seen && !stop(); ++index) {
    set_case_at_hand(case_name(family, seed, index));
    if (family.run(seed, index, context, stop).failing) trial.seen = index;
  }
  return trial;
}

}  // namespace kage::verif
