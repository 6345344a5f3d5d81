// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/model.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
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

HiddenFolder work_folder(const fs::path& folder) {
  try {
    return HiddenFolder(folder);
  } catch (const std::system_error& e) {
    throw Error(fmt::format("RTL model: {}: cannot be written to: {}", folder.string(), e.code().message()));
  }
}

/// What the cache says of a model, for `kage cache list`.
nlohmann::ordered_json about(const Config& config, const ModelOptions& options) {
  nlohmann::ordered_json values;
  for (const ParamInfo& p : kParams) values[std::string(p.name)] = config.*(p.member);
  return {{"config", values},       {"fault", options.fault},     {"monitors", options.monitors},
          {"waves", options.waves}, {"mutants", options.mutants}, {"tools", model_tools()}};
}

}  // namespace

Model find_model(const Config& config, const ModelOptions& options) {
  const fs::path data = data_directory();
  const ModelCache cache;
  const std::vector<fs::path> files = model_sources(data, options);
  std::string damage;
  // A model that is there and whole.
  const auto find = [&](const std::string& key) {
    const std::optional<std::string> found = cache.damage(key);
    damage = found.value_or("");
    if (!found || !damage.empty()) return false;
    cache.use(key);
    return true;
  };
  const ModelTools tools = model_tool_versions(options);
  const std::string now = model_key(data, files, config, options, tools);
  HiddenFolder::sweep(cache.folder());  // of builds that were killed
  if (find(now)) return {.library = cache.library(now)};

  // What is built is a copy: someone may change the RTL meanwhile, and the model must be of what its name says.
  const HiddenFolder hidden = work_folder(cache.folder());
  const fs::path& work = hidden.path();
  const fs::path copy = work / "source";
  copy_sources(data, files, copy);
  const std::string key = model_key(copy, files, config, options, tools);

  const auto start = std::chrono::steady_clock::now();
  const auto wait = [&] {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (options.progress) options.progress(seconds);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return seconds;
  };
  const Lock lock(cache.lock(key), O_RDWR | O_CREAT | O_NOFOLLOW);
  while (!lock.try_lock()) wait();
  if (find(key)) return {.library = cache.library(key)};  // another program has built it

  const fs::path log = cache.log(key);
  // The compilers' temporary files lie there too, and go with the rest if they are killed.
  fs::create_directory(work / "tmp");
  std::vector<std::string> command{"env",
                                   "-u",
                                   "KAGE_RTL_DIR",
                                   "TMPDIR=" + (work / "tmp").string(),
                                   (copy / "verif/cosim/model/driver/build.py").string(),
                                   (work / "model.so").string()};
  for (const ParamInfo& p : kParams) command.push_back(fmt::format("{}={}", p.name, config.*(p.member)));
  if (!options.fault.empty()) command.insert(command.end(), {"--fault", options.fault});
  if (options.monitors) command.emplace_back("--monitors");
  if (options.waves) command.emplace_back("--waves");
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
  cache.keep(key, work / "model.so", about(config, options));
  return {.library = cache.library(key),
          .build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          .damage = damage};
}

std::vector<std::string> model_tools() {
  const auto line = [](const std::string& text) { return text.substr(0, text.find('\n')); };
  return {line(verilator_version()), line(compiler_version())};
}

}  // namespace kage::cosim
