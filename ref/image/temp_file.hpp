// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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

/// Files of one run, which get their names together once all are written, or never: a run that fails half-way leaves
/// what was there before it.
class TempFiles {
 public:
  /// A file more; returns where to write it.
  const std::filesystem::path& add(std::filesystem::path target) {
    return files_.emplace_back(std::make_unique<TempFile>(std::move(target)))->temp();
  }

  /// A file that is written already.
  void add(std::unique_ptr<TempFile> file) { files_.push_back(std::move(file)); }

  void commit() {
    for (const auto& file : files_) file->commit();
    files_.clear();
  }

 private:
  std::vector<std::unique_ptr<TempFile>> files_;
};

/// Opens a file to write to, which gets its name with the others of `files`. Throws Error if it cannot be written.
std::ofstream open_file(TempFiles& files, const std::string& path);

/// Writes a text file, which gets its name with the others of `files`. Throws Error if it cannot be written.
void write_text(TempFiles& files, const std::string& path, const std::string& text);

}  // namespace kage
