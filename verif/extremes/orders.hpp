// SPDX-License-Identifier: Apache-2.0
//
// Cases of families 14 and 35 - 38: trees that cut faces, visibility orders, and what translucent faces show.
#pragma once

#include "extremes/scene_case.hpp"
#include "kage/order.hpp"

namespace kage::verif {

/// Polygons as a tree is built of: anyhow, on a lattice, in planes at right angles, in one plane or nearly so.
struct MeshCase {
  struct Face {
    double ax = 0, ay = 0, az = 0, bx = 1, by = 0, bz = 0, cx = 0, cy = 1, cz = 0;
    int ulps = 0;  ///< off the common plane, of a mesh that nearly has one
    void fields(Fields& f);
  };
  int manner = 0;
  double slope_x = 0.5, slope_y = -0.25;  ///< of the common plane
  std::vector<Face> faces;
  void fields(Fields& f) { fields(f, 10); }
  void fields(Fields& f, std::size_t most);
  [[nodiscard]] OrderMesh mesh() const;
};

/// Eyes one after another.
struct EyeStep {
  int how = 0;
  double x = 0, y = 0, z = 0;
  int shift = 0;  ///< a step is 2^-shift as large
  int ulps = 0;
  void fields(Fields& f);
};
std::vector<Eye> eyes_of(const std::vector<EyeStep>& steps, const OrderTree& tree);

/// Family 14: the fragments of each face have its area, and each of its points lies in one of them.
struct PartitionCase {
  MeshCase mesh;
  void fields(Fields& f) { mesh.fields(f); }
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Translucent panes and bodies through each other.
struct GlassCase {
  struct Piece {
    bool pane = true;
    SolidCase solid;
    void fields(Fields& f);
  };
  std::vector<Piece> pieces;
  ViewCase view;
  void fields(Fields& f);
  [[nodiscard]] SceneFrame frame() const;
};

/// Family 14: on the screen a cut face has each pixel once, with the depth and colour that it has uncut.
struct CutFacesCase {
  bool smooth = false;
  int sub_bits = kMostSubBits;
  GlassCase glass;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 14: the line where a plane cuts another on the picture, against the one in rational numbers.
struct CutLineCase {
  int manner = 0;
  int width = 64, height = 48;
  int thin = 8;  ///< the node's face, or its distance from the other's plane, is 10^-thin
  MeshCase::Face face, node;
  ViewCase view;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 35: all ways give one order after every step of an eye.
struct WaysCase {
  MeshCase mesh;
  std::vector<EyeStep> steps;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 36: eyes on planes of nodes: all ways give one order, and rays meet none in the wrong order.
struct OnPlanesCase {
  MeshCase mesh;
  std::vector<EyeStep> steps;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 37: coplanar and nearly coplanar faces: the build ends within its bound, and its order is right.
struct FlatMeshCase {
  MeshCase mesh;
  std::vector<EyeStep> steps;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 38: exact rays meet no two fragments in the wrong order.
struct RaysCase {
  MeshCase mesh;
  std::vector<EyeStep> steps;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 38: layers at every pixel are those that a ray meets.
struct LayerRaysCase {
  int sub_bits = kMostSubBits;
  GlassCase glass;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

void add_order_families(Families& to);

}  // namespace kage::verif
