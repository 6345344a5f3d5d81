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
/// temporary file is removed. It lies beside the target and has its extension. Or, the other way round, a file that is
/// to go: then there is no temp().
class TempFile {
 public:
  enum class Way { write, remove };
  explicit TempFile(std::filesystem::path target, Way way = Way::write);
  /// Removes the temporary file, and undoes place() if settle() did not follow.
  ~TempFile();
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;

  [[nodiscard]] const std::filesystem::path& temp() const { return temp_; }

  /// The file gets its name, or goes; what was there is kept aside, to be put back. Throws Error if it cannot.
  void place();
  /// What was there is needed no more.
  void settle();
  void commit() {
    place();
    settle();
  }

 private:
  void undo();

  std::filesystem::path target_;
  std::filesystem::path temp_;   // empty if there is nothing to write, or it has its name
  std::filesystem::path aside_;  // what had the target's name, if anything
  Way way_;
  bool placed_ = false;
};

/// Files of one run, which get their names together once all are written, or never: a run that fails half-way leaves
/// what was there before it.
class TempFiles {
 public:
  TempFiles() = default;
  ~TempFiles() { drop(); }
  TempFiles(const TempFiles&) = delete;
  TempFiles& operator=(const TempFiles&) = delete;

  /// A file more; returns where to write it.
  const std::filesystem::path& add(std::filesystem::path target) {
    return files_.emplace_back(std::make_unique<TempFile>(std::move(target)))->temp();
  }

  /// A file that is written already.
  void add(std::unique_ptr<TempFile> file) { files_.push_back(std::move(file)); }

  /// A file that is to go with the others' coming.
  void remove(std::filesystem::path target) {
    files_.push_back(std::make_unique<TempFile>(std::move(target), TempFile::Way::remove));
  }

  /// All get their names, or none: if one cannot, all are as they were, and Error is thrown. Until settle() follows,
  /// the end of this object puts back what was there: so that what can still fail comes in between.
  void place();
  void settle();
  void commit() {
    place();
    settle();
  }

 private:
  void drop();  // the last first, as they may stand on each other

  std::vector<std::unique_ptr<TempFile>> files_;
};

/// Opens a file to write to, which gets its name with the others of `files`. Throws Error if it cannot be written.
std::ofstream open_file(TempFiles& files, const std::string& path);

/// Writes a text file, which gets its name with the others of `files`. Throws Error if it cannot be written.
void write_text(TempFiles& files, const std::string& path, const std::string& text);

}  // namespace kage
