// SPDX-License-Identifier: Apache-2.0
#include "explore/placement.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "cosim/model/process.hpp"
#include "explore/kept_core.hpp"
#include "file/read_file.hpp"
#include "json/foreign_json.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::explore {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Between two looks at a program that runs.
constexpr std::chrono::milliseconds kLook{20};

fs::path program() { return data_directory() / "tools/fpga"; }

/// Runs tools/fpga; returns whether its exit code is 0, and what it says.
std::pair<bool, std::string> run(const std::vector<std::string>& arguments, const std::function<void()>& wait) {
  std::vector<std::string> command{program().string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  cosim::Process process(command);
  bool ok = false;
  while (!process.ended(ok)) {
    wait();
    std::this_thread::sleep_for(kLook);
  }
  return {ok, process.said()};
}

/// The line with which tools/fpga ends in trouble; the last one if there is none.
std::string trouble_of(const std::string& said) {
  std::string last = "tools/fpga says nothing";
  std::size_t begin = 0;
  while (begin < said.size()) {
    const std::size_t end = std::min(said.find('\n', begin), said.size());
    const std::string line = said.substr(begin, end - begin);
    if (!line.empty()) last = line;
    begin = end + 1;
  }
  return last;
}

/// A folder that goes with the object, with all that is in it.
class WorkFolder {
 public:
  explicit WorkFolder(fs::path path) : path_(std::move(path)) { fs::create_directory(path_); }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

fs::path kept_file(const Config& config, const std::string& device, const std::string& versions) {
  std::vector<std::string> besides{device, versions};
  for (const fs::path& file : data_files("tools/fpga_flow", ".py")) besides.push_back(read_file(file));
  for (const char* file : {"constraints/devices.yaml", "constraints/wrap.sv"})
    besides.push_back(read_file(data_directory() / file));
  return kept_core_file("placed", config, besides);
}

Placement placement_of(const Json& j) {
  Placement out;
  if (!j.at("mhz").is_null()) out.mhz = j.at("mhz").get<double>();
  out.not_placed = j.at("not_placed").get<std::string>();
  return out;
}

Json to_json(const Placement& placement) {
  return {{"mhz", placement.mhz ? Json(*placement.mhz) : Json(nullptr)}, {"not_placed", placement.not_placed}};
}

/// Reads what `tools/fpga --core-only --json` has written.
Placement read_figures(const fs::path& path) {
  try {
    const Json j = read_json(path);
    Placement out;
    if (j.at("clock_mhz").is_null())
      out.not_placed = j.at("not_placed").get<std::string>();
    else
      out.mhz = j.at("clock_mhz").at("median").get<double>();
    return out;
  } catch (const Json::exception& e) {
    throw Error(fmt::format("tools/fpga: its figures are not to be read: {}", e.what()));
  }
}

}  // namespace

Placer::Placer(std::string device, std::function<void()> wait) : device_(std::move(device)), wait_(std::move(wait)) {
  std::error_code error;
  if (!fs::exists(program(), error))
    throw Error(
        fmt::format("--place: there is no {}: cores are placed by a kage in its source tree", program().string()));
  const auto [ok, said] = run({device_, "--versions", "--tools", "any"}, wait_);
  if (!ok) throw Error(fmt::format("--place {}: {}", device_, trouble_of(said)));
  versions_ = said;
}

std::size_t Placer::expect(const std::vector<Config>& cores) {
  const std::lock_guard lock(mutex_);
  std::set<fs::path> missing;
  for (const Config& config : cores) {
    const fs::path path = kept_file(config, device_, versions_);
    if (!kept_core(path, placement_of)) missing.insert(path);
  }
  expected_ = missing.size();
  return expected_;
}

std::string Placer::how_far(double seconds) const {
  std::string text = fmt::format("core {} of {}, {:.0f} s", placed_ + 1, std::max(expected_, placed_ + 1), seconds);
  if (placed_ > 0 && expected_ > placed_) {
    const double all = seconds_ / static_cast<double>(placed_) * static_cast<double>(expected_ - placed_);
    text += fmt::format(", some {:.0f} min left for cores", std::max(0.0, all - seconds) / 60);
  }
  return text;
}

Placement Placer::place(const Config& config, const std::function<void(const std::string&)>& progress) {
  const std::lock_guard lock(mutex_);
  const fs::path path = kept_file(config, device_, versions_);
  if (const auto found = kept_core(path, placement_of)) return *found;
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  fs::path folder = path;
  const WorkFolder work(folder.replace_extension(fmt::format(".{}", getpid())));
  const fs::path core = work.path() / "core.yaml";
  const fs::path figures = work.path() / "figures.json";
  std::ofstream(core) << to_yaml(config);
  const auto [ok, said] = run({device_, core.string(), "--core-only", "--tools", "any", "--out",
                               (work.path() / "run").string(), "--json", figures.string()},
                              [&] {
                                wait_();
                                progress(how_far(seconds()));
                              });
  std::error_code error;
  if (!ok && !fs::exists(figures, error)) throw Error(fmt::format("--place {}: {}", device_, trouble_of(said)));
  const Placement placement = read_figures(figures);
  keep_core(path, to_json(placement));
  ++placed_;
  seconds_ += seconds();
  return placement;
}

}  // namespace kage::explore
