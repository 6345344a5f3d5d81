// SPDX-License-Identifier: Apache-2.0
//
// Statements of the files of Wavefront, OBJ and MTL: a keyword and its words, up to the end of a line or a comment. A
// backslash that is the last byte of a line joins the next line to it. Within a comment it joins nothing, nor does one
// right before a comment, which is passed over.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/plain/text_lines.hpp"

namespace kage::scene {

class Statements : public TextLines {
 public:
  using TextLines::TextLines;

  /// Goes to the next statement, passing over lines without one. False at the end. Messages name its first line.
  bool next_statement();

  [[nodiscard]] std::string_view keyword() const { return keyword_; }
  /// The next word, empty at the end of the statement.
  std::string_view word() { return take_word(words_); }
  /// All behind the keyword: one name, blanks and # within it too.
  [[nodiscard]] std::string_view name() const { return name_; }

 private:
  std::string_view joined();

  std::string joined_;
  std::string_view keyword_;
  std::string_view words_;
  std::string_view name_;
};

/// A name without the comment that a # behind a blank may begin.
std::string_view without_comment(std::string_view name);

/// Words that a file has and kage passes over, each with the first line that has it.
class IgnoredWords {
 public:
  void add(std::string word, std::size_t line) { first_.try_emplace(std::move(word), line); }
  /// A sentence on them, if there are any. `file`: the file's name.
  void note(const std::string& file, std::vector<std::string>& notes) const;

 private:
  std::map<std::string, std::size_t> first_;
};

}  // namespace kage::scene
