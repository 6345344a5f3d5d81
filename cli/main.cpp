// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

#include "command.hpp"
#include "commit.hpp"  // made by cmake/KageCommit.cmake
#include "kage/error.hpp"
#include "mapped.hpp"
#include "options.hpp"
#include "plugin/foreign_code.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "simd/targets.hpp"
#include "standard_files.hpp"

namespace {

using namespace kage::cli;

/// One line on standard error, whatever the message holds. After a signal the exit code tells of that: the trouble may
/// well come from it, as where a pipe was waited for.
int trouble(std::string message) {
  while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.pop_back();
  for (char& c : message)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  say(fmt::format("kage: {}\n", message));
  return interrupted() ? interrupted_code() : kTrouble;
}

/// Ends the program at an exception that no code has caught, in any thread: mostly memory that a library's own thread
/// could not have.
[[noreturn]] void give_up() {
  // No memory is asked for here: there may be none.
  const char* text = "an error that nothing expected";
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    text = "out of memory";
  } catch (const std::exception& e) {
    text = e.what();
  } catch (...) {
    text = "an exception of an unknown kind";
  }
  for (const char* part : {"kage: ", text, "\n"})
    if (write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
  _exit(kTrouble);
}

// Before the libraries' own constructors, which may ask for memory too.
void catch_all() { std::set_terminate(give_up); }
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
[[gnu::constructor]] void catch_all_later() { catch_all(); }
#else
[[gnu::section(".preinit_array"), gnu::used]] void (*const kCatchAll)() = catch_all;
#endif

/// Standard output could not be written. A reader that has gone away, as head does, needs no message.
int lost_output(int error) {
  if (error == EPIPE) return kTrouble;
  return trouble(fmt::format("standard output: cannot be written: {}", std::strerror(error)));
}

std::string text_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return "out of memory";
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error))
    return fmt::format("{}: {}", (file->path2().empty() ? file->path1() : file->path2()).string(),
                       file->code().message());
  return error.what();
}

/// A stack that is too small ends a program by a signal, wherever it happens to be; so it is asked for at the start.
/// Threads have stacks of the same size.
void check_stack() {
  constexpr rlim_t least = 1 << 20;
  rlimit stack{};
  if (getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur != RLIM_INFINITY && stack.rlim_cur < least)
    throw kage::Error(fmt::format("the stack may have {} KiB only (ulimit -s), and {} are needed",
                                  stack.rlim_cur / 1024, least / 1024));
}

/// An installed kage finds its data and its plugins beside itself, wherever the prefix was moved to.
void find_data() {
  namespace fs = std::filesystem;
  std::error_code ec;
  const fs::path prefix = fs::read_symlink("/proc/self/exe", ec).parent_path().parent_path();
  if (ec) return;
  if (fs::exists(prefix / "share/kage/rtl/defs/configs.yaml", ec))
    setenv("KAGE_DATA_DIR", (prefix / "share/kage").c_str(), 0);
  const fs::path plugins = prefix / KAGE_INSTALL_LIBDIR / "kage";
  if (fs::exists(plugins / "libkage_meshes.so", ec)) setenv("KAGE_PLUGIN_DIR", plugins.c_str(), 0);
}

int run(int argc, char** argv) {
  Program program(
      "kage: a span-stream rendering core, its golden model and its co-simulation", build_name(),
      "kage cosim courtyard is a good start; kage help COMMAND explains a command, kage list lists scenes.\n"
      "After a change to the RTL kage regress says in five minutes whether it is still right.\n"
      "Exit codes: 0 same or done, 1 different, 2 trouble.");
  Action action;
  add_cosim(program, action);
  add_render(program, action);
  add_stream(program, action);
  add_vectors(program, action);
  add_board(program, action);
  add_info(program, action);
  add_plan(program, action);
  add_area(program, action);
  add_sweep(program, action);
  add_explain(program, action);
  add_diff(program, action);
  add_merge(program, action);
  add_regress(program, action);
  add_model(program, action);
  add_order(program, action);
  add_cache(program, action);
  add_list(program, action);
  add_help(program, action);
  if (const auto text = program.parse(argc, argv)) {  // --help, --version
    print_whole(*text);
    return kSame;
  }
  if (!action) return trouble("no command given; see kage --help");
  return action();
}

}  // namespace

std::string kage::cli::build_name() { return "kage " KAGE_VERSION KAGE_COMMIT; }

int main(int argc, char** argv) {
  try {
    check_stack();
    open_standard_files();
    find_data();
    catch_signals();
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    kage::tell_foreign_ends(kTrouble);
#endif
    (void)kage::simd::in_use();  // a KAGE_SIMD that cannot be had is refused before the work, by every command
    const int rc = run(argc, argv);
    errno = 0;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) return lost_output(errno != 0 ? errno : EIO);
    return rc;
  } catch (const Interrupted&) {
    return trouble("interrupted");
  } catch (const std::exception& e) {
    const auto* system = dynamic_cast<const std::system_error*>(&e);
    if (system != nullptr && std::ferror(stdout) != 0) return lost_output(system->code().value());
    // Zeros in place of lost pages make errors of their own, a size that no memory has among them; the cause is what
    // counts.
    const std::string lost = lost_mapped();
    if (!lost.empty()) return trouble(lost);
    return trouble(text_of(e));
  }
}
