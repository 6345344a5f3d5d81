// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/html.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <fstream>

#include "file/read_file.hpp"
#include "json/json_text.hpp"
#include "kage/defs.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage::report {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

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

std::string script_text(const Json& json) {
  std::string text;
  for (const char c : json_text(json)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

Json meanings() {
  Json j = Json::object();
  for (const ParamInfo& p : kParams) j[std::string(p.name)] = p.doc;
  return j;
}

Html::Html(std::string_view title, std::string_view plain, const std::string& body,
           const std::vector<std::string>& scripts, const OwnParts& own) {
  const fs::path source = data_directory() / "verif/cosim/report/page";
  std::string html = read_file(source / "page.html");
  const auto find = [&](std::string_view mark) {
    const auto at = html.find(mark);
    if (at == std::string::npos) throw Error(fmt::format("{}: has no {}", (source / "page.html").string(), mark));
    return at;
  };
  const auto put = [&](std::string_view mark, const std::string& text) { html.replace(find(mark), mark.size(), text); };
  const auto part = [&](const std::string& name) {
    const fs::path first = data_directory() / own.folder / name;
    return read_file(!own.folder.empty() && fs::exists(first) ? first : source / name);
  };
  // The page's own parts first: what comes from outside is put where no mark is looked for any more, or is escaped,
  // and has none.
  std::string all;
  for (const std::string& script : scripts) all += part(script + ".js");
  put("/* scripts */", all);
  put("<!-- body -->", part(body + ".html"));
  put("/* style */", read_file(source / "page.css") + (own.style.empty() ? "" : part(own.style + ".css")));
  put("/* pictures */", own.pictures_beside ? " 'self' file:" : "");
  put("<!-- noscript -->", escaped(plain));
  put("<!-- title -->", escaped(title));
  constexpr std::string_view kMark = "<!-- data -->";
  const auto at = find(kMark);
  before_ = html.substr(0, at);
  after_ = html.substr(at + kMark.size());
}

void Html::write(std::ostream& out, const std::function<void(std::ostream&)>& data) const {
  out << before_;
  data(out);
  out << after_;
}

std::string checksum(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return {};
  std::array<char, 1 << 16> piece{};
  uLong sum = crc32(0, nullptr, 0);
  do {
    in.read(piece.data(), piece.size());
    sum = crc32(sum, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(in.gcount()));
  } while (in);
  return in.eof() ? fmt::format("{:08x}", sum) : std::string();
}

}  // namespace kage::report
