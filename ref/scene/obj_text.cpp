// SPDX-License-Identifier: Apache-2.0
#include "obj_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
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

  std::string run() {
    while (read_statement()) write_statement();
    return std::move(out_);
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
    out_ += keyword;
    if (is_numbers(keyword))
      write_numbers(rest, keyword == "v");
    else
      out_ += rest;
    out_ += '\n';
  }

  void write_numbers(std::string_view rest, bool vertex) {
    int count = 0;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest), ++count) {
      if (vertex && !begins_number(word)) fail(fmt::format("{} is not a number", one_line(word, 40)));
      out_ += word.front() == '.' ? " 0" : " ";
      out_ += word;
    }
    if (vertex && count != 3 && count != 4 && count != 6)
      fail(fmt::format("a vertex has 3 numbers, 4 with w or 6 with a colour, not {}", count));
  }

  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(fmt::format("{}: line {}: {}", name_, at_, cause));
  }

  std::streambuf& in_;
  const std::string& name_;
  std::string out_;
  std::string statement_;
  std::size_t lines_ = 0;  // read so far
  std::size_t at_ = 0;     // the statement's first
};

}  // namespace

std::string plain_obj(std::istream& in, const std::string& name) { return Plain(*in.rdbuf(), name).run(); }

}  // namespace kage::scene
