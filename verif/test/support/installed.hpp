// SPDX-License-Identifier: Apache-2.0
//
// Meshes of Debian packages, which tools/deps installs.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "test/support/catch.hpp"

namespace kage::verif {

/// Whether a file is there. Missing is a failure, unless KAGE_WITHOUT_MESHES is set (docs/building.md).
inline bool present(const std::filesystem::path& path) {
  if (std::filesystem::exists(path)) return true;
  CAPTURE(path.string());
  if (std::getenv("KAGE_WITHOUT_MESHES") == nullptr)
    FAIL_CHECK("not installed: tools/deps test");
  else
    WARN("not installed, not tested: " << path.string());
  return false;
}

/// A mesh of the package glmark2-data.
inline std::string glmark2(const std::string& file) { return "/usr/share/glmark2/models/" + file; }

/// The meshes of the package libcgal-demo, below data/meshes.
inline constexpr const char* kCgalMeshes = "/usr/share/doc/libcgal-demo/data.tar.gz";

}  // namespace kage::verif
