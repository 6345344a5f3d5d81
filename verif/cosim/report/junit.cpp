// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/junit.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <utility>

#include "cosim/report/html.hpp"

namespace kage::report {
namespace {

// Room for the totals, which are known last but stand first: what they do not fill is blanks behind the tag.
constexpr std::size_t kTotalsRoom = 120;

/// The machine, and the time at which the run began, as JUnit has them: UTC without a zone.
std::string where_and_when() {
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> time{};
  std::strftime(time.data(), time.size(), "%Y-%m-%dT%H:%M:%S", &utc);
  return fmt::format(" timestamp=\"{}\" hostname=\"{}\"", time.data(), escaped(host.data()));
}

}  // namespace

JUnitWriter::JUnitWriter(TempFiles& files, std::string path, const std::string& suite)
    : path_(std::move(path)), suite_(escaped(suite)), class_(suite_) {
  std::replace(class_.begin(), class_.end(), ' ', '.');
  if (path_.empty()) return;
  where_and_when_ = where_and_when();
  out_.emplace(files, path_);
  *out_ << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  totals_at_ = out_->tellp();
  write_totals();
}

void JUnitWriter::write_totals() {
  const std::string text = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\"",
                                       tests_, failures_, errors_, skipped_, seconds_);
  const std::string rest(kTotalsRoom - std::min(kTotalsRoom, text.size()), ' ');
  *out_ << "<testsuite name=\"" << suite_ << "\" " << text << where_and_when_ << ">" << rest << "\n";
}

void JUnitWriter::group(const std::string& name) {
  std::string part = name;
  std::replace_if(
      part.begin(), part.end(), [](char c) { return c == '.' || c == ' ' || c == '/'; }, '_');
  class_ = suite_ + "." + escaped(part);
  std::replace(class_.begin(), class_.end(), ' ', '.');
}

void JUnitWriter::open_case(const std::string& name, double seconds, const std::string& file) {
  ++tests_;
  seconds_ += seconds;
  *out_ << fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", class_, escaped(name), seconds);
  if (!file.empty()) *out_ << " file=\"" << escaped(file) << '"';
}

void JUnitWriter::pass(const std::string& name, double seconds, const std::string& remark) {
  if (path_.empty()) return;
  open_case(name, seconds);
  if (remark.empty())
    *out_ << "/>\n";
  else
    *out_ << ">\n    <system-out>" << escaped(remark) << "</system-out>\n  </testcase>\n";
}

void JUnitWriter::fail(const std::string& name, double seconds, const std::string& message, const std::string& details,
                       const std::string& file) {
  if (path_.empty()) return;
  ++failures_;
  open_case(name, seconds, file);
  *out_ << ">\n    <failure type=\"different\" message=\"" << escaped(message) << "\">" << escaped(details)
        << "</failure>\n  </testcase>\n";
}

void JUnitWriter::error(const std::string& name, const std::string& message) {
  if (path_.empty()) return;
  ++errors_;
  open_case(name, 0);
  *out_ << ">\n    <error type=\"trouble\" message=\"" << escaped(message) << "\"/>\n  </testcase>\n";
}

void JUnitWriter::skip(const std::string& name, const std::string& message) {
  if (path_.empty()) return;
  ++skipped_;
  open_case(name, 0);
  *out_ << ">\n    <skipped message=\"" << escaped(message) << "\"/>\n  </testcase>\n";
}

void JUnitWriter::close() {
  if (path_.empty()) return;
  *out_ << "</testsuite>\n</testsuites>\n";
  out_->seekp(totals_at_);
  write_totals();
  out_->close();
}

}  // namespace kage::report
