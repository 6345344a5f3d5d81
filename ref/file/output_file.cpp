// SPDX-License-Identifier: Apache-2.0
#include "file/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <streambuf>
#include <vector>

#include "file/plain_io.hpp"
#include "file/temp_file.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16;

}  // namespace

/// Keeps a buffer's worth of bytes back, and throws whatever goes wrong. After an error it writes nothing more.
class OutputFile::Buffer : public std::streambuf {
 public:
  Buffer(int fd, std::string name) : fd_(fd), name_(std::move(name)), bytes_(kBufferBytes) {
    if (fd_ < 0) fail_write(name_, errno);
    setp(bytes_.data(), bytes_.data() + bytes_.size());
  }
  ~Buffer() override {
    if (fd_ >= 0) (void)::close(fd_);
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  void flush() {
    const auto size = static_cast<std::size_t>(pptr() - pbase());
    setp(bytes_.data(), bytes_.data() + bytes_.size());
    write_all(fd_, bytes_.data(), size, name_);
  }

  void copy(const std::filesystem::path& file) {
    flush();
    const ReadOnly from(file);
    while (const std::size_t n = from.read(bytes_.data(), bytes_.size())) write_all(fd_, bytes_.data(), n, name_);
  }

  void move_to(int to, const std::string& to_name) {
    flush();
    if (::lseek(fd_, 0, SEEK_SET) != 0) fail_write(name_, errno);
    for (;;) {
      const ssize_t n = ::read(fd_, bytes_.data(), bytes_.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) throw Error(fmt::format("{}: cannot be read back: {}", name_, std::strerror(errno)));
      if (n == 0) break;
      write_all(to, bytes_.data(), static_cast<std::size_t>(n), to_name);
    }
    if (::ftruncate(fd_, 0) != 0 || ::lseek(fd_, 0, SEEK_SET) != 0) fail_write(name_, errno);
  }

  void close() {
    flush();
    // A file that can only be written, as a pipe, has no disk to wait for.
    if (::fsync(fd_) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EROFS) fail_write(name_, errno);
    const int fd = fd_;
    fd_ = -1;
    if (::close(fd) != 0 && errno != EINTR) fail_write(name_, errno);
  }

 protected:
  int_type overflow(int_type c) override {
    flush();
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    *pptr() = traits_type::to_char_type(c);
    pbump(1);
    return c;
  }
  int sync() override {
    flush();
    return 0;
  }
  std::streamsize xsputn(const char* data, std::streamsize size) override {
    if (size > epptr() - pptr()) flush();
    // Only an empty buffer may be passed by: what is in it comes first.
    if (size >= static_cast<std::streamsize>(bytes_.size())) {
      write_all(fd_, data, static_cast<std::size_t>(size), name_);
      return size;
    }
    if (size == 0) return 0;  // `data` may be no address then
    std::memcpy(pptr(), data, static_cast<std::size_t>(size));
    pbump(static_cast<int>(size));
    return size;
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir way, std::ios_base::openmode) override {
    flush();
    const int whence = way == std::ios_base::beg ? SEEK_SET : way == std::ios_base::cur ? SEEK_CUR : SEEK_END;
    const off_t at = ::lseek(fd_, offset, whence);
    if (at < 0) fail_write(name_, errno);
    return at;
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode which) override {
    return seekoff(position, std::ios_base::beg, which);
  }

 private:
  int fd_;
  std::string name_;
  std::vector<char> bytes_;
};

OutputFile::OutputFile(std::unique_ptr<Buffer> buffer) : std::ostream(nullptr), buffer_(std::move(buffer)) {
  rdbuf(buffer_.get());
  exceptions(std::ios::badbit);  // hands on what the buffer throws
}

OutputFile::OutputFile(const std::filesystem::path& path, const std::string& name)
    : OutputFile(std::make_unique<Buffer>(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666), name)) {
}

OutputFile::OutputFile(TempFiles& files, const std::filesystem::path& target)
    : OutputFile(files.add(target), target.string()) {}

OutputFile::~OutputFile() = default;

std::unique_ptr<OutputFile> OutputFile::unnamed(const std::string& name) {
  return std::unique_ptr<OutputFile>(new OutputFile(std::make_unique<Buffer>(unnamed_file(), name)));
}

void OutputFile::copy(const std::filesystem::path& file) { buffer_->copy(file); }

void OutputFile::move_to(int to, const std::string& to_name) { buffer_->move_to(to, to_name); }

void OutputFile::close() { buffer_->close(); }

}  // namespace kage
