// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/model_sources.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <sstream>
#include <system_error>
#include <thread>

#include "cosim/model/process.hpp"
#include "cosim/model/sha256.hpp"
#include "file/meant.hpp"
#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::cosim {
namespace {

namespace fs = std::filesystem;

using Command = std::vector<std::string>;

/// All that a program says, or what it says on standard output. Throws NotStarted, and what `progress` throws.
std::string output_of(const Command& command, Said kept, const BuildProgress& progress) {
  Process process(command, kept);
  for (bool ok = false; !process.ended(ok);) {
    if (progress) progress(0);  // an interruption ends it
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return process.said();
}

/// The value of an environment variable; `otherwise` if it has none.
std::string value_of(const char* variable, const char* otherwise) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

/// A program that a variable may name, with options of it, as a shell parts them.
Command words_of(const char* variable, const char* otherwise, const char* option) {
  std::istringstream words(value_of(variable, otherwise));
  Command command{std::istream_iterator<std::string>(words), {}};
  if (command.empty()) command.emplace_back(otherwise);
  command.emplace_back(option);
  return command;
}

Command verilator_command() { return {value_of("VERILATOR", "verilator"), "--version"}; }
Command yosys_command() { return words_of("YOSYS", "yosys", "-V"); }
Command compiler_command() { return words_of("CXX", "c++", "--version"); }

/// No such program is there: another cause, as too many open files, says nothing of that.
bool is_missing(const NotStarted& e) { return e.cause() == ENOENT || e.cause() == ENOTDIR || e.cause() == EACCES; }

/// The words on standard output; none if there is no such program. Throws NotStarted.
std::string version_of(const Command& command, const BuildProgress& progress) {
  try {
    return output_of(command, Said::output, progress);
  } catch (const NotStarted& e) {
    if (is_missing(e)) return {};
    throw;
  }
}

/// Why Verilator, which is there, says no version: the first line of all that it says. Empty if it is not there.
std::string failure_of_verilator(const BuildProgress& progress) {
  try {
    const std::string said = output_of(verilator_command(), Said::all, progress);
    return said.empty() ? "it says nothing" : said.substr(0, said.find('\n'));
  } catch (const NotStarted& e) {
    return e.cause() == EACCES ? std::strerror(EACCES) : "";
  }
}

[[noreturn]] void refuse_verilator(const BuildProgress& progress) {
  const char* const root = std::getenv("VERILATOR_ROOT");
  const std::string why = failure_of_verilator(progress);
  // Verilator looks for its own program there and nowhere else.
  const auto has = [&](const char* program) { return fs::exists(fs::path(root) / program); };
  if (root != nullptr && *root != '\0' && !has("bin/verilator_bin") && !has("verilator_bin"))
    throw Error(fmt::format("verilator: $VERILATOR_ROOT is {}, and no Verilator is there: unset it{}", root,
                            why.empty() ? "" : " (" + why + ")"));
  if (!why.empty()) throw Error(fmt::format("verilator: it is there and does not run: {}", why));
  throw Error("verilator: not found, and RTL models need it: tools/deps installs it");
}

/// The patterns of a role of sources.yaml.
std::vector<fs::path> patterns(const YAML::Node& roles, const char* role) {
  std::vector<fs::path> all;
  for (const YAML::Node& pattern : roles[role]) all.emplace_back(pattern.as<std::string>());
  return all;
}

/// The files of a role, sorted. As in a shell, a pattern takes no hidden file.
std::vector<fs::path> files_of(const fs::path& data, const YAML::Node& roles, const char* role) {
  std::vector<fs::path> files;
  for (const fs::path& pattern : patterns(roles, role)) {
    const fs::path folder = pattern.parent_path();
    if (!fs::is_directory(data / folder))
      throw Error(fmt::format("{}: no such folder: kage's RTL is not there", (data / folder).string()));
    for (const auto& entry : fs::directory_iterator(data / folder)) {
      const fs::path name = entry.path().filename();
      if (entry.is_regular_file() && fnmatch(pattern.filename().c_str(), name.c_str(), FNM_PERIOD) == 0)
        files.push_back(folder / name);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

YAML::Node yaml_of(const fs::path& file) {
  try {
    return YAML::Load(read_file(file));
  } catch (const YAML::Exception& e) {
    throw Error(fmt::format("{}: {}", file.string(), e.what()));
  }
}

void check_fault(const std::string& fault) {
  std::vector<std::string> names;
  for (const Fault& f : faults()) names.push_back(f.name);
  if (std::find(names.begin(), names.end(), fault) == names.end())
    throw Error(fmt::format("{}: no such fault{} (there are {})", fault, meant(fault, names), fmt::join(names, ", ")));
}

}  // namespace

const std::string& verilator_version(const BuildProgress& progress) {
  static const std::string version = version_of(verilator_command(), progress);
  return version;
}

const std::string& compiler_version(const BuildProgress& progress) {
  static const std::string version = version_of(compiler_command(), progress);
  return version;
}

ModelTools model_tool_versions(const ModelOptions& options, bool anew) {
  const BuildProgress& progress = options.progress;
  ModelTools tools;
  tools.verilator = anew ? version_of(verilator_command(), progress) : verilator_version(progress);
  if (tools.verilator.empty()) refuse_verilator(progress);
  const char* const cxx = std::getenv("CXX");
  tools.cxx = cxx != nullptr ? cxx : "";
  tools.compiler = anew ? version_of(compiler_command(), progress) : compiler_version(progress);
  if (options.netlist.empty()) return tools;
  const char* const yosys = std::getenv("YOSYS");
  tools.yosys = version_of(yosys_command(), progress);
  if (tools.yosys.empty()) {
    if (yosys != nullptr && *yosys != '\0')
      throw Error(fmt::format("$YOSYS: `{} -V` fails or says no version, and netlists need a yosys", yosys));
    throw Error("yosys: not found, or `yosys -V` fails, and netlists need it: tools/deps test installs it");
  }
  if (yosys != nullptr) tools.yosys += yosys;  // it may have flags
  return tools;
}

ModelSources model_sources(const fs::path& data, const ModelOptions& options) {
  const YAML::Node roles = yaml_of(data / "verif/cosim/model/driver/sources.yaml");
  ModelSources sources{.files = {},
                       .modules = files_of(data, roles, "modules"),
                       .headers = files_of(data, roles, "headers"),
                       .includes = patterns(roles, "includes"),
                       .flags = {}};
  for (const YAML::Node& flag : roles["flags"]) sources.flags.push_back(flag.as<std::string>());
  const auto add = [&](const std::vector<fs::path>& more) {
    sources.files.insert(sources.files.end(), more.begin(), more.end());
  };
  add(sources.modules);
  add(sources.headers);
  add(files_of(data, roles, "parameters"));
  add(files_of(data, roles, "driver"));
  if (options.monitors) add(files_of(data, roles, "monitors"));
  if (options.mutants) add(files_of(data, roles, "mutants"));
  if (!options.netlist.empty()) add(files_of(data, roles, "cells"));
  if (!options.fault.empty()) {
    check_fault(options.fault);
    add(files_of(data, roles, "faults"));
  }
  std::sort(sources.files.begin(), sources.files.end());
  return sources;
}

std::string model_key(const fs::path& data, const ModelSources& sources, const Config& config,
                      const ModelOptions& options, const ModelTools& tools) {
  Sha256 hash;
  for (const fs::path& file : sources.files) {
    hash.add(file.string());
    hash.add(read_file(data / file));
  }
  for (const ParamInfo& p : kParams) hash.add(fmt::format("{}={}", p.name, config.*(p.member)));
  hash.add(options.fault);
  hash.add(std::string_view(options.monitors ? "monitors" : ""));
  hash.add(std::string_view(options.waves ? "waves" : ""));
  hash.add(std::string_view(options.mutants ? "mutants" : ""));
  hash.add(std::string_view(options.lines ? "lines" : ""));
  hash.add(options.ports);
  hash.add(options.netlist);
  hash.add(tools.verilator);
  hash.add(tools.cxx);
  hash.add(tools.compiler);
  hash.add(tools.yosys);
  return hash.take();
}

std::vector<Fault> faults() {
  std::vector<Fault> all;
  const fs::path list = data_directory() / "verif/cosim/model/faults.yaml";
  try {
    for (const YAML::Node& fault : yaml_of(list))
      all.push_back({fault["name"].as<std::string>(), fault["breaks"].as<std::string>()});
  } catch (const YAML::Exception& e) {
    throw Error(fmt::format("{}: {}", list.string(), e.what()));
  }
  std::sort(all.begin(), all.end(), [](const Fault& a, const Fault& b) { return a.name < b.name; });
  return all;
}

}  // namespace kage::cosim
