// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace kage {

/// A folder for a run's output, made with the folders above it. The destructor removes the made folders that are still
/// empty, so that a run that fails leaves nothing.
class OutFolder {
 public:
  /// Throws Error if the folder cannot be made or written to.
  explicit OutFolder(const std::filesystem::path& path);
  ~OutFolder();
  OutFolder(const OutFolder&) = delete;
  OutFolder& operator=(const OutFolder&) = delete;

 private:
  void remove();
  std::vector<std::filesystem::path> made_;  // the innermost first
};

}  // namespace kage
