// SPDX-License-Identifier: Apache-2.0
//
// An importer's result: the file's data, not yet welded, transformed or animated. It crosses the pipe from the import
// process (wire.hpp). Angles, units and handedness as in kage/scene.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kage/scene.hpp"
#include "transform.hpp"

namespace kage::scene {

/// How far a morph target moves each vertex and its normal at weight 1.
struct RawTarget {
  std::vector<float> positions;  ///< x, y, z of each vertex, or none
  std::vector<float> normals;    ///< as many, or none
};

/// Corners that share one material. Attributes lie in the order of the file's vertices.
struct RawPrimitive {
  glm::dvec3 color{1, 1, 1};           ///< base or diffuse colour
  double alpha = 1;                    ///< of the material, 0 .. 1; below 1 it is translucent
  bool unlit = false;                  ///< its colour is shown as it is, whatever light or shadow falls on it
  bool double_sided = false;           ///< both sides of its faces are meant to be seen
  std::vector<float> positions;        ///< x, y, z of each vertex
  std::vector<float> normals;          ///< as many, or none
  std::vector<float> colors;           ///< red, green, blue of each vertex, or none
  std::vector<std::uint32_t> corners;  ///< three vertices for each triangle
  std::vector<std::uint32_t>
      faces;                     ///< for each triangle the file's face it was cut from, counted within the primitive
  std::uint32_t face_count = 0;  ///< of the file, lines and points not counted
  std::vector<std::uint32_t> joints{};  ///< that move each vertex, as many for each, into those of a skin; or none
  std::vector<float> weights{};         ///< of each of these; their sum may be any
  std::vector<RawTarget> targets{};     ///< as many in all primitives of a mesh

  [[nodiscard]] std::size_t vertex_count() const { return positions.size() / 3; }
  [[nodiscard]] std::size_t triangle_count() const { return faces.size(); }
};

/// The mesh of one node: primitives that are welded to one object.
struct RawMesh {
  std::string name;
  std::vector<RawPrimitive> primitives;
};

/// Nodes that move the vertices of a mesh.
struct RawSkin {
  std::vector<std::uint32_t> joints;  ///< nodes
  std::vector<Affine> inverse;        ///< for each, from the mesh's space to the joint's own
};

/// A node of the hierarchy. Parents come before their children.
struct RawNode {
  std::string name;
  std::int32_t parent = -1;
  std::int32_t mesh = -1;
  std::int32_t skin = -1;         ///< it, not the node, places the mesh
  std::vector<double> weights{};  ///< of the mesh's morph targets
  bool fixed = true;              ///< the map is `matrix`; otherwise it is composed of translation, rotation and scale
  Affine matrix;
  glm::dvec3 translation{0, 0, 0};
  Quaternion rotation;
  glm::dvec3 scale{1, 1, 1};
};

enum class RawPath : std::uint8_t { kTranslation, kRotation, kScale, kWeights };
enum class RawInterpolation : std::uint8_t { kLinear, kStep, kCubic };

/// Keys of one property of one node. Times rise strictly.
struct RawTrack {
  std::uint32_t node = 0;
  RawPath path = RawPath::kTranslation;
  RawInterpolation interpolation = RawInterpolation::kLinear;
  std::vector<double> times;
  std::vector<double> values;  ///< 3 a key, 4 (x, y, z, w) for rotations; kCubic: in-tangent, value, out-tangent
  std::uint32_t targets = 0;   ///< kWeights: values a key

  [[nodiscard]] std::size_t width() const {
    return path == RawPath::kWeights ? targets : path == RawPath::kRotation ? 4 : 3;
  }
};

/// A camera in the frame of its node.
struct RawCamera {
  std::uint32_t node = 0;
  glm::dvec3 eye{0, 0, 0};
  glm::dvec3 forward{0, 0, -1};
  glm::dvec3 up{0, 1, 0};
  bool perspective = true;
  double half_height = 0.5;  ///< as kage::Camera
  double near = 0;           ///< 0: not given
  double far = 0;            ///< 0: not given
  double aspect = 0;         ///< width over height; 0: not given
};

/// A light in the frame of its node; `color` times intensity is the file's own.
struct RawLight {
  std::uint32_t node = 0;
  Light light{{true, {0, 0, -1}, {0, 0, 0}}};
};

struct RawScene {
  std::vector<RawMesh> meshes;
  std::vector<RawSkin> skins;
  std::vector<RawNode> nodes;
  std::vector<RawTrack> tracks;
  double start_time = 0;  ///< of the animation; its end is the last key
  std::optional<RawCamera> camera;
  std::vector<RawLight> lights;  ///< none is black; at most kMaxLights
  std::uint32_t frames = 0;      ///< as the file asks (extras.kage.frames); 0: it does not
  SceneContents contents;
  std::vector<std::string> notes;
  std::vector<std::string> files;  ///< that it names and that are there, from the root
};

}  // namespace kage::scene
