// SPDX-License-Identifier: Apache-2.0
#include "plugin/plugin.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <latch>
#include <memory>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "kage/error.hpp"
#include "kage/paths.hpp"

// All are set by CMake.
#ifndef KAGE_PLUGIN_VERSION
#define KAGE_PLUGIN_VERSION ""
#endif
#ifndef KAGE_BUILD_PLUGIN_DIR
#define KAGE_BUILD_PLUGIN_DIR ""
#endif
#ifndef KAGE_INSTALL_PLUGIN_DIR
#define KAGE_INSTALL_PLUGIN_DIR ""
#endif
#ifndef KAGE_INSTALL_DATA_DIR
#define KAGE_INSTALL_DATA_DIR ""
#endif

namespace kage {
namespace {

namespace fs = std::filesystem;

/// Whether nobody but this user, root, and who owns the program could have put the file there: a folder that a build
/// had may be somebody else's by now.
bool is_ours(const fs::path& file) {
  struct stat own {};
  const bool known = stat("/proc/self/exe", &own) == 0;
  for (const fs::path& path : {file, file.parent_path()}) {
    struct stat s {};
    if (stat(path.c_str(), &s) != 0 || (s.st_mode & S_IWOTH) != 0) return false;
    if (s.st_uid != geteuid() && s.st_uid != 0 && !(known && s.st_uid == own.st_uid)) return false;
  }
  return true;
}

/// Where an installation's plugins are that was moved, by where its data are now: PREFIX/share/kage.
fs::path beside_data() {
  const fs::path installed = KAGE_INSTALL_PLUGIN_DIR;  // PREFIX/lib/kage, or PREFIX/lib/TRIPLET/kage
  const fs::path data = KAGE_INSTALL_DATA_DIR;
  if (installed.empty() || data.empty()) return {};
  return (data_directory() / installed.lexically_relative(data)).lexically_normal();
}

/// The first of kage's own folders that has the file; empty if none has.
fs::path in_own_folders(const std::string& file) {
  for (const fs::path& folder : {fs::path(KAGE_BUILD_PLUGIN_DIR), fs::path(KAGE_INSTALL_PLUGIN_DIR), beside_data()})
    if (!folder.empty() && is_ours(folder / file)) return folder / file;
  return {};
}

fs::path named_folder() {
  const char* const named = std::getenv("KAGE_PLUGIN_DIR");
  return named == nullptr ? fs::path() : fs::path(named);
}

[[noreturn]] void refuse_missing(const std::string& file, const std::string& what_for) {
  throw Error(fmt::format("{}: not in {} or {}, and {}: build it, or set KAGE_PLUGIN_DIR", file, KAGE_BUILD_PLUGIN_DIR,
                          KAGE_INSTALL_PLUGIN_DIR, what_for));
}

fs::path find(const std::string& file, const std::string& what_for) {
  if (const fs::path named = named_folder(); !named.empty()) return named / file;
  const fs::path own = in_own_folders(file);
  if (own.empty()) refuse_missing(file, what_for);
  return own;
}

void check_room(const fs::path& path, const std::string& what_for, std::size_t room) {
  void* const free = mmap(nullptr, room, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (free == MAP_FAILED)
    throw Error(fmt::format("{}: takes {} MiB of memory (ulimit -v), and {}", path.string(), room >> 20, what_for));
  munmap(free, room);
}

/// Libraries start threads as they are opened, and each would have an arena of malloc()'s. That asks for 128 MiB of
/// address space at once, a moment in which the next library may not be mapped. Under a limit (ulimit -v) all share
/// one.
void share_arena() {
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) mallopt(M_ARENA_MAX, 1);
}

/// Libraries that start threads as they are opened may wait for ever where one cannot be started, and hear no signal;
/// so as many are tried before.
void check_threads(const fs::path& path, const std::string& what_for) {
  // A pool of four, one of as many as there are processors; measured: 5 with two processors.
  const unsigned count = 4 + std::max(2U, std::thread::hardware_concurrency());
  std::latch tried(1);
  std::vector<std::jthread> threads;
  const std::unique_ptr<std::latch, void (*)(std::latch*)> end(&tried, [](std::latch* l) { l->count_down(); });
  try {
    for (unsigned i = 0; i < count; ++i) threads.emplace_back([&tried] { tried.wait(); });
  } catch (const std::system_error& e) {
    throw Error(
        fmt::format("{}: starts up to {} threads, and there is no room for them ({}; ulimit -u, pids.max), and {}",
                    path.string(), count, e.code().message(), what_for));
  }
}

}  // namespace

const char* const kPluginVersion = KAGE_PLUGIN_VERSION;

fs::path helper_file(const std::string& file, const std::string& what_for) {
  std::error_code ec;
  const fs::path named = named_folder();
  if (!named.empty() && fs::exists(named / file, ec)) return named / file;
  const fs::path own = in_own_folders(file);
  if (own.empty()) refuse_missing(file, what_for);
  return own;
}

bool has_plugin(const std::string& name) {
  const std::string file = "lib" + name + ".so";
  std::error_code ec;
  const fs::path named = named_folder();
  return named.empty() ? !in_own_folders(file).empty() : fs::exists(named / file, ec);
}

const PluginHead* open_plugin(const std::string& name, const std::string& what_for, std::size_t room) {
  const fs::path path = find("lib" + name + ".so", what_for);
  if (room > 0) {
    share_arena();
    check_room(path, what_for, room);
    check_threads(path, what_for);
  }
  // It may bind symbols of large libraries, so each only when it is called.
  void* const handle = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (handle == nullptr) {
    const char* const cause = dlerror();
    const std::string text = cause == nullptr ? "no cause was given" : cause;
    const std::string prefix = path.string() + ": ";
    throw Error(fmt::format("{}: {}, and {}{}", path.string(),
                            text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text, what_for,
                            named_folder().empty() ? "" : "; KAGE_PLUGIN_DIR names the folder"));
  }
  using Function = const PluginHead* (*)();
  const auto function = reinterpret_cast<Function>(dlsym(handle, (name + "_table").c_str()));
  const PluginHead* const head = function == nullptr ? nullptr : function();
  if (head == nullptr || std::string_view(head->version) != KAGE_PLUGIN_VERSION)
    throw Error(fmt::format("{}: is not of kage {}, and {}", path.string(), KAGE_PLUGIN_VERSION, what_for));
  return head;
}

}  // namespace kage
