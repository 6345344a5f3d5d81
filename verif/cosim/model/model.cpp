// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/model.hpp"

#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>
#include <system_error>
#include <thread>
#include <vector>

#include "cosim/model/lock.hpp"
#include "cosim/model/model_cache.hpp"
#include "cosim/model/model_sources.hpp"
#include "cosim/model/process.hpp"
#include "file/hidden_folder.hpp"
#include "file/output_file.hpp"
#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::cosim {
namespace {

namespace fs = std::filesystem;

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

/// The limit that a build met, which its tools tell in lines before the one that counts as the cause; else none.
std::string limit_in(const std::string& told) {
  for (const int cause : {EMFILE, ENFILE, ENOSPC, EDQUOT, ENOMEM})
    if (told.find(std::strerror(cause)) != std::string::npos) return std::strerror(cause);
  return {};
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
    fs::permissions(temp, fs::perms::owner_read | fs::perms::owner_write);
    fs::rename(temp, log);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

/// OutputFile names the cause of a write that fails; std::filesystem::copy_file says "Input/output error" where a disk
/// fills up within a file.
void copy_sources(const fs::path& data, const std::vector<fs::path>& files, const fs::path& copy) {
  std::error_code ec;
  for (const fs::path& file : files) {
    const std::string name = fmt::format("RTL model: {}", (copy / file).string());
    fs::create_directories((copy / file).parent_path(), ec);
    if (ec) throw Error(fmt::format("{}: cannot be written: {}", name, ec.message()));
    OutputFile out(copy / file, name);
    out.copy(data / file);
    out.close();
    fs::permissions(copy / file, fs::status(data / file).permissions(), ec);  // build.py is run
    if (ec) throw Error(fmt::format("{}: cannot be written: {}", name, ec.message()));
  }
}

/// A model is a program: where none may run, that is told, and not what the loader says of it.
void refuse_no_exec(const fs::path& folder) {
  struct statvfs state {};
  if (statvfs(folder.c_str(), &state) == 0 && (state.f_flag & ST_NOEXEC) != 0)
    throw Error(
        fmt::format("{}: on its file system nothing may be run (noexec), and RTL models are kept there: set "
                    "XDG_CACHE_HOME to a folder elsewhere",
                    folder.string()));
}

HiddenFolder work_folder(const fs::path& folder) {
  try {
    return HiddenFolder(folder);
  } catch (const std::system_error& e) {
    throw Error(fmt::format("RTL model: {}: cannot be written to: {}", folder.string(), e.code().message()));
  }
}

/// Names and versions, a line each.
std::vector<std::string> lines_of(const ModelTools& tools) {
  const auto line = [](const std::string& text) { return text.substr(0, text.find('\n')); };
  std::vector<std::string> lines{line(tools.verilator), line(tools.compiler)};
  if (!tools.yosys.empty()) lines.push_back(line(tools.yosys));
  return lines;
}

/// The cache's description of a model, for `kage cache list`.
nlohmann::ordered_json about(const Config& config, const ModelOptions& options, const ModelTools& tools) {
  nlohmann::ordered_json values;
  for (const ParamInfo& p : kParams) values[std::string(p.name)] = config.*(p.member);
  return {{"config", values},       {"fault", options.fault},     {"monitors", options.monitors},
          {"waves", options.waves}, {"mutants", options.mutants}, {"lines", options.lines},
          {"ports", options.ports}, {"netlist", options.netlist}, {"tools", lines_of(tools)}};
}

/// The command that builds the model in the folder `work` of the sources that lie in work/source.
std::vector<std::string> build_command(const fs::path& work, const Config& config, const ModelOptions& options) {
  std::vector<std::string> command{"env",
                                   "-u",
                                   "KAGE_RTL_DIR",
                                   "TMPDIR=" + (work / "tmp").string(),
                                   "python3",
                                   "-B",  // the folder may be nobody's to write to
                                   (work / "source/verif/cosim/model/driver/build.py").string(),
                                   (work / "model.so").string()};
  for (const ParamInfo& p : kParams) command.push_back(fmt::format("{}={}", p.name, config.*(p.member)));
  if (!options.fault.empty()) command.insert(command.end(), {"--fault", options.fault});
  if (options.monitors) command.emplace_back("--monitors");
  if (options.waves) command.emplace_back("--waves");
  if (options.mutants) command.emplace_back("--mutants");
  if (options.lines) command.emplace_back("--lines");
  if (!options.ports.empty()) command.insert(command.end(), {"--ports", options.ports});
  if (!options.netlist.empty()) command.insert(command.end(), {"--netlist", options.netlist});
  command.insert(command.end(), {"--jobs", std::to_string(std::clamp(std::thread::hardware_concurrency(), 1U, 8U)),
                                 "--keep", (work / "build").string()});
  return command;
}

/// Throws Error for a build that failed, with what it said. Messages name files of `data`, where a person can look at
/// them.
[[noreturn]] void refuse_build(const fs::path& work, const fs::path& data, const std::string& said,
                               const fs::path& log) {
  const fs::path copy = work / "source";
  std::string cause = with_path(telling_line(said), copy, data);
  // build.py prints less than its log has; but a log that found no room on the disk is empty.
  const fs::path own = work / "build/build.log";
  const std::string told = fs::exists(own) ? read_file(own) : "";
  const std::string limit = limit_in(told.empty() ? said : told);
  if (cause.find(limit) == std::string::npos) cause += ": " + limit;
  const bool kept = keep_log(with_path(told.empty() ? said : told, copy, data), work / "log", log);
  throw Error(
      fmt::format("RTL model: the build failed: {}{}", cause, kept ? fmt::format(" (log: {})", log.string()) : ""));
}

/// Tells the progress while a model is being built, or waited for.
class BuildWait {
 public:
  explicit BuildWait(const BuildProgress& progress) : progress_(progress) {}

  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  void wait() const {
    if (progress_) progress_(seconds());
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }

 private:
  const BuildProgress& progress_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Builds work/model.so.
void build(const fs::path& work, const fs::path& data, const Config& config, const ModelOptions& options,
           const BuildWait& patience, const fs::path& log) {
  fs::create_directory(work / "tmp");  // the compilers' temporary files go with the rest if they are killed
  if (options.progress) options.progress(0);
  Process process(build_command(work, config, options));
  bool ok = false;
  while (!process.ended(ok)) patience.wait();
  if (!ok || !fs::exists(work / "model.so")) refuse_build(work, data, process.said(), log);
}

}  // namespace

Model find_model(const Config& config, const ModelOptions& options) {
  const fs::path data = data_directory();
  const ModelCache cache;
  refuse_no_exec(cache.folder());
  const ModelSources sources = model_sources(data, options);
  std::string damage;
  // A model that is there and whole.
  const auto find = [&](const std::string& key) {
    const std::optional<std::string> found = cache.damage(key);
    damage = found.value_or("");
    if (!found || !damage.empty()) return false;
    cache.use(key);
    return true;
  };
  const std::string now = model_key(data, sources, config, options, model_tool_versions(options));
  HiddenFolder::sweep(cache.folder());  // of builds that were killed
  if (find(now)) return {.library = cache.library(now)};

  // A copy is built: someone may change the RTL meanwhile, and the model must be of the sources that its name stands
  // for.
  const HiddenFolder hidden = work_folder(cache.folder());
  const fs::path& work = hidden.path();
  copy_sources(data, sources.files, work / "source");
  const ModelTools tools = model_tool_versions(options, true);
  const std::string key = model_key(work / "source", sources, config, options, tools);
  const BuildWait patience(options.progress);
  Lock lock(cache.lock(key), O_RDWR | O_CREAT | O_NOFOLLOW);
  while (!lock.try_lock()) patience.wait();
  if (find(key)) return {.library = cache.library(key)};  // another program has built it
  build(work, data, config, options, patience, cache.log(key));
  cache.keep(key, work / "model.so", about(config, options, tools));
  return {.library = cache.library(key), .build_seconds = patience.seconds(), .damage = damage};
}

bool has_model(const Config& config, const ModelOptions& options) {
  const fs::path data = data_directory();
  const ModelSources sources = model_sources(data, options);
  const std::optional<std::string> found =
      ModelCache().damage(model_key(data, sources, config, options, model_tool_versions(options)));
  return found && found->empty();
}

std::vector<std::string> model_tools() {
  return lines_of({.verilator = verilator_version(), .cxx = {}, .compiler = compiler_version(), .yosys = {}});
}

}  // namespace kage::cosim
