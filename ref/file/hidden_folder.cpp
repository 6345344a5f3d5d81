// SPDX-License-Identifier: Apache-2.0
#include "file/hidden_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <system_error>

namespace kage {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockName = ".gitignore";
constexpr std::string_view kPrefix = ".kage-";

/// The text of the lock's file: for git, that nothing here is to be added; for a sweep, that the folder is one of
/// these.
constexpr std::string_view kMark = "*\n# files that kage has not finished\n";

int open_lock(const fs::path& folder, int flags) {
  return open((folder / kLockName).c_str(), flags | O_RDWR | O_NOFOLLOW | O_CLOEXEC, 0666);
}

/// Takes the lock. 0: it is taken. EWOULDBLOCK: a live process has it. ESTALE: its file has been removed meanwhile.
/// Another error: the file system knows no locks.
int take(int lock) {
  struct stat st {};
  if (flock(lock, LOCK_EX | LOCK_NB) != 0) return errno;
  return fstat(lock, &st) != 0 || st.st_nlink == 0 ? ESTALE : 0;
}

/// Removes a folder whose lock is held. The lock's file goes last, so that a removal that is cut off can be repeated.
void remove_locked(const fs::path& folder) {
  std::error_code ec;
  fs::directory_iterator entries(folder, ec);
  for (; !ec && entries != fs::directory_iterator(); entries.increment(ec)) {
    std::error_code ignored;
    if (entries->path().filename() != kLockName) fs::remove_all(entries->path(), ignored);
  }
  (void)unlink((folder / kLockName).c_str());
  (void)rmdir(folder.c_str());
}

/// Whether the folder whose lock is held was made here: by the mark, or, where its process died before that was
/// written, because there is nothing in it but an empty lock. A person may have a folder of such a name too.
bool is_ours(int lock, const fs::path& folder) {
  std::array<char, kMark.size() + 1> text{};
  const ssize_t size = pread(lock, text.data(), text.size(), 0);
  if (size < 0) return false;
  if (size > 0) return std::string_view(text.data(), static_cast<std::size_t>(size)) == kMark;
  std::error_code ec;
  const auto entries = std::distance(fs::directory_iterator(folder, ec), fs::directory_iterator());
  return !ec && entries == 1;
}

bool write_mark(int lock) { return write(lock, kMark.data(), kMark.size()) == static_cast<ssize_t>(kMark.size()); }

/// Makes the lock of `folder`, taken and with its mark, in one step: its file gets its name last. So a process that is
/// killed leaves an empty folder or one that git ignores. Returns the lock.
/// Returns -1 where this file system or machine has no files without names.
/// Returns -2 with errno set where the folder is gone, since a sweep found it empty, or the disk is full.
int make_lock_at_once(const fs::path& folder) {
  const int lock = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (lock < 0) return -1;
  int result = -1;
  if (flock(lock, LOCK_EX | LOCK_NB) == 0) {
    const std::string self = fmt::format("/proc/self/fd/{}", lock);
    if (!write_mark(lock))
      result = -2;
    else if (linkat(AT_FDCWD, self.c_str(), AT_FDCWD, (folder / kLockName).c_str(), AT_SYMLINK_FOLLOW) == 0)
      return lock;
    else if (access(folder.c_str(), F_OK) != 0)
      result = -2;
  }
  const int error = errno;
  (void)close(lock);
  errno = error;
  return result;
}

/// Makes the folder `path` with its lock; -1 with errno set if it cannot. EEXIST: the name is taken.
int make(const fs::path& path) {
  if (mkdir(path.c_str(), 0700) != 0) return -1;
  int lock = make_lock_at_once(path);
  if (lock >= 0) return lock;
  int error = errno;
  if (lock == -1) {
    lock = open_lock(path, O_CREAT | O_EXCL);
    error = lock >= 0 ? take(lock) : errno;
  }
  // Another process, which sweeps, has found the folder before it was locked: that process removes it.
  const bool swept = error == EWOULDBLOCK || error == ESTALE || error == ENOENT;
  // A file system without locks, as some that reach over a network: the folder serves without one.
  if (lock >= 0 && !swept) error = write_mark(lock) ? 0 : errno;
  if (lock >= 0 && error == 0) return lock;
  if (!swept) remove_locked(path);
  if (lock >= 0) (void)close(lock);
  errno = swept ? EEXIST : error;
  return -1;
}

}  // namespace

HiddenFolder::HiddenFolder(const fs::path& parent) {
  sweep(parent);
  // The number may be taken: by a second folder of this process, or by a process of another container.
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries && lock_ < 0; ++i) {
    path_ = parent / (i == 0 ? fmt::format("{}{}", kPrefix, getpid()) : fmt::format("{}{}-{}", kPrefix, getpid(), i));
    lock_ = make(path_);
    if (lock_ < 0 && errno != EEXIST) break;
  }
  if (lock_ < 0) throw std::system_error(errno, std::generic_category());
}

HiddenFolder::~HiddenFolder() {
  remove_locked(path_);
  (void)close(lock_);
}

std::shared_ptr<HiddenFolder> HiddenFolder::in(const fs::path& parent) {
  static std::mutex mutex;
  static std::map<fs::path, std::weak_ptr<HiddenFolder>> all;
  const std::lock_guard lock(mutex);
  std::erase_if(all, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<HiddenFolder>& known = all[parent];
  std::shared_ptr<HiddenFolder> folder = known.lock();
  if (!folder) {
    folder = std::make_shared<HiddenFolder>(parent);
    known = folder;
  }
  return folder;
}

fs::path HiddenFolder::new_name(const fs::path& extension) const {
  static std::atomic<unsigned> count{0};
  fs::path name = path_ / std::to_string(count++);
  name += extension;
  return name;
}

void HiddenFolder::sweep(const fs::path& parent) {
  std::error_code ec;
  fs::directory_iterator entries(parent.empty() ? fs::path(".") : parent, ec);
  for (; !ec && entries != fs::directory_iterator(); entries.increment(ec)) {
    const fs::path& folder = entries->path();
    struct stat st {};
    if (!is_name(folder.filename().string()) || lstat(folder.c_str(), &st) != 0 || !S_ISDIR(st.st_mode) ||
        st.st_uid != geteuid())
      continue;
    if (const int lock = open_lock(folder, 0); lock >= 0) {
      if (take(lock) == 0 && is_ours(lock, folder)) remove_locked(folder);
      (void)close(lock);
    } else if (errno == ENOENT) {
      (void)rmdir(folder.c_str());  // its process died before it had a lock: the folder is empty
    }
  }
}

bool HiddenFolder::is_name(std::string_view name) {
  if (!name.starts_with(kPrefix)) return false;
  name.remove_prefix(kPrefix.size());
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return !name.empty() && digit(name.front()) && digit(name.back()) &&
         std::all_of(name.begin(), name.end(), [&](char c) { return digit(c) || c == '-'; });
}

}  // namespace kage
