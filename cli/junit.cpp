// SPDX-License-Identifier: Apache-2.0
#include "junit.hpp"

#include <fmt/format.h>

#include <utility>

#include "common.hpp"
#include "report/html.hpp"

namespace kage::cli {

using report::escaped;

namespace {

// Room for the totals, which are known last but stand first: what they do not fill is blanks inside the tag.
constexpr std::size_t kTotalsRoom = 120;

}  // namespace

JUnitWriter::JUnitWriter(TempFiles& files, std::string path, const std::string& suite)
    : path_(std::move(path)), suite_(escaped(suite)) {
  if (path_.empty()) return;
  out_.emplace(files, path_);
  *out_ << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  totals_at_ = out_->tellp();
  write_totals();
}

void JUnitWriter::write_totals() {
  std::string text = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\" time=\"{:.3f}\"", tests_,
                                 failures_, skipped_, seconds_);
  text.resize(kTotalsRoom, ' ');
  *out_ << "<testsuite name=\"" << suite_ << "\" " << text << ">\n";
}

void JUnitWriter::open_case(const std::string& name, double seconds, const std::string& file) {
  ++tests_;
  seconds_ += seconds;
  *out_ << fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", suite_, escaped(name), seconds);
  if (!file.empty()) *out_ << " file=\"" << escaped(file) << '"';
}

void JUnitWriter::pass(const std::string& name, double seconds) {
  if (path_.empty()) return;
  open_case(name, seconds);
  *out_ << "/>\n";
}

void JUnitWriter::fail(const std::string& name, double seconds, const std::string& message, const std::string& details,
                       const std::string& file) {
  if (path_.empty()) return;
  ++failures_;
  open_case(name, seconds, file);
  *out_ << ">\n    <failure type=\"different\" message=\"" << escaped(message) << "\">" << escaped(details)
        << "</failure>\n  </testcase>\n";
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

}  // namespace kage::cli
