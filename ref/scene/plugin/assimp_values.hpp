// SPDX-License-Identifier: Apache-2.0
// Assimp's values as kage's.
#pragma once

#include <assimp/types.h>

#include <glm/vec3.hpp>
#include <string>

#include "scene/transform.hpp"

namespace kage::scene::mesh_plugin {

inline glm::dvec3 vec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }
inline glm::dvec3 rgb(const aiColor3D& c) { return {c.r, c.g, c.b}; }
inline std::string text(const aiString& s) { return {s.C_Str()}; }
inline Affine affine(const aiMatrix4x4& m) {
  return {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}};
}

}  // namespace kage::scene::mesh_plugin
