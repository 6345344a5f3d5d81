// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/rtl_identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <thread>
#include <vector>

#include "cosim/model/model_sources.hpp"
#include "cosim/model/process.hpp"
#include "cosim/model/sha256.hpp"
#include "file/read_file.hpp"
#include "kage/paths.hpp"

namespace kage::cosim {
namespace {

namespace fs = std::filesystem;

/// Whether the preprocessor reads it.
bool is_rtl(const ModelSources& sources, const fs::path& file) {
  const auto in = [&](const std::vector<fs::path>& some) { return std::binary_search(some.begin(), some.end(), file); };
  return in(sources.modules) || in(sources.headers);
}

/// Without blanks at the ends of lines, and without empty lines: what a comment leaves behind.
std::string without_rests(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::size_t last = end == at ? std::string::npos : text.find_last_not_of(" \t\r", end - 1);
    if (last != std::string::npos && last >= at) out.append(text, at, last + 1 - at) += '\n';
    at = end + 1;
  }
  return out;
}

/// The RTL as the parser reads it, with the options that decide what a comment is; empty if there is none.
std::string preprocessed(const fs::path& data, const ModelSources& sources) {
  const char* const own = std::getenv("VERILATOR");
  std::vector<std::string> command{own != nullptr && *own != '\0' ? own : "verilator", "-E", "-P"};
  command.insert(command.end(), sources.flags.begin(), sources.flags.end());
  for (const fs::path& folder : sources.includes) command.push_back("-I" + (data / folder).string());
  for (const fs::path& file : sources.modules) command.push_back((data / file).string());
  try {
    Process process(command);
    bool ok = false;
    while (!process.ended(ok)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return ok ? without_rests(process.said()) : std::string();
  } catch (const NotStarted&) {
    return {};
  }
}

/// The first of the tools whose version does not say of what sources it was built; empty if there is none.
std::string unknown_tool(const ModelTools& tools) {
  for (const std::string* version : {&tools.verilator, &tools.compiler}) {
    std::string line = version->substr(0, version->find('\n'));
    std::string lower = line;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char* mark : {"dirty", "(mod)", "unknown"})
      if (lower.find(mark) != std::string::npos) return line;
  }
  return tools.compiler.empty() ? "the compiler tells none" : "";
}

}  // namespace

RtlIdentity rtl_identity(const Config& config) {
  const fs::path data = data_directory();
  const ModelOptions sound;
  const ModelTools tools = model_tool_versions(sound);
  const ModelSources sources = model_sources(data, sound);
  RtlIdentity identity{.model_key = model_key(data, sources, config, sound, tools)};
  if (const std::string tool = unknown_tool(tools); !tool.empty()) {
    identity.why_not = fmt::format("a tool's version does not say of what sources it was built: {}", tool);
    return identity;
  }
  const std::string text = preprocessed(data, sources);
  if (text.empty()) {
    identity.why_not = "Verilator's preprocessor does not take the RTL";
    return identity;
  }
  Sha256 hash;
  hash.add(text);
  for (const fs::path& file : sources.files) {
    if (is_rtl(sources, file)) continue;
    hash.add(file.string());
    hash.add(read_file(data / file));
  }
  for (const ParamInfo& p : kParams) hash.add(fmt::format("{}={}", p.name, config.*(p.member)));
  for (const std::string* tool : {&tools.verilator, &tools.cxx, &tools.compiler}) hash.add(*tool);
  // Somebody may have changed a source meanwhile, and then both hashes are not of one state of them.
  if (model_key(data, model_sources(data, sound), config, sound, tools) != identity.model_key)
    identity.why_not = "the RTL is being changed just now";
  else
    identity.behaviour = hash.take();
  return identity;
}

}  // namespace kage::cosim
