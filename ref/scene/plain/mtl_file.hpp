// SPDX-License-Identifier: Apache-2.0
//
// A material library (MTL). No word of it keeps a scene from being drawn: what is not understood is ignored, and said
// with file and line.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/plain/plain_mesh.hpp"

namespace kage::scene {

/// A material: the part of it that is drawn, and words on the rest.
struct MtlMaterial {
  glm::dvec3 color{kGrey};            ///< Kd, or Ke over a black Kd
  double alpha = 1;                   ///< by d, or Tr where there is no d
  bool unlit = false;                 ///< `color` is Ke
  bool emits = false;                 ///< Ke over a Kd that is not black
  bool glossy = false;                ///< by Ks, illum from 3 on, or the words of physically based materials
  bool unshaded = false;              ///< illum 0
  bool invisible = false;             ///< d 0, which several programs write and do not mean
  bool bright = false;                ///< a channel of `color` was above 1
  bool dark = false;                  ///< one was below 0
  bool dense = false;                 ///< its opacity was above 1
  std::vector<std::string> textures;  ///< what the statements say, options and names of files
};

using MtlMaterials = std::map<std::string, MtlMaterial, std::less<>>;

/// Adds the materials of a library's text to those that were there before, which stay where names are the same.
/// `file`: how messages call the library.
void read_mtl(std::string_view text, const std::string& file, MtlMaterials& materials, std::vector<std::string>& notes);

}  // namespace kage::scene
