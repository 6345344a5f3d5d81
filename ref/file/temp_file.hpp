// SPDX-License-Identifier: Apache-2.0
//
// Files that appear under their names whole, and together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "file/hidden_folder.hpp"
#include "file/output_file.hpp"

namespace kage {

/// A file, whatever name it has. The number of one that was removed may be another's: so there is more than
/// that.
struct FileId {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint32_t mode = 0;
  std::int64_t bytes = 0;
  std::int64_t seconds = 0;  ///< of its last change
  std::int64_t nanoseconds = 0;
  bool operator==(const FileId&) const = default;
};

/// A file that appears under its name only when it is whole: write to temp(), close it, then commit(). Without commit()
/// it is removed and what had the name stays. Until then it lies in a HiddenFolder beside its target, with the target's
/// extension. A device or a pipe cannot be replaced by a file: it gets the bytes at commit(). Or, the other way round,
/// a file that is to go: then there is no temp().
class TempFile {
 public:
  enum class Way { write, remove };
  /// Throws Error that names `target`: its folder is not there or cannot be written to, or it is a folder, a socket or
  /// a file that the run reads (inputs.hpp).
  explicit TempFile(std::filesystem::path target, Way way = Way::write);
  /// Removes the temporary file, and undoes place() if settle() did not follow.
  ~TempFile();
  TempFile(const TempFile&) = delete;
  TempFile& operator=(const TempFile&) = delete;

  [[nodiscard]] const std::filesystem::path& temp() const { return temp_; }
  /// The name that messages call it by.
  [[nodiscard]] const std::filesystem::path& given() const { return given_; }
  /// The file that it comes to be, from the root: what a link leads to.
  [[nodiscard]] std::filesystem::path target() const;
  /// The name that was asked for, from the root.
  [[nodiscard]] const std::filesystem::path& name() const { return name_; }
  /// Whether the target is a device or a pipe. Bytes that it got cannot be taken back.
  [[nodiscard]] bool is_device() const { return device_; }

  /// The file gets its name, or goes; what was there is kept aside, to be put back. Throws Error if it cannot, as where
  /// the name is that of a folder, a link, a device or an input by now: nothing but another file is replaced or
  /// removed.
  void place();
  /// The file that was there is needed no more.
  void settle();
  void commit() {
    place();
    settle();
  }

 private:
  void write_device();
  void rename();
  void move_aside(bool link);
  void undo();

  std::filesystem::path given_;   // as messages call it
  std::filesystem::path name_;    // from the root
  std::filesystem::path target_;  // what a link leads to
  std::shared_ptr<HiddenFolder> folder_;
  std::filesystem::path temp_;   // empty if there is nothing to write, or it has its name
  std::filesystem::path aside_;  // what had the target's name, if anything
  std::optional<FileId> own_;    // of the file that got the target's name
  Way way_;
  bool device_ = false;
  bool placed_ = false;
};

/// Whether writing to `path` cannot replace it, but gives it the bytes: a pipe or a character device.
bool is_device(const std::filesystem::path& path);

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

  /// All files of `others` are of these now.
  void take(TempFiles& others);

  /// Where the file lies that is to be `target`: its unfinished name, or `target` itself if it is none of these.
  [[nodiscard]] std::filesystem::path now(const std::filesystem::path& target) const;

  /// All get their names, or none: if one cannot, or two are to have one name, all are as they were, and Error is
  /// thrown. Devices and pipes come
  /// last, as they keep what they got. Until settle() follows, the end of this object puts back what was there: so that
  /// what can still fail comes in between.
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

/// Writes a text file, which gets its name with the others of `files`. Throws Error if it cannot be written.
void write_text(TempFiles& files, const std::string& path, const std::string& text);

}  // namespace kage
