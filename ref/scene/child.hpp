// SPDX-License-Identifier: Apache-2.0
//
// Import runs in a child process, because no reader of forty formats survives every file: Assimp crashes, hangs or eats
// all memory on some. The child is forked, not executed anew: a library has no program of its own that it could
// execute. It does nothing but read the file and write the scene into a pipe, and leaves by _exit. glibc keeps malloc
// and stdio usable after fork() in a program with threads; should another thread hold some other lock at that moment,
// the child would wait for ever. So a child that neither works nor writes for a second is ended, and another is forked.
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
  std::int64_t mib = 4096;  ///< of memory beyond what the process has already, and of the scene's size

  /// From $KAGE_IMPORT_SECONDS and $KAGE_IMPORT_MIB where set. Throws Error if one is not a number above 0.
  static ImportLimits from_environment();
};

/// import_file in a child process. Its death is an Error, as is a file that is missing, empty, unreadable or no file.
/// `wait` is called several times a second meanwhile; what it throws ends the child and is thrown on.
RawScene import_in_child(const std::filesystem::path& path, const std::string& name, bool allow_outside = false,
                         const std::function<void()>& wait = {});

/// Run `work` in a child process and return what it returned; what it threw as Error is thrown here. Any other end is
/// an Error that names `name` and the cause.
std::vector<std::uint8_t> run_in_child(const std::string& name, const ImportLimits& limits,
                                       const std::function<std::vector<std::uint8_t>()>& work,
                                       const std::function<void()>& wait = {});

}  // namespace kage::scene
