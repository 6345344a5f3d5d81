// SPDX-License-Identifier: Apache-2.0
//
// Cases of the bounds that docs/numbers.md has for depth planes: how far each is off what it stands for.
#pragma once

#include "extremes/scene_case.hpp"

namespace kage::verif {

/// The depth plane through three snapped vertices, rounded.
struct PlaneCase {
  struct Corner {
    int x = 0, y = 0;
    std::int64_t z = 0;  ///< in 2^-16 LSB
    void fields(Fields& f);
  };
  Corner a, b, c;
  int x = 0, y = 0;  ///< the pixel at which it is held against the exact one
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// A quadrilateral, which has its unsnapped plane, against its own corners' depths. Three corners are given by where
/// they are on the screen and how far away; the fourth makes it a parallelogram.
struct UnsnappedPlaneCase {
  struct Corner {
    double x = 0, y = 0;  ///< shares of the picture's size
    double w = 1;         ///< distance
    void fields(Fields& f);
  };
  bool parallel = false;
  int sub_bits = kMostSubBits;
  int z_bits = 24;
  int width = 64;  ///< of the picture; its height is as large
  int steep = 0;   ///< the third corner is 2^-steep as far from the line through the others on the screen
  Corner a, b, c;
  void fields(Fields& f);
  [[nodiscard]] SceneFrame frame() const;
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Sides of shadow volumes against their own corners' depths.
struct SidePlaneCase {
  int bits = 1;    ///< DSF_BITS
  int width = 64;  ///< of the picture
  SceneCase scene;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

void add_plane_families(Families& to);

}  // namespace kage::verif
