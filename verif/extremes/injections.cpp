// SPDX-License-Identifier: Apache-2.0
#include "extremes/injections.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "extremes/campaign.hpp"

namespace kage::verif {
namespace {

using Names = std::vector<std::string_view>;

const std::array<std::pair<Injection, Names>, 13>& all_injections() {
  static const std::array<std::pair<Injection, Names>, 13> all{
      {{Injection::wide_span, {"1", "2", "3", "4", "5", "6", "8", "9", "13"}},
       {Injection::moved_corner, {"7", "plane unsnapped"}},
       {Injection::tilted_plane, {"14 line", "plane", "plane side"}},
       {Injection::steep_step, {"15", "15 long"}},
       {Injection::wrong_pixel,
        {"11", "12", "15 end", "16", "17", "18", "19", "29", "29 frames", "29 core", "30 passes", "31", "32", "33",
         "34"}},
       {Injection::lost_layer, {"20", "20 deep"}},
       {Injection::lost_face, {"10 scale", "21", "21 rays", "22", "23", "24", "25", "26", "28"}},
       {Injection::near_cap, {"27"}},
       {Injection::finite_value, {"10"}},
       {Injection::lost_fragment, {"14", "14 screen"}},
       {Injection::swapped_pair, {"35", "36", "37", "38", "38 layers"}},
       {Injection::large_share, {"30", "curve"}},
       {Injection::lost_word, {"39", "40", "41"}}}};
  return all;
}

}  // namespace

Injection injection_for(const Family& family) {
  for (const auto& [injection, names] : all_injections())
    if (std::find(names.begin(), names.end(), family.info().name) != names.end()) return injection;
  return Injection::none;
}

const char* name_of(Injection injection) {
  return injection == Injection::none ? "none" : injection_names()[static_cast<std::size_t>(injection) - 1].c_str();
}

InjectionTrial try_injection(const Family& family, std::uint64_t seed, std::uint64_t starts, Context context,
                             const std::function<bool()>& stop) {
  InjectionTrial trial{injection_for(family), {}};
  context.injection = trial.injection;
  if (trial.injection == Injection::none) return trial;
  for (std::uint64_t index = 0; index < starts && !trial.seen && !stop(); ++index) {
    set_case_at_hand(case_name(family, seed, index));
    if (family.run(seed, index, context, stop).failing) trial.seen = index;
  }
  return trial;
}

}  // namespace kage::verif
