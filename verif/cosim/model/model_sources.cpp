// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/model_sources.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <system_error>

#include "cosim/model/sha256.hpp"
#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::cosim {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

std::string verilator_version() { return output_of("\"${VERILATOR:-verilator}\" --version 2>/dev/null"); }
std::string compiler_version() { return output_of("${CXX:-c++} --version 2>/dev/null"); }

ModelTools model_tool_versions(const ModelOptions& options) {
  ModelTools tools;
  tools.verilator = verilator_version();
  if (tools.verilator.empty() && options.progress) options.progress(0);  // an interruption ends it too
  if (tools.verilator.empty()) throw Error("verilator: not found, and RTL models need it: tools/deps installs it");
  const char* const cxx = std::getenv("CXX");
  tools.cxx = cxx != nullptr ? cxx : "";
  tools.compiler = compiler_version();
  return tools;
}

std::vector<fs::path> model_sources(const fs::path& data, const ModelOptions& options) {
  const std::string& fault = options.fault;
  std::vector<fs::path> files;
  std::vector<const char*> folders{"rtl", "rtl/include", "rtl/include/generated", "rtl/defs",
                                   "verif/cosim/model/driver"};
  if (options.monitors) folders.push_back("verif/cosim/diverge/monitors");
  for (const char* folder : folders) {
    if (!fs::is_directory(data / folder))
      throw Error(fmt::format("{}: no such folder: kage's RTL is not there", (data / folder).string()));
    for (const auto& entry : fs::directory_iterator(data / folder)) {
      const std::string name = entry.path().filename().string();
      if (entry.is_regular_file() && name != "configs.yaml" && name != "stages.yaml" && name.front() != '.')
        files.push_back(fs::path(folder) / name);
    }
  }
  if (options.mutants) files.emplace_back("verif/mutants/mutants.yaml");
  if (!fault.empty()) {
    files.push_back(fs::path("verif/cosim/model/faults") / (fault + ".patch"));
    if (fault.find('/') != std::string::npos || !fs::exists(data / files.back()))
      throw Error(fmt::format("{}: no such fault (there are {})", fault, fmt::join(fault_names(), ", ")));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string model_key(const fs::path& data, const std::vector<fs::path>& files, const Config& config,
                      const ModelOptions& options, const ModelTools& tools) {
  Sha256 hash;
  for (const fs::path& file : files) {
    hash.add(file.string());
    hash.add(read_file(data / file));
  }
  for (const ParamInfo& p : kParams) hash.add(fmt::format("{}={}", p.name, config.*(p.member)));
  hash.add(options.fault);
  hash.add(std::string_view(options.monitors ? "monitors" : ""));
  hash.add(std::string_view(options.waves ? "waves" : ""));
  hash.add(std::string_view(options.mutants ? "mutants" : ""));
  hash.add(tools.verilator);
  hash.add(tools.cxx);
  hash.add(tools.compiler);
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
