// SPDX-License-Identifier: Apache-2.0
#include "scene/plain/statements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "number/counted.hpp"
#include "scene/notes.hpp"

namespace kage::scene {
namespace {

constexpr std::size_t kNamedWords = 8;  // so many words are named

/// Whether a # within a word behind this keyword is part of a name.
bool has_name(std::string_view keyword) {
  constexpr std::array<std::string_view, 5> kNames{"o", "g", "usemtl", "mtllib", "newmtl"};
  return std::find(kNames.begin(), kNames.end(), keyword) != kNames.end();
}

/// Where the comment of a statement begins, its size if there is none. The first `clean` bytes have none.
std::size_t comment_of(std::string_view statement, std::size_t clean = 0) {
  std::size_t hash = statement.find('#', clean);
  if (hash == std::string_view::npos) return statement.size();
  std::string_view rest = statement;
  if (!has_name(take_word(rest))) return hash;
  while (hash != std::string_view::npos && hash > 0 && kBlanks.find(statement[hash - 1]) == std::string_view::npos)
    hash = statement.find('#', hash + 1);
  return std::min(hash, statement.size());
}

}  // namespace

std::string_view without_comment(std::string_view name) {
  std::size_t hash = name.find('#');
  while (hash != std::string_view::npos && (hash == 0 || kBlanks.find(name[hash - 1]) == std::string_view::npos))
    hash = name.find('#', hash + 1);
  return trimmed(name.substr(0, std::min(hash, name.size())));
}

/// The line, and those that continue it.
std::string_view Statements::joined() {
  std::size_t clean = 0;
  const auto goes_on = [&clean](std::string_view s) { return s.ends_with('\\') && comment_of(s, clean) == s.size(); };
  if (!goes_on(line())) return line();
  const std::size_t first = at();
  joined_ = line();
  while (goes_on(joined_)) {
    joined_.back() = ' ';
    clean = joined_.size();
    if (next()) joined_ += line();
  }
  set_at(first);
  return joined_;
}

bool Statements::next_statement() {
  while (next()) {
    const std::string_view statement = joined();
    const std::size_t comment = comment_of(statement);
    words_ = trimmed(statement.substr(0, comment));
    if (comment < statement.size() && words_.ends_with('\\')) words_.remove_suffix(1);
    keyword_ = take_word(words_);
    if (keyword_.empty()) continue;
    name_ = trimmed(statement.substr(static_cast<std::size_t>(keyword_.data() + keyword_.size() - statement.data())));
    return true;
  }
  return false;
}

void IgnoredWords::note(const std::string& file, std::vector<std::string>& notes) const {
  if (first_.empty()) return;
  std::vector<std::pair<std::size_t, std::string>> words;
  for (const auto& [word, line] : first_) words.emplace_back(line, word);
  std::sort(words.begin(), words.end());
  const std::string of = " of " + one_line(file, 120);
  std::string text = counted(words.size(), "word" + of + " is ignored:", "words" + of + " are ignored:");
  for (std::size_t i = 0; i < std::min(words.size(), kNamedWords); ++i)
    text += fmt::format("{}{} (line {})", i == 0 ? " " : ", ", one_line(words[i].second, 40), words[i].first);
  if (words.size() > kNamedWords) text += fmt::format(" and {} more", words.size() - kNamedWords);
  notes.push_back(std::move(text));
}

}  // namespace kage::scene
