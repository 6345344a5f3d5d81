// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/trust.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "kage/error.hpp"

namespace kage::cosim {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& cause, const std::string& cure) {
  throw Error(
      fmt::format("{}: {}, and RTL models and verdicts that are kept there are trusted: {}, or set XDG_CACHE_HOME to a "
                  "folder of your own",
                  path.string(), cause, cure));
}

void check_owner(const fs::path& path, const struct stat& status,
                 const char* cure = "remove it or make it yours (chown)") {
  if (status.st_uid != geteuid() && status.st_uid != 0)
    refuse(path, fmt::format("belongs to user {}, you are user {}", status.st_uid, geteuid()), cure);
}

/// The modes that let somebody else write to it.
void check_mode(const fs::path& path, const struct stat& status, mode_t forbidden) {
  const mode_t mode = status.st_mode & 07777U;
  if ((mode & forbidden) != 0)
    refuse(path, fmt::format("others may write to it (mode {:04o})", mode),
           fmt::format("see that all in it is yours, then chmod -R go-w {}", path.string()));
}

/// A folder on the way to the cache. Other people's entries in a folder with the sticky bit cannot be renamed.
void check_way(const fs::path& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) == 0 && S_ISLNK(status.st_mode)) check_owner(path, status);
  if (stat(path.c_str(), &status) != 0) return;  // it is not there yet
  check_owner(path, status, "make it yours (chown)");
  if ((status.st_mode & S_ISVTX) != 0) return;
  const bool own_group = status.st_gid == getegid() && status.st_gid == geteuid();
  check_mode(path, status, own_group ? S_IWOTH : S_IWGRP | S_IWOTH);
}

void check_way_to(const fs::path& path) {
  fs::path way;
  for (const fs::path& part : path) {
    way /= part;
    check_way(way);
  }
}

/// Makes what is missing of the way, for this user alone: whatever the umask is, the folder will do.
void make_folders(const fs::path& path) {
  fs::path way;
  for (const fs::path& part : path) {
    way /= part;
    struct stat status {};
    if (stat(way.c_str(), &status) == 0) continue;
    if (mkdir(way.c_str(), 0700) != 0 && errno != EEXIST)
      throw Error(fmt::format("{}: cannot be made: {}", way.string(), std::strerror(errno)));
  }
}

}  // namespace

fs::path own_folder(const fs::path& base, std::initializer_list<const char*> inner) {
  make_folders(base);
  check_way_to(fs::absolute(base).lexically_normal());
  check_way_to(fs::canonical(base));
  fs::path folder = base;
  for (const char* name : inner) {
    folder /= name;
    if (mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
      throw Error(fmt::format("{}: cannot be made: {}", folder.string(), std::strerror(errno)));
    struct stat status {};
    if (lstat(folder.c_str(), &status) == 0 && S_ISLNK(status.st_mode)) {
      check_owner(folder, status);
      if (stat(folder.c_str(), &status) == 0) check_way_to(fs::canonical(folder).parent_path());
    }
    if (stat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode))
      throw Error(fmt::format("{}: is no folder", folder.string()));
    check_owner(folder, status);
    check_mode(folder, status, S_IWGRP | S_IWOTH);
  }
  return folder;
}

fs::path cache_folder(const char* name) {
  const char* const xdg = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  if (xdg != nullptr && *xdg != '\0') return own_folder(xdg, {"kage", name});
  if (home != nullptr && *home != '\0') return own_folder(fs::path(home) / ".cache", {"kage", name});
  throw Error("neither XDG_CACHE_HOME nor HOME is set: there is no place for RTL models");
}

int open_own_file(const fs::path& file) {
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (fd < 0 && errno == ENOENT) return -1;
  if (fd < 0)
    throw Error(
        fmt::format("{}: cannot be read: {}", file.string(), errno == ELOOP ? "it is a link" : std::strerror(errno)));
  try {
    struct stat status {};
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) throw Error(fmt::format("{}: is no file", file.string()));
    check_owner(file, status);
    check_mode(file, status, S_IWGRP | S_IWOTH);
  } catch (...) {
    close(fd);
    throw;
  }
  return fd;
}

}  // namespace kage::cosim
