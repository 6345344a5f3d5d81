// SPDX-License-Identifier: Apache-2.0
#include "results.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <set>
#include <system_error>

#include "file/inputs.hpp"
#include "file/plain_io.hpp"
#include "file/real_path.hpp"
#include "json/json_text.hpp"
#include "kage/error.hpp"

namespace kage::cli {
namespace {

/// The outputs that the run was asked for, as they were named.
struct Checked {
  std::mutex mutex;
  std::vector<std::string> outputs;
};

Checked& checked() {
  static Checked all;
  return all;
}

}  // namespace

Document::Document(std::string_view schema, const Json& value) {
  const auto named = [&](const Json& object) {
    Json j{{"schema", schema}};
    j.update(object);
    return j;
  };
  if (!value.is_array()) {
    json_ = named(value);
    return;
  }
  json_ = Json::array();
  for (const Json& entry : value) json_.push_back(named(entry));
}

std::string file_named(const std::string& output) { return is_standard_output(output) ? "" : output; }

bool json_only(const Options& options) { return is_standard_output(options.json); }

void check_output(const std::string& path) {
  if (path.empty()) return;
  TempFiles file;
  const OutputFile probe(file, path);
  const std::lock_guard lock(checked().mutex);
  checked().outputs.push_back(path);
}

void reads_files(const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) keep_input(input);
  const std::lock_guard lock(checked().mutex);
  for (const std::string& output : checked().outputs)
    if (is_input(output)) throw Error(fmt::format("{}: this output would overwrite an input", output));
}

void check_json(const Options& options) {
  reads_files({options.input, options.config});
  check_output(file_named(options.json));
}

void print_whole(const std::string& text) {
  if (text.empty()) return;
  errno = 0;
  const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!whole) throw std::system_error(errno != 0 ? errno : EIO, std::generic_category());
}

void finish(const Options& options, const Document& document, TempFiles& files, const std::string& text) {
  const std::string json = json_text(document.json(), 2) + "\n";
  if (!options.json.empty() && !json_only(options)) write_text(files, options.json, json);
  files.place();
  const std::string& said = json_only(options) ? json : text;
  try {
    print_whole(said);
  } catch (const std::system_error& e) {
    fail_write("standard output", e.code().value());
  }
  files.settle();
}

void write_json(const Options& options, const Document& document, TempFiles& files) {
  finish(options, document, files, "");
}

void write_json(const Options& options, const Document& document) {
  TempFiles files;
  write_json(options, document, files);
}

OutFolder::OutFolder(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code ec;
  std::vector<fs::path> missing;
  for (fs::path p = path; !p.empty() && !fs::exists(p, ec); p = p.parent_path()) {
    if (fs::is_symlink(p, ec)) throw Error(fmt::format("{}: a link to nowhere", p.string()));
    missing.insert(missing.begin(), p);
  }
  // One by one, so that a failure half-way leaves none: the destructor of a half-made object does not run.
  for (const fs::path& p : missing) {
    if (fs::create_directory(p, ec)) made_.insert(made_.begin(), p);
    if (ec) break;
  }
  if (ec || !fs::is_directory(path, ec)) {
    remove();
    throw Error(fmt::format("{}: the folder cannot be made: {}", path.string(), ec ? ec.message() : "not a folder"));
  }
  if (::access(path.c_str(), W_OK | X_OK) != 0) {
    const int error = errno;
    remove();
    throw Error(fmt::format("{}: cannot be written to: {}", path.string(), std::strerror(error)));
  }
}

OutFolder::~OutFolder() { remove(); }

void OutFolder::remove() {
  for (const std::filesystem::path& p : made_) (void)::rmdir(p.c_str());  // refuses one with something in it
  made_.clear();
}

void refuse_twice(const std::vector<std::string>& paths) {
  std::set<std::filesystem::path> seen;
  for (const std::string& path : paths)
    if (!path.empty() && !is_device(path) && !seen.insert(real_path(path)).second)
      throw Error(fmt::format("{}: two outputs have this name", path));
}

}  // namespace kage::cli
