// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace kage {

/// A file that appears under its name only when it is whole: write to temp(), then commit(). Without commit() the
/// temporary file is removed. It lies beside the target and has its extension.
class TempFile {
 public:
  explicit TempFile(std::filesystem::path target);
  ~TempFile();
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;

  [[nodiscard]] const std::filesystem::path& temp() const { return temp_; }

  /// Throws Error if the file cannot get its name.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temp_;
};

}  // namespace kage
