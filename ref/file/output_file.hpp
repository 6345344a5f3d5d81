// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <ostream>
#include <string>

namespace kage {

class TempFiles;

/// A file that is being written. An error of any write, of flushing, of fsync() or of closing is thrown as Error,
/// "NAME: cannot be written: No space left on device". A file that was not closed by close() is not whole.
///
/// A stream like any other otherwise: text by <<, bytes by write(), and seekp() to write over what is there.
class OutputFile : public std::ostream {
 public:
  /// Makes or empties the file `path`; `name` is what messages call it.
  OutputFile(const std::filesystem::path& path, const std::string& name);
  /// A file that gets the name `target` with the others of `files`.
  OutputFile(TempFiles& files, const std::filesystem::path& target);
  ~OutputFile() override;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// A file that has no name, in the folder for temporary files.
  static std::unique_ptr<OutputFile> unnamed(const std::string& name);

  /// Writes the content of `file` behind what is there.
  void copy(const std::filesystem::path& file);

  /// Hands all that was written on to the open file `to`, which need not know positions, and empties this one. Throws
  /// Error that names `to_name` if that cannot be written.
  void move_to(int to, const std::string& to_name);

  /// All is written: the bytes are on the disk now.
  void close();

 private:
  class Buffer;
  explicit OutputFile(std::unique_ptr<Buffer> buffer);
  std::unique_ptr<Buffer> buffer_;
};

}  // namespace kage
