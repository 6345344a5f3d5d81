// SPDX-License-Identifier: Apache-2.0
// The parts of the golden core that a LineView reads.
#pragma once

#include "contract/rules.hpp"
#include "core/pixel_line.hpp"
#include "core/tree_core.hpp"
#include "kage/core.hpp"

namespace kage {

struct LineView::Parts {
  explicit Parts(const Config& config) : pixels(config), tree(config) {}

  PixelLine pixels;
  TreeCore tree;
  TokenRules rules;
};

}  // namespace kage
