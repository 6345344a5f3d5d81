// SPDX-License-Identifier: Apache-2.0
//
// Cases of families 21 - 28: shadows by parity and by counting.
#pragma once

#include "extremes/scene_case.hpp"

namespace kage::verif {

/// Family 21: any scene.
struct ShadowsCase {
  int bits = 1;  ///< DSF_BITS
  SceneCase scene;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 21: the same against rays to the light.
struct ShadowRaysCase {
  int bits = 1;
  SceneCase scene;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 22: boxes in, over and beside each other.
struct NestedCase {
  struct Place {
    int box = 0;
    void fields(Fields& f);
  };
  int bits = 1;
  int sub_bits = kMostSubBits;
  double aside = 0.5;
  std::vector<Place> order;  ///< a box named twice is there once
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 23: a caster that light crosses n times.
struct CrossedCase {
  int bits = 1;
  int sub_bits = kMostSubBits;
  int crossed = 1;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 24: the eye in, out and on shadow planes, near planes through volumes.
struct EyeCase {
  int bits = 1;
  int sub_bits = kMostSubBits;
  int on_x = 0, on_z = 0;      ///< the plane it is on
  int ulps_x = 0, ulps_z = 0;  ///< and how far off it, in units of the last place
  double x = 0, y = -0.5, z = 0;
  double at_x = 0, at_y = -1, at_z = 1;
  double near = 0.5;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 25: the light on planes of faces, at vertices, in a caster, behind the eye, far away.
struct LightPlaceCase {
  int bits = 1;
  int sub_bits = kMostSubBits;
  bool directional = false;
  int on_x = 0, on_y = 0, on_z = 0;
  int ulps = 0;
  double x = 0, y = 5, z = 0;
  int far = 0;  ///< times 10 to this power
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 26: volumes that reach further than they must.
struct ReachCase {
  int bits = 1;
  double extrusion = 3;
  SceneCase scene;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 27: a face that is the cap of its own volume.
struct CapCase {
  int bits = 1;
  int sub_bits = kMostSubBits;
  int kind = 0;
  TurnCase turn;
  LampCase lamp;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 28: open, inverted and torn casters over a floor that is a caster too.
struct TornCase {
  struct Torn {
    SolidCase solid;
    int inverted = 0;       ///< a bit for each of its faces
    bool fin = false;       ///< an edge with three faces
    bool twice = false;     ///< a face that is there twice
    bool junction = false;  ///< a vertex within its neighbour's edge
    void fields(Fields& f);
  };
  int bits = 1;
  int sub_bits = kMostSubBits;
  std::vector<Torn> torn;
  ViewCase view;
  LampCase lamp;
  void fields(Fields& f);
  [[nodiscard]] SceneFrame frame() const;
  [[nodiscard]] Outcome check(const Context& context) const;
};

void add_shadow_families(Families& to);

}  // namespace kage::verif
