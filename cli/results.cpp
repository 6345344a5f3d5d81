// SPDX-License-Identifier: Apache-2.0
#include "results.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <set>
#include <system_error>

#include "file/inputs.hpp"
#include "file/plain_io.hpp"
#include "file/real_path.hpp"
#include "json/json_text.hpp"
#include "kage/error.hpp"

namespace kage::cli {
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

bool json_only(const std::string& json) { return is_standard_output(json); }

void check_output(const std::string& path) {
  if (path.empty()) return;
  TempFiles file;
  const OutputFile probe(file, path);
  expect_output(path);
}

void reads_files(const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) keep_input(input);
}

void check_json(const cosim::SourceOptions& options, const std::string& json) {
  reads_files({options.input, options.config});
  check_output(file_named(json));
}

void print_whole(const std::string& text) {
  if (text.empty()) return;
  errno = 0;
  const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!whole) throw std::system_error(errno != 0 ? errno : EIO, std::generic_category());
}

void finish(const std::string& json, const Document& document, TempFiles& files, const std::string& text) {
  const std::string whole = json_text(document.json(), 2) + "\n";
  if (!json.empty() && !json_only(json)) write_text(files, json, whole);
  files.place();
  const std::string& said = json_only(json) ? whole : text;
  try {
    print_whole(said);
  } catch (const std::system_error& e) {
    fail_write("standard output", e.code().value());
  }
  files.settle();
}

void write_json(const std::string& json, const Document& document, TempFiles& files) {
  finish(json, document, files, "");
}

void write_json(const std::string& json, const Document& document) {
  TempFiles files;
  write_json(json, document, files);
}

void refuse_twice(const std::vector<std::string>& paths) {
  std::set<std::filesystem::path> seen;
  for (const std::string& path : paths)
    if (!path.empty() && !is_device(path) && !seen.insert(real_path(path)).second)
      throw Error(fmt::format("{}: two outputs have this name", path));
}

}  // namespace kage::cli
