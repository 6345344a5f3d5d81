// SPDX-License-Identifier: Apache-2.0
//
// Extensions and keys of a glTF file that kage's reader does not know.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "gltf_json.hpp"

namespace kage::scene {

/// Refuse a file that says it cannot be drawn without an extension that kage does not draw. glTF 2.0 demands that.
void refuse_required(const GltfJson& file);

/// A sentence on extensions that are not drawn, and one on keys that nobody has read, once all is read. `told`:
/// extensions of which other sentences speak.
void note_unknown(const GltfJson& file, const std::set<std::string>& told, std::vector<std::string>& notes);

}  // namespace kage::scene
