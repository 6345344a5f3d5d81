// SPDX-License-Identifier: Apache-2.0
//
// Meshes whose vertices move by themselves: by a skin's joints, by morph targets. Topology is that of the file's own
// positions; vertices and normals are computed anew for each frame.
#pragma once

#include <cstdint>
#include <vector>

#include "kage/scene.hpp"
#include "raw.hpp"
#include "topology.hpp"

namespace kage::scene {

/// Data that move the vertices of a mesh. A source is a vertex as the file has it, counted through all primitives.
struct Motion {
  std::size_t influences = 0;          ///< joints of each source
  std::vector<std::uint32_t> joints;   ///< into the skin's
  std::vector<float> weights;          ///< of the joints; where all are 0 the first joint counts
  std::vector<RawTarget> targets;      ///< of all sources
  std::vector<float> normals;          ///< of all sources, as in the file; 0 where there is none
  std::vector<std::uint32_t> sources;  ///< of each vertex of the mesh, one of those that lie there

  /// Where a normal for shading comes from.
  struct Normal {
    std::uint32_t number = 0;  ///< of a source, or, where it is the normal of a face, of a triangle
    bool of_face = false;
    bool negated = false;
  };
  std::vector<Normal> shading;  ///< of each of the mesh's

  /// Whether two sources that lie at one place stay together.
  [[nodiscard]] bool same(std::size_t a, std::size_t b) const;
};

/// The motion of a raw mesh: all members but `sources` and `shading`.
Motion motion_of(const RawMesh& raw);

/// A mesh in the world.
struct Moved {
  std::vector<glm::dvec3> vertices;
  std::vector<ShadingVertex> shading;
  bool mirrored = false;
};

struct Mesh;

/// `bones`: where each joint of the skin puts the mesh, or one map alone where there is no skin. `weights`: of the
/// morph targets.
Moved moved(const Mesh& mesh, const std::vector<Affine>& bones, const std::vector<double>& weights);

}  // namespace kage::scene
