// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options.hpp"

namespace kage::cli {

/// kage info SCENE: what a mesh or scene file holds, what of it is ignored, and which named configurations draw it at
/// options.size. The exit code.
int describe_scene(const Options& options);

}  // namespace kage::cli
