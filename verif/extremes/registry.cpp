// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "extremes/depth.hpp"
#include "extremes/fill_rule.hpp"
#include "extremes/lights.hpp"
#include "extremes/numbers.hpp"
#include "extremes/orders.hpp"
#include "extremes/planes.hpp"
#include "extremes/polyhedra.hpp"
#include "extremes/rtl_cases.hpp"
#include "extremes/shadows.hpp"

namespace kage::verif {
namespace {

Families made() {
  Families all;
  add_fill_rule_families(all);
  add_depth_families(all);
  add_shadow_families(all);
  add_polyhedra_families(all);
  add_order_families(all);
  add_light_families(all);
  add_number_families(all);
  add_plane_families(all);
  add_rtl_families(all);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    const auto key = [](const auto& f) { return f->info().number > 0 ? f->info().number : 1000; };
    return key(a) < key(b);
  });
  return all;
}

}  // namespace

const Families& all_families() {
  static const Families all = made();
  return all;
}

const Family* family_named(const std::string& name) {
  for (const auto& f : all_families())
    if (f->info().name == name) return f.get();
  return nullptr;
}

}  // namespace kage::verif
