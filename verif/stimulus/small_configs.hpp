// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kage/config.hpp"

namespace kage::verif {

struct SmallConfig {
  std::string name;
  Config config;
};

/// The default configuration of lines of up to 40 pixels, for models that are quick to build and to run, with a change.
template <class Change>
SmallConfig small_config(std::string name, Change change) {
  Config c;
  c.max_width = 40;
  c.x_bits = 6;
  c.lanes = 4;
  change(c);
  validate(c, name);
  return {std::move(name), c};
}

}  // namespace kage::verif
