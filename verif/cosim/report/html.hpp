// SPDX-License-Identifier: Apache-2.0
//
// Parts of all report pages: one frame of HTML with one style, and scripts (page/, read at run time).
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "cosim/report/run_record.hpp"

namespace kage::report {

/// No page is larger.
inline constexpr std::size_t kPageBytes = 10'000'000;

/// Text for HTML or XML, between quotes too. Characters that XML cannot hold, and bytes that are no UTF-8, become
/// U+FFFD.
std::string escaped(std::string_view text);

/// As text that may stand in a script: a '<' could end it. Bytes that are no UTF-8 (names of files) are replaced.
std::string script_text(const Json& json);

/// Meaning of each parameter of a configuration.
Json meanings();

/// Parts of a page that the report pages lack.
struct OwnParts {
  std::string folder{};          ///< below that of the data: a body or a script is looked for here first
  std::string style{};           ///< the name of a file there, without .css, which comes behind page.css
  bool pictures_beside = false;  ///< pictures may be files beside the page
};

/// A page but for its data.
class Html {
 public:
  /// `title` is any text, `plain` what is to be read without JavaScript; `body` and `scripts` are names of files in
  /// page/, without .html and .js. Throws Error that names a file.
  Html(std::string_view title, std::string_view plain, const std::string& body, const std::vector<std::string>& scripts,
       const OwnParts& own = {});

  [[nodiscard]] std::size_t bytes() const { return before_.size() + after_.size(); }

  /// The page, with what `data` writes, one JSON object, in its place.
  void write(std::ostream& out, const std::function<void(std::ostream&)>& data) const;

 private:
  std::string before_;
  std::string after_;
};

/// CRC-32 of a page's bytes, in hexadecimal: by it a link is told from one to another run's page of that name. "" if
/// the file cannot be read.
std::string checksum(const std::filesystem::path& path);

}  // namespace kage::report
