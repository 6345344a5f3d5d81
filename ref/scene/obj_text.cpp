// SPDX-License-Identifier: Apache-2.0
#include "obj_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <limits>
#include <streambuf>
#include <string_view>
#include <utility>

#include "kage/error.hpp"
#include "notes.hpp"

namespace kage::scene {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";

/// The next word of `rest`, which loses it; empty at the end.
std::string_view take_word(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

/// The rest of a statement without the blanks round it: all of it is one name, blanks within it too.
std::string name_in(std::string_view rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  rest.remove_suffix(rest.size() - std::min(rest.find_last_not_of(kBlanks) + 1, rest.size()));
  return std::string(rest);
}

/// The number with which a corner, "3/1/2", names its vertex: from 1, or back from the last one, as -1. 0 for a word
/// that is no number.
std::int64_t vertex_of(std::string_view word) {
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc::result_out_of_range) return value;
  return word.front() == '-' ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
}

bool is_numbers(std::string_view keyword) {
  constexpr std::array<std::string_view, 7> kKeywords{"v", "vt", "vn", "vp", "f", "l", "p"};
  return std::find(kKeywords.begin(), kKeywords.end(), keyword) != kKeywords.end();
}

/// What Assimp takes for a number, by its beginning.
bool begins_number(std::string_view word) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  if (word.front() == '+' || word.front() == '-') word.remove_prefix(1);
  if (word.size() > 1 && word.front() == '.') return digit(word[1]);
  if (!word.empty() && digit(word.front())) return true;
  std::string begin(word.substr(0, 3));
  for (char& c : begin) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return begin == "nan" || begin == "inf";  // refused later, as the vertex that it is
}

class Plain {
 public:
  Plain(std::streambuf& in, const std::string& name) : in_(in), name_(name) {}

  ObjText run() {
    while (read_statement()) write_statement();
    for (const Ahead& a : ahead_)
      if (a.vertex > vertices_) fail_vertex(a.line, a.vertex);
    return std::move(obj_);
  }

 private:
  /// Up to the next line feed, carriage return or both. False at the end.
  bool read_line(std::string& line) {
    constexpr int kEnd = std::streambuf::traits_type::eof();
    line.clear();
    int c = in_.sbumpc();
    if (c == kEnd) return false;
    for (; c != kEnd && c != '\n' && c != '\r'; c = in_.sbumpc()) line += static_cast<char>(c);
    if (c == '\r' && in_.sgetc() == '\n') in_.sbumpc();
    ++lines_;
    return true;
  }

  /// A line and those that continue it.
  bool read_statement() {
    if (!read_line(statement_)) return false;
    if (lines_ == 1 && statement_.starts_with("\xEF\xBB\xBF")) statement_.erase(0, 3);
    at_ = lines_;
    std::string next;
    for (bool more = true; more;) {
      more = !end_comment() && statement_.ends_with('\\');
      if (!more) continue;
      statement_.back() = ' ';
      more = read_line(next);
      if (more) statement_ += next;
    }
    return true;
  }

  /// Whether there is a comment, which ends a statement: a backslash in it continues nothing. It goes, but where it may
  /// be part of a name.
  bool end_comment() {
    std::string_view rest = statement_;
    const std::string_view keyword = take_word(rest);
    const bool numbers = is_numbers(keyword);
    const std::size_t begin = keyword.starts_with('#') ? 0 : statement_.find(numbers ? "#" : " #");
    if (begin == std::string::npos) return false;
    if (begin == 0 || numbers) statement_.resize(begin);
    if (statement_.ends_with('\\')) statement_ += ' ';  // Assimp is not to continue it either
    return true;
  }

  void write_statement() {
    std::string_view rest = statement_;
    const std::string_view keyword = take_word(rest);
    obj_.text += keyword;
    if (is_numbers(keyword))
      write_numbers(rest, keyword);
    else if (keyword == "mtllib")
      write_library(name_in(rest));
    else
      obj_.text += rest;
    obj_.text += '\n';
    if (keyword == "usemtl") obj_.materials.insert(name_in(rest));
  }

  /// Without blanks behind it, with which Assimp would look for the file.
  void write_library(std::string file) {
    obj_.text += " " + file;
    if (!file.empty() && std::find(obj_.libraries.begin(), obj_.libraries.end(), file) == obj_.libraries.end())
      obj_.libraries.push_back(std::move(file));
  }

  void write_numbers(std::string_view rest, std::string_view keyword) {
    const bool vertex = keyword == "v";
    const bool corners = keyword == "f" || keyword == "l" || keyword == "p";
    int count = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++count) {
      if (vertex && !begins_number(word)) fail(fmt::format("{} is not a number", one_line(word, 40)));
      if (corners) check_corner(word);
      obj_.text += word.front() == '.' ? " 0" : " ";
      obj_.text += word;
    }
    vertices_ += vertex ? 1 : 0;
    if (vertex && count != 3 && count != 4 && count != 6)
      fail(fmt::format("a vertex has 3 numbers, 4 with w or 6 with a colour, not {}", count));
  }

  /// A vertex may come after the face that names it, so one that is not there yet is looked for at the end. Of those
  /// only what is above all before it is kept: the first that is not there at the end is among them.
  void check_corner(std::string_view word) {
    const std::int64_t vertex = vertex_of(word);
    if (vertex == 0) fail(fmt::format("{} is no vertex's number", one_line(word, 40)));
    if (vertex < -vertices_) fail_vertex(at_, vertex);
    if (vertex > vertices_ && (ahead_.empty() || vertex > ahead_.back().vertex)) ahead_.push_back({at_, vertex});
  }

  [[noreturn]] void fail_vertex(std::size_t line, std::int64_t vertex) const {
    throw Error(fmt::format("{}: line {}: vertex {} of {} is named", name_, line, vertex, vertices_));
  }

  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(fmt::format("{}: line {}: {}", name_, at_, cause));
  }

  struct Ahead {
    std::size_t line;
    std::int64_t vertex;
  };

  std::streambuf& in_;
  const std::string& name_;
  ObjText obj_;
  std::vector<Ahead> ahead_;   // vertices that were named before they came, ascending
  std::int64_t vertices_ = 0;  // so far
  std::string statement_;
  std::size_t lines_ = 0;  // read so far
  std::size_t at_ = 0;     // the statement's first
};

}  // namespace

ObjText plain_obj(std::istream& in, const std::string& name) { return Plain(*in.rdbuf(), name).run(); }

std::set<std::string> material_names(std::istream& in) {
  std::set<std::string> names;
  for (std::string line; std::getline(in, line);) {
    std::replace(line.begin(), line.end(), '\r', ' ');
    std::string_view rest = line;
    if (take_word(rest) == "newmtl") names.insert(name_in(rest));
  }
  return names;
}

}  // namespace kage::scene
