// SPDX-License-Identifier: Apache-2.0
//
// Results as JUnit XML, the form that continuous integration reads.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "file/temp_file.hpp"

namespace kage::report {

/// Writes one test suite, case by case: memory does not grow with their number. The file gets its name with the others
/// of the run; one that ends in trouble leaves none. Any text may be given: what XML cannot hold becomes U+FFFD.
class JUnitWriter {
 public:
  /// `suite` is a command, as "kage cosim". Without a path nothing is written. Throws Error if the file cannot be
  /// written.
  JUnitWriter(TempFiles& files, std::string path, const std::string& suite);

  /// The following cases are of this scene or sort of file: their classname is "kage.cosim.SCENE", by which CI's pages
  /// sort them into packages, so dots, blanks and slashes of `name` become underscores.
  void group(const std::string& name);

  /// `remark` is what is to be said of it, if anything.
  void pass(const std::string& name, double seconds, const std::string& remark = "");

  /// `message` is one line, `details` any text. `file` is that which is to blame, if any.
  void fail(const std::string& name, double seconds, const std::string& message, const std::string& details = "",
            const std::string& file = "");

  /// A case that came to no result; `message` is one line.
  void error(const std::string& name, const std::string& message);

  /// A case that was not run.
  void skip(const std::string& name, const std::string& message);

  /// After the last case. Throws Error if the file could not be written.
  void close();

 private:
  void open_case(const std::string& name, double seconds, const std::string& file = "");
  void write_totals();

  std::string path_;
  std::optional<OutputFile> out_;
  std::string suite_;
  std::string class_;
  std::string where_and_when_;
  std::streamoff totals_at_ = 0;
  std::uint64_t tests_ = 0;
  std::uint64_t failures_ = 0;
  std::uint64_t errors_ = 0;
  std::uint64_t skipped_ = 0;
  double seconds_ = 0;
};

}  // namespace kage::report
