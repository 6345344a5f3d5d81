// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <assimp/scene.h>

#include <vector>

#include "scene/plugin/assimp_view.hpp"
#include "scene/raw.hpp"

namespace kage::scene::mesh_plugin {

/// Appends the tracks of Assimp's first animation to the scene's. `nodes`: Assimp's, by their numbers in the scene.
void read_animation(const aiScene& in, const NodeNames& node_of, const std::vector<const aiNode*>& nodes,
                    RawScene& scene);

}  // namespace kage::scene::mesh_plugin
