// SPDX-License-Identifier: Apache-2.0
#include "junit.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "common.hpp"
#include "kage/error.hpp"

namespace kage::cli {
namespace {

// Room for the totals, which are known last but stand first: what they do not fill is blanks inside the tag.
constexpr std::size_t kTotalsRoom = 120;

/// Length of the UTF-8 character at the beginning of `text` that XML may hold, 0 if there is none.
std::size_t character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return lead >= 0x20 || lead == '\n' || lead == '\t' ? 1 : 0;
  const std::size_t length = lead >= 0xF5 ? 0 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC2 ? 2 : 0;
  if (length == 0 || text.size() < length) return 0;
  std::uint32_t code = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3FU);
  }
  const std::uint32_t least = length == 4 ? 0x10000 : length == 3 ? 0x800 : 0x80;
  const bool legal = code >= least && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF) && (code & ~1U) != 0xFFFE;
  return legal ? length : 0;
}

std::string escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = character(text);
    const char c = text.front();
    if (length == 0)
      out += "\xEF\xBF\xBD";
    else if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

}  // namespace

JUnitWriter::JUnitWriter(TempFiles& files, std::string path, const std::string& suite)
    : path_(std::move(path)), suite_(escaped(suite)) {
  if (path_.empty()) return;
  out_ = open_file(files, path_);
  out_ << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  totals_at_ = out_.tellp();
  write_totals();
}

void JUnitWriter::write_totals() {
  std::string text = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\" time=\"{:.3f}\"", tests_,
                                 failures_, skipped_, seconds_);
  text.resize(kTotalsRoom, ' ');
  out_ << "<testsuite name=\"" << suite_ << "\" " << text << ">\n";
}

void JUnitWriter::open_case(const std::string& name, double seconds, const std::string& file) {
  ++tests_;
  seconds_ += seconds;
  out_ << fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"", suite_, escaped(name), seconds);
  if (!file.empty()) out_ << " file=\"" << escaped(file) << '"';
}

void JUnitWriter::pass(const std::string& name, double seconds) {
  if (path_.empty()) return;
  open_case(name, seconds);
  out_ << "/>\n";
}

void JUnitWriter::fail(const std::string& name, double seconds, const std::string& message, const std::string& details,
                       const std::string& file) {
  if (path_.empty()) return;
  ++failures_;
  open_case(name, seconds, file);
  out_ << ">\n    <failure type=\"different\" message=\"" << escaped(message) << "\">" << escaped(details)
       << "</failure>\n  </testcase>\n";
}

void JUnitWriter::skip(const std::string& name, const std::string& message) {
  if (path_.empty()) return;
  ++skipped_;
  open_case(name, 0);
  out_ << ">\n    <skipped message=\"" << escaped(message) << "\"/>\n  </testcase>\n";
}

void JUnitWriter::close() {
  if (path_.empty()) return;
  out_ << "</testsuite>\n</testsuites>\n";
  out_.seekp(totals_at_);
  write_totals();
  errno = 0;
  out_.close();
  if (!out_) throw Error(fmt::format("{}: cannot be written: {}", path_, std::strerror(errno)));
}

}  // namespace kage::cli
