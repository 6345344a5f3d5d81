// SPDX-License-Identifier: Apache-2.0
#include "cosim/model.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <sstream>
#include <system_error>
#include <thread>
#include <vector>

#include "cosim/lock.hpp"
#include "files/hidden_folder.hpp"
#include "files/output_file.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::cosim {
namespace {

namespace fs = std::filesystem;

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }

  /// Adds a text and its length, so that no two lists of texts are alike.
  void add(const std::string& text) {
    const std::uint64_t size = text.size();
    EVP_DigestUpdate(context_.get(), &size, sizeof size);
    EVP_DigestUpdate(context_.get(), text.data(), text.size());
  }

  std::string hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &size);
    std::string text;
    for (unsigned char byte : std::span(digest).first(size)) text += fmt::format("{:02x}", byte);
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

/// What `command` prints; empty if it fails.
std::string output_of(const char* command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command, "r"), pclose);
  std::string text;
  if (!pipe) return text;
  std::array<char, 512> buffer{};
  while (true) {
    const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe.get());
    text.append(buffer.data(), n);
    if (n == buffer.size()) continue;
    if (ferror(pipe.get()) == 0 || errno != EINTR) return text;
    clearerr(pipe.get());  // a signal: whoever waits for it asks
  }
}

// The tools that build.py takes; CXX may be several words.
std::string verilator_version() { return output_of("\"${VERILATOR:-verilator}\" --version 2>/dev/null"); }
std::string compiler_version() { return output_of("${CXX:-c++} --version 2>/dev/null"); }

/// The names that --fault takes.
std::vector<std::string> faults(const fs::path& data) {
  std::vector<std::string> names;
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator(data / "verif/faults", ec))
    if (entry.path().extension() == ".patch") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The files that the model is made of, below `data`: what build.py --sources names, and perhaps a file more.
std::vector<fs::path> sources(const fs::path& data, const ModelOptions& options) {
  const std::string& fault = options.fault;
  std::vector<fs::path> files;
  std::vector<const char*> folders{"rtl", "rtl/include", "rtl/defs", "verif/rtl_model"};
  if (options.traced) folders.push_back("verif/monitors");
  for (const char* folder : folders) {
    if (!fs::is_directory(data / folder))
      throw Error(fmt::format("{}: no such folder: kage's RTL is not there", (data / folder).string()));
    for (const auto& entry : fs::directory_iterator(data / folder)) {
      const std::string name = entry.path().filename().string();
      if (entry.is_regular_file() && name != "configs.yaml" && name.front() != '.')
        files.push_back(fs::path(folder) / name);
    }
  }
  if (options.mutants) files.emplace_back("verif/mutants/mutants.yaml");
  if (!fault.empty()) {
    files.push_back(fs::path("verif/faults") / (fault + ".patch"));
    if (fault.find('/') != std::string::npos || !fs::exists(data / files.back()))
      throw Error(fmt::format("{}: no such fault (there are {})", fault, fmt::join(faults(data), ", ")));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string key_of(const fs::path& data, const std::vector<fs::path>& files, const Config& config,
                   const ModelOptions& options) {
  Sha256 hash;
  for (const fs::path& file : files) {
    hash.add(file.string());
    hash.add(read_file(data / file));
  }
  for (const ParamInfo& p : kParams) hash.add(fmt::format("{}={}", p.name, config.*(p.member)));
  hash.add(options.fault);
  hash.add(options.traced ? "traced" : "");
  hash.add(options.mutants ? "mutants" : "");
  const std::string verilator = verilator_version();
  if (verilator.empty() && options.progress) options.progress(0);  // an interruption ends it too
  if (verilator.empty()) throw Error("verilator: not found, and RTL models need it: tools/deps installs it");
  hash.add(verilator);
  const char* const cxx = std::getenv("CXX");
  hash.add(cxx != nullptr ? cxx : "");  // it may have flags
  hash.add(compiler_version());
  return hash.hex();
}

fs::path cache_folder() {
  const char* xdg = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;
  if (xdg != nullptr && *xdg != '\0')
    folder = xdg;
  else if (home != nullptr && *home != '\0')
    folder = fs::path(home) / ".cache";
  else
    throw Error("neither XDG_CACHE_HOME nor HOME is set: there is no place for RTL models");
  folder /= "kage/models";
  std::error_code ec;
  fs::create_directories(folder, ec);
  if (ec) throw Error(fmt::format("{}: cannot be made: {}", folder.string(), ec.message()));
  return folder;
}

/// A program in a process group of its own, with what it says. It ends with the object, or with this process however
/// that dies, and all programs that it has started end with it.
class Process {
 public:
  explicit Process(const std::vector<std::string>& command) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) fail(command, errno);
    output_ = ends[0];
    (void)fcntl(output_, F_SETFL, O_NONBLOCK);
    // What its tools leave behind when they are ended comes to this process, so that their end can be waited for.
    (void)prctl(PR_SET_CHILD_SUBREAPER, 1);
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ == 0) execute(command, ends[1], parent);
    const int error = errno;
    (void)close(ends[1]);
    if (pid_ < 0) {
      (void)close(output_);
      fail(command, error);
    }
    setpgid(pid_, pid_);  // by both: it has to be so before either goes on
  }
  ~Process() {
    if (pid_ > 0) end();
    (void)close(output_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// True once it has ended.
  bool ended(bool& ok) {
    read_output();
    siginfo_t info{};
    // It stays a zombie for the moment: until it is gone its number, which is that of the group, is no other's.
    if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0)
      return false;
    ok = info.si_code == CLD_EXITED && info.si_status == 0;
    end();
    read_output();
    return true;
  }

  /// What it has said so far.
  [[nodiscard]] const std::string& said() const { return said_; }

 private:
  [[noreturn]] static void fail(const std::vector<std::string>& command, int error) {
    throw Error(fmt::format("{}: cannot be started: {}", command[0], std::strerror(error)));
  }

  [[noreturn]] static void execute(const std::vector<std::string>& command, int output, pid_t parent) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(127);  // it died before prctl
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    std::vector<char*> argv;
    argv.reserve(command.size() + 1);
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execvp(argv[0], argv.data());
    _exit(127);
  }

  void end() {
    kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    while (waitpid(-pid_, nullptr, 0) > 0) continue;
    pid_ = 0;
  }

  void read_output() {
    std::array<char, 4096> buffer{};
    for (ssize_t n = 0; (n = read(output_, buffer.data(), buffer.size())) > 0;)
      said_.append(buffer.data(), static_cast<std::size_t>(n));
  }

  pid_t pid_ = 0;
  int output_ = -1;
  std::string said_;
};

/// The line that tells most, for a message of one line.
std::string telling_line(const std::string& said) {
  std::istringstream in(said);
  std::string line;
  std::string error;
  std::string last;
  while (std::getline(in, line)) {
    if (line.empty()) continue;
    if (error.empty() && line.find("rror") != std::string::npos) error = line;
    last = line;
  }
  if (last.empty()) return "no cause was given";
  return error.empty() ? last : error;
}

/// `text` with the path `to` wherever it has `from`.
std::string with_path(std::string text, const fs::path& from, const fs::path& to) {
  const std::string old = from.string();
  const std::string put = to.string();
  for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += put.size())
    text.replace(at, old.size(), put);
  return text;
}

/// Puts a failed build's log where a person can look at it; false where that cannot be, as on a full disk. A link of
/// that name is replaced, not followed.
bool keep_log(const std::string& text, const fs::path& temp, const fs::path& log) {
  try {
    OutputFile out(temp, log.string());
    out << text;
    out.close();
    fs::rename(temp, log);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

void copy_sources(const fs::path& data, const std::vector<fs::path>& files, const fs::path& copy) {
  std::error_code ec;
  for (const fs::path& file : files) {
    fs::create_directories((copy / file).parent_path(), ec);
    if (!ec) fs::copy_file(data / file, copy / file, ec);
    if (ec) throw Error(fmt::format("RTL model: {}: cannot be written: {}", (copy / file).string(), ec.message()));
  }
}

HiddenFolder work_folder(const fs::path& folder) {
  try {
    return HiddenFolder(folder);
  } catch (const std::system_error& e) {
    throw Error(fmt::format("RTL model: {}: cannot be written to: {}", folder.string(), e.code().message()));
  }
}

}  // namespace

Model find_model(const Config& config, const ModelOptions& options) {
  const fs::path data = data_directory();
  const fs::path folder = cache_folder();
  const std::vector<fs::path> files = sources(data, options);
  const auto library = [&](const std::string& key) { return folder / (key + ".so"); };
  const std::string now = key_of(data, files, config, options);
  HiddenFolder::sweep(folder);  // of builds that were killed
  if (fs::exists(library(now))) return {library(now), 0};

  // What is built is a copy: someone may change the RTL meanwhile, and the model must be of what its name says.
  const HiddenFolder hidden = work_folder(folder);
  const fs::path work = hidden.path();
  const fs::path copy = work / "source";
  copy_sources(data, files, copy);
  const std::string key = key_of(copy, files, config, options);

  const auto start = std::chrono::steady_clock::now();
  const auto wait = [&] {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (options.progress) options.progress(seconds);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return seconds;
  };
  const Lock lock(folder / (key + ".lock"));
  while (!lock.try_lock()) wait();
  if (fs::exists(library(key))) return {library(key), 0};  // another program has built it

  const fs::path log = folder / (key + ".log");
  // The compilers' temporary files lie there too, and go with the rest if they are killed.
  fs::create_directory(work / "tmp");
  std::vector<std::string> command{"env",
                                   "-u",
                                   "KAGE_RTL_DIR",
                                   "TMPDIR=" + (work / "tmp").string(),
                                   (copy / "verif/rtl_model/build.py").string(),
                                   (work / "model.so").string()};
  for (const ParamInfo& p : kParams) command.push_back(fmt::format("{}={}", p.name, config.*(p.member)));
  if (!options.fault.empty()) command.insert(command.end(), {"--fault", options.fault});
  if (options.traced) command.emplace_back("--trace");
  if (options.mutants) command.emplace_back("--mutants");
  command.insert(command.end(), {"--jobs", std::to_string(std::clamp(std::thread::hardware_concurrency(), 1U, 8U)),
                                 "--keep", (work / "build").string()});
  if (options.progress) options.progress(0);
  Process build(command);
  bool ok = false;
  while (!build.ended(ok)) wait();
  if (!ok || !fs::exists(work / "model.so")) {
    // Messages name files where a person can look at them.
    const std::string cause = with_path(telling_line(build.said()), copy, data);
    const fs::path own = work / "build/build.log";  // what build.py said is less than its log has
    const bool kept =
        keep_log(with_path(fs::exists(own) ? read_file(own) : build.said(), copy, data), work / "log", log);
    throw Error(
        fmt::format("RTL model: the build failed: {}{}", cause, kept ? fmt::format(" (log: {})", log.string()) : ""));
  }
  fs::rename(work / "model.so", library(key));
  return {library(key), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

std::vector<std::string> model_tools() {
  const auto line = [](const std::string& text) { return text.substr(0, text.find('\n')); };
  return {line(verilator_version()), line(compiler_version())};
}

}  // namespace kage::cosim
