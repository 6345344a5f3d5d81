// SPDX-License-Identifier: Apache-2.0
//
// From a file to a RawScene. All readers run in the import process; all throw Error.
#pragma once

#include <filesystem>
#include <string>

#include "gltf_file.hpp"
#include "raw.hpp"

namespace kage::scene {

/// Read with kage's own reader of the format where there is one, else with Assimp, and check what came out: finite
/// numbers, indices in range, at least one face. `name` is how messages call the file. `allow_outside`: the files that
/// it names may lie anywhere (side_files.hpp).
RawScene import_file(const std::filesystem::path& path, const std::string& name, bool allow_outside = false);

RawScene import_gltf(GltfFile file);
RawScene import_obj(const std::filesystem::path& path, const std::string& name, bool allow_outside = false);
RawScene import_ply(const std::filesystem::path& path, const std::string& name);
RawScene import_stl(const std::filesystem::path& path, const std::string& name);
RawScene import_off(const std::filesystem::path& path, const std::string& name);
RawScene import_assimp(const std::filesystem::path& path, const std::string& name, bool allow_outside = false);

/// The checks that close import_file.
void check(const RawScene& scene, const std::string& name);

}  // namespace kage::scene
