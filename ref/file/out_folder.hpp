// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace kage {

/// A folder for what a run writes, made with those above it. What was made and is empty in the end is removed again, so
/// that a run that fails leaves nothing.
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
