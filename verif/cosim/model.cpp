// SPDX-License-Identifier: Apache-2.0
#include "cosim/model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <system_error>
#include <thread>
#include <vector>

#include "cosim/lock.hpp"
#include "cosim/model_cache.hpp"
#include "cosim/process.hpp"
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
      throw Error(fmt::format("{}: no such fault (there are {})", fault, fmt::join(fault_names(), ", ")));
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

/// What the cache says of a model, for `kage cache list`.
nlohmann::ordered_json about(const Config& config, const ModelOptions& options) {
  nlohmann::ordered_json values;
  for (const ParamInfo& p : kParams) values[std::string(p.name)] = config.*(p.member);
  return {{"config", values},
          {"fault", options.fault},
          {"traced", options.traced},
          {"mutants", options.mutants},
          {"tools", model_tools()}};
}

}  // namespace

Model find_model(const Config& config, const ModelOptions& options) {
  const fs::path data = data_directory();
  const ModelCache cache;
  const std::vector<fs::path> files = sources(data, options);
  std::string damage;
  // A model that is there and whole.
  const auto find = [&](const std::string& key) {
    const std::optional<std::string> found = cache.damage(key);
    damage = found.value_or("");
    if (!found || !damage.empty()) return false;
    cache.use(key);
    return true;
  };
  const std::string now = key_of(data, files, config, options);
  HiddenFolder::sweep(cache.folder());  // of builds that were killed
  if (find(now)) return {.library = cache.library(now)};

  // What is built is a copy: someone may change the RTL meanwhile, and the model must be of what its name says.
  const HiddenFolder hidden = work_folder(cache.folder());
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
  cache.keep(key, work / "model.so", about(config, options));
  return {.library = cache.library(key),
          .build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          .damage = damage};
}

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator(data_directory() / "verif/faults", ec))
    if (entry.path().extension() == ".patch") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> model_tools() {
  const auto line = [](const std::string& text) { return text.substr(0, text.find('\n')); };
  return {line(verilator_version()), line(compiler_version())};
}

}  // namespace kage::cosim
