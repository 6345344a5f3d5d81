// SPDX-License-Identifier: Apache-2.0
#include "explore/synthesis.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <sstream>
#include <thread>
#include <vector>

#include "cosim/model/process.hpp"
#include "explore/kept_core.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::explore {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Between two looks at a program that runs.
constexpr std::chrono::milliseconds kLook{20};

// Raise it when the commands below, or what of the cells is counted, change.
constexpr int kVersion = 1;

std::string program() {
  const char* const yosys = std::getenv("YOSYS");
  return yosys != nullptr && *yosys != '\0' ? yosys : "yosys";
}

/// Output of a program; nothing if it cannot be run or fails.
std::optional<std::string> output_of(const std::vector<std::string>& command, const std::function<void()>& wait) {
  try {
    cosim::Process process(command);
    bool ok = false;
    while (!process.ended(ok)) {
      if (wait) wait();
      std::this_thread::sleep_for(kLook);
    }
    if (ok) return process.said();
  } catch (const cosim::NotStarted& e) {
    if (e.cause() != ENOENT) throw;
  }
  return std::nullopt;
}

std::string script(const Config& config, const fs::path& stat) {
  const fs::path rtl = data_directory() / "rtl";
  std::string read = fmt::format("read_verilog -defer -sv -I{}", (rtl / "include").string());
  for (const fs::path& file : data_files("rtl", ".sv")) read += " " + file.string();
  std::string set;
  for (const ParamInfo& p : kParams) set += fmt::format(" -chparam {} {}", p.name, config.*(p.member));
  return fmt::format("{}; hierarchy -top kage_top{}; synth_ecp5 -top kage_top; tee -q -o {} stat", read, set,
                     stat.string());
}

CellCount count(const fs::path& stat) {
  std::map<std::string, int> cells;
  // "     LUT4   5515"; from yosys 0.50 on the number may come first.
  static const std::regex kRow(R"(^\s*(?:([A-Z][A-Z0-9_]*)\s+(\d+)|(\d+)\s+([A-Z][A-Z0-9_]*))\s*$)");
  std::ifstream file(stat);
  for (std::string line; std::getline(file, line);) {
    std::smatch m;
    if (!std::regex_match(line, m, kRow)) continue;
    cells[m[1].matched ? m[1] : m[4]] = std::stoi(m[1].matched ? m[2] : m[3]);
  }
  return {.luts = cells["LUT4"] + 2 * cells["CCU2C"] + 4 * cells["TRELLIS_DPR16X4"],
          .flip_flops = cells["TRELLIS_FF"],
          .rams = cells["DP16KD"],
          .dsps = cells["MULT18X18D"]};
}

fs::path kept_file(const Config& config, const std::string& yosys) {
  return kept_core_file("cells", config, {std::to_string(kVersion), yosys});
}

CellCount cells_of(const Json& j) { return {j.at("luts"), j.at("flip_flops"), j.at("rams"), j.at("dsps")}; }

Json to_json(const CellCount& cells) {
  return {{"luts", cells.luts}, {"flip_flops", cells.flip_flops}, {"rams", cells.rams}, {"dsps", cells.dsps}};
}

/// Two scenes of a sweep may ask for the same core at once: the second thread waits here and finds what is kept.
std::unique_lock<std::mutex> turn_of(const fs::path& path, const std::function<void()>& wait) {
  static std::mutex guard;
  static std::map<fs::path, std::mutex> turns;
  std::unique_lock<std::mutex> turn;
  {
    const std::lock_guard lock(guard);
    turn = std::unique_lock(turns[path], std::defer_lock);
  }
  while (!turn.try_lock()) {
    if (wait) wait();
    std::this_thread::sleep_for(kLook);
  }
  return turn;
}

}  // namespace

std::string yosys_version(const std::function<void()>& wait) {
  const auto said = output_of({program(), "-V"}, wait);
  if (!said || said->empty())
    throw Error(fmt::format("{}: not found, or `{} -V` fails, and counting cells needs it: tools/deps test installs it",
                            program(), program()));
  return said->substr(0, said->find('\n'));
}

Synthesis synthesize(const Config& config, const std::function<void()>& wait, bool anew) {
  Synthesis out;
  out.yosys = yosys_version(wait);
  const fs::path path = kept_file(config, out.yosys);
  const auto turn = turn_of(path, wait);
  if (const auto found = anew ? std::nullopt : kept_core(path, cells_of)) {
    out.cells = *found;
    return out;
  }
  const auto start = std::chrono::steady_clock::now();
  fs::path stat = path;
  stat.replace_extension(fmt::format(".{}.stat", getpid()));
  cosim::Process process({program(), "-q", "-p", script(config, stat)});
  bool ok = false;
  while (!process.ended(ok)) {
    if (wait) wait();
    std::this_thread::sleep_for(kLook);
  }
  std::error_code ec;
  if (!ok || !fs::exists(stat, ec)) {
    std::string last = process.said();
    while (!last.empty() && last.back() == '\n') last.pop_back();
    throw Error(fmt::format("yosys fails: {}", last.substr(last.rfind('\n') + 1)));
  }
  out.cells = count(stat);
  fs::remove(stat, ec);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (out.cells.luts == 0) throw Error("yosys: its statistics have no LUT4: it may be too new for kage");
  keep_core(path, to_json(out.cells));
  return out;
}

bool is_synthesized(const Config& config) {
  try {
    return kept_core(kept_file(config, yosys_version({})), cells_of).has_value();
  } catch (const Error&) {
    return false;
  }
}

}  // namespace kage::explore
