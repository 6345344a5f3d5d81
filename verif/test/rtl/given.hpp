// SPDX-License-Identifier: Apache-2.0
//
// The parameters that a model was verilated with. CMakeLists.txt says them, once: it gives them to Verilator, and
// writes given.inc with them.
#pragma once

#include <array>
#include <stdexcept>
#include <string_view>

#include "kage/defs.hpp"

namespace kage::rtl {

struct Given {
  std::string_view name;
  int value;
};

/// The given parameters of a model; parameters of its module that are not listed have their defaults.
template <class Model>
inline constexpr std::array<Given, 0> kGiven{};

}  // namespace kage::rtl

#include "given.inc"

namespace kage::rtl {

/// A parameter that a model was given.
template <class Model>
constexpr int parameter(std::string_view name) {
  for (const Given& g : kGiven<Model>)
    if (g.name == name) return g.value;
  throw std::out_of_range("CMakeLists.txt gives the model no such parameter");
}

/// The configuration of a model. Parameters that are of its module alone are not in it.
template <class Model>
constexpr Config config_of() {
  Config c;
  for (const Given& g : kGiven<Model>)
    for (const ParamInfo& p : kParams)
      if (p.name == g.name) c.*p.member = g.value;
  return c;
}

}  // namespace kage::rtl
