// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/model_sources.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>

#include "cosim/model/sha256.hpp"
#include "file/meant.hpp"
#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::cosim {
namespace {

namespace fs = std::filesystem;

/// What `command` prints; empty if it prints nothing. Throws Error if no shell can be started for it.
std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) throw Error(fmt::format("`{}`: cannot be started: {}", command, std::strerror(errno)));
  std::string text;
  std::array<char, 512> buffer{};
  while (true) {
    const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe.get());
    text.append(buffer.data(), n);
    if (n == buffer.size()) continue;
    if (ferror(pipe.get()) == 0 || errno != EINTR) return text;
    clearerr(pipe.get());  // a signal: whoever waits for it asks
  }
}

constexpr const char* kVerilator = "\"${VERILATOR:-verilator}\" --version";
constexpr const char* kYosys = "${YOSYS:-yosys} -V";
constexpr const char* kCompiler = "${CXX:-c++} --version";

/// The first line on standard output.
std::string version_of(const char* command) { return output_of(std::string(command) + " 2>/dev/null"); }

/// Why Verilator, which is there, says no version: the first line of all that it says. Empty if it is not there. Its
/// exit code does not tell: that of a program whose library cannot be opened is the same as that of none.
std::string failure_of_verilator() {
  const std::string said = output_of(
      fmt::format("if command -v \"${{VERILATOR:-verilator}}\" >/dev/null 2>&1; then {} 2>&1; fi", kVerilator));
  return said.substr(0, said.find('\n'));
}

[[noreturn]] void refuse_verilator() {
  const char* const root = std::getenv("VERILATOR_ROOT");
  const std::string why = failure_of_verilator();
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

/// The patch of a fault.
fs::path fault_file(const fs::path& data, const YAML::Node& roles, const std::string& fault) {
  for (const fs::path& file : files_of(data, roles, "fault"))
    if (file.stem() == fault) return file;
  const std::vector<std::string> names = fault_names();
  throw Error(fmt::format("{}: no such fault{} (there are {})", fault, meant(fault, names), fmt::join(names, ", ")));
}

YAML::Node roles_of(const fs::path& data) {
  const fs::path list = data / "verif/cosim/model/driver/sources.yaml";
  try {
    return YAML::Load(read_file(list));
  } catch (const YAML::Exception& e) {
    throw Error(fmt::format("{}: {}", list.string(), e.what()));
  }
}

}  // namespace

const std::string& verilator_version() {
  static const std::string version = version_of(kVerilator);
  return version;
}

const std::string& compiler_version() {
  static const std::string version = version_of(kCompiler);
  return version;
}

ModelTools model_tool_versions(const ModelOptions& options, bool anew) {
  ModelTools tools;
  tools.verilator = anew ? version_of(kVerilator) : verilator_version();
  if (tools.verilator.empty() && options.progress) options.progress(0);  // an interruption ends it too
  if (tools.verilator.empty()) refuse_verilator();
  const char* const cxx = std::getenv("CXX");
  tools.cxx = cxx != nullptr ? cxx : "";
  tools.compiler = anew ? version_of(kCompiler) : compiler_version();
  const char* const yosys = std::getenv("YOSYS");
  if (!options.netlist.empty()) tools.yosys = version_of(kYosys);
  if (!options.netlist.empty() && tools.yosys.empty()) {
    if (yosys != nullptr && *yosys != '\0')
      throw Error(fmt::format("$YOSYS: `{} -V` fails or says no version, and netlists need a yosys", yosys));
    throw Error("yosys: not found, or `yosys -V` fails, and netlists need it: tools/deps test installs it");
  }
  if (!options.netlist.empty() && yosys != nullptr) tools.yosys += yosys;  // it may have flags
  return tools;
}

ModelSources model_sources(const fs::path& data, const ModelOptions& options) {
  const YAML::Node roles = roles_of(data);
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
  if (!options.fault.empty()) sources.files.push_back(fault_file(data, roles, options.fault));
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

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator(data_directory() / "verif/cosim/model/faults", ec))
    if (entry.path().extension() == ".patch") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace kage::cosim
