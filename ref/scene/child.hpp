// SPDX-License-Identifier: Apache-2.0
//
// Import runs in a process of its own, because no reader of forty formats survives every file: Assimp crashes, hangs or
// eats all memory on some. The process is kage-import, a program that is installed beside the plugins, and started by
// posix_spawn: a program with threads, which may hold any lock, can load a scene at any time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "raw.hpp"

namespace kage::scene {

struct ImportLimits {
  int seconds = 20;         ///< of processor time, and of waiting
  std::int64_t mib = 4096;  ///< of memory beyond what the process begins with, and of the scene's size

  /// From $KAGE_IMPORT_SECONDS and $KAGE_IMPORT_MIB where set. Throws Error if one is not a number above 0.
  static ImportLimits from_environment();
};

/// The program's name.
inline constexpr const char* kImporter = "kage-import";

/// import_file in a process of its own. Its death is an Error, as is a file that is missing, empty, unreadable or no
/// file. `wait` is called several times a second meanwhile; what it throws ends the process and is thrown on.
RawScene import_in_child(const std::filesystem::path& path, const std::string& name, bool allow_outside = false,
                         const std::function<void()>& wait = {});

/// Starts a program, its file and its arguments, that calls answer() (answer.hpp), and returns what its work returned;
/// what that threw as Error is thrown here. Any other end is an Error that names `name` and the cause.
std::vector<std::uint8_t> answer_of(const std::vector<std::string>& command, const std::string& name,
                                    const ImportLimits& limits, const std::function<void()>& wait = {});

}  // namespace kage::scene
