// SPDX-License-Identifier: Apache-2.0
//
// Reading and writing by descriptors: no error is passed over.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace kage {

/// Throws Error "NAME: cannot be written: CAUSE".
[[noreturn]] void fail_write(const std::string& name, int error);

/// Writes all bytes, or throws Error that names `name` and the cause. Where the reader of a pipe lets it wait, a signal
/// that the program handles is such a cause; on a disk it is none.
void write_all(int fd, const char* data, std::size_t size, const std::string& name);

/// Has the file `path`, which another writer has made, on the disk. Throws Error that names `name`: some file systems
/// tell only now that there was no room.
void sync_file(const std::filesystem::path& path, const std::string& name);

/// A file that is read, from its beginning.
class ReadOnly {
 public:
  /// Throws Error that names the file, as `name` where that is given, and the cause if it cannot be opened.
  explicit ReadOnly(const std::filesystem::path& file, const std::string& name = {});
  ~ReadOnly();
  ReadOnly(const ReadOnly&) = delete;
  ReadOnly& operator=(const ReadOnly&) = delete;

  /// The next bytes, `size` at most; 0 at the end. Throws Error that names the file and the cause.
  std::size_t read(char* data, std::size_t size) const;

 private:
  std::string name_;
  int fd_;
};

/// A descriptor, to be closed by the caller, for reading and writing a file that has no name and goes with it; -1 with
/// errno set if there can be none. It lies in $TMPDIR or /tmp.
int unnamed_file();

}  // namespace kage
