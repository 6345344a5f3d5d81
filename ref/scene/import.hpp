// SPDX-License-Identifier: Apache-2.0
//
// From a file to a RawScene. Both readers run in the import child; both throw Error.
#pragma once

#include <filesystem>
#include <string>

#include "gltf_file.hpp"
#include "raw.hpp"

namespace kage::scene {

/// Read with kage's own glTF 2.0 reader where it is one, else with Assimp, and check what came out: finite numbers,
/// indices in range, at least one face. `name` is how messages call the file. `allow_outside`: the files that it names
/// may lie anywhere (side_files.hpp).
RawScene import_file(const std::filesystem::path& path, const std::string& name, bool allow_outside = false);

RawScene import_gltf(GltfFile file);
RawScene import_assimp(const std::filesystem::path& path, const std::string& name, bool allow_outside = false);

/// The checks that close import_file.
void check(const RawScene& scene, const std::string& name);

}  // namespace kage::scene
