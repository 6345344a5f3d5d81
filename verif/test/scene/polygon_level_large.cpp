// SPDX-License-Identifier: Apache-2.0
// Built-in scenes at the polygon level, as large as pictures are.
#include "test/scene/polygon_scenes.hpp"

namespace kage::verif {

TEST_CASE("built-in scenes at 640x480: the polygon level gives the tokens of the span level") {
  check_both_levels(640, 480, 4);
}

}  // namespace kage::verif
