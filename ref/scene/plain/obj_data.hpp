// SPDX-License-Identifier: Apache-2.0
//
// An OBJ file's contents: read by obj_file.cpp, made a scene of by obj_scene.cpp.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "scene/plain/obj_libraries.hpp"
#include "scene/plain/plain_mesh.hpp"
#include "scene/raw.hpp"

namespace kage::scene {

/// No normal, no material.
inline constexpr std::uint32_t kObjNone = std::numeric_limits<std::uint32_t>::max();

/// Numbers of names, from 0, in the order of their coming.
class ObjNames {
 public:
  std::uint32_t number(const std::string& name) {
    const auto [at, fresh] = number_.try_emplace(name, static_cast<std::uint32_t>(all_.size()));
    if (fresh) all_.push_back(name);
    return at->second;
  }
  [[nodiscard]] const std::vector<std::string>& all() const { return all_; }

 private:
  std::map<std::string, std::uint32_t> number_;
  std::vector<std::string> all_;
};

struct ObjCorner {
  std::uint32_t vertex;  ///< one that is there
  std::uint32_t normal;  ///< kObjNone, or one that may not be there
};

struct ObjFace {
  std::uint32_t end = 0;  ///< behind its last corner, of three at least
  std::uint32_t object = 0;
  std::uint32_t material = kObjNone;
  bool has_normals = false;  ///< at a corner
};

struct ObjData {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> colors;  ///< of the vertices up to the last that has one; not a number: it has none
  std::vector<ObjCorner> corners;
  std::vector<ObjFace> faces;
  ObjNames objects;    ///< that have faces: the name that o gives, a line feed, that of g
  ObjNames materials;  ///< that usemtl names
};

/// Appends nodes, meshes and materials to the scene. Returns how many corners name a normal that is not there.
std::size_t build_obj(ObjData data, ObjLibraries& libraries, RawScene& scene, FaceCounts& counts);

}  // namespace kage::scene
