// SPDX-License-Identifier: Apache-2.0
//
// A run's results: JSON, the files that appear together at its end, and the folder they are in.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "cosim/report/run_record.hpp"
#include "file/out_folder.hpp"
#include "file/temp_file.hpp"
#include "options.hpp"

namespace kage::cli {

using report::Json;
using report::to_json;

/// A document that --json writes. It names its schema by its first key; a list does in each of its entries. The schema
/// of "kage.list/1" is docs/schema/list.json.
class Document {
 public:
  Document(std::string_view schema, const Json& value);
  Document(const report::RunRecord& record) : json_(to_json(record)) {}  // NOLINT(google-explicit-constructor)
  [[nodiscard]] const Json& json() const { return json_; }

 private:
  Json json_;
};

/// The file that an output's name means: none, if that is empty or -, standard output.
std::string file_named(const std::string& output);

/// Whether `--json` is -, which claims standard output for itself.
bool json_only(const std::string& json);

/// Throws Error if a file cannot be written, or is an input, one that is read later too: before the work, not after it.
/// An empty path is none.
void check_output(const std::string& path);

/// The same of what --json names, which reads_files() the scene's file and the configuration's too.
void check_json(const cosim::SourceOptions& options, const std::string& json);

/// keep_input() for each. Names of no file (a built-in scene, a named configuration) are none.
void reads_files(const std::vector<std::string>& inputs);

/// Writes to standard output, whole. Throws std::system_error with the cause if it cannot.
void print_whole(const std::string& text);

/// Ends a run: writes `document` where --json says, if it was given, gives all of `files` their names, and prints
/// `text` unless JSON has standard output. All appear or none: if standard output fails, files are as they were.
void finish(const std::string& json, const Document& document, TempFiles& files, const std::string& text);

/// The same for a run that prints on its own.
void write_json(const std::string& json, const Document& document, TempFiles& files);
void write_json(const std::string& json, const Document& document);

/// Throws Error if two of the files that are to be written, by whatever name, are one. Empty paths are none, and a
/// device or a pipe may be named more than once, because what it gets replaces nothing.
void refuse_twice(const std::vector<std::string>& paths);

}  // namespace kage::cli
