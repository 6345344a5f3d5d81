// SPDX-License-Identifier: Apache-2.0
#include "extremes/fields.hpp"

#include <fmt/format.h>
#include <rapidcheck.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "kage/error.hpp"

namespace kage::verif {
namespace {

// Whole numbers that a double holds exactly, and that rapidcheck's shrinking of integers is fit for.
bool is_whole(double v) { return std::abs(v) < 0x1p50 && v == std::trunc(v); }

template <class Number>
bool parse(const std::string& text, Number& v) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

// ---- by chance

void DrawFields::on_number(const char* /*name*/, std::int64_t& v, std::int64_t low, std::int64_t high,
                           std::int64_t simple) {
  const double how = random_->real(0, 1);
  v = how < 0.1 ? low : how < 0.2 ? high : how < 0.25 ? simple : random_->integer(low, high);
}

void DrawFields::on_real(const char* /*name*/, double& v, double low, double high, double simple) {
  const double how = random_->real(0, 1);
  v = how < 0.05 ? low : how < 0.1 ? high : how < 0.15 ? simple : random_->real(low, high);
  if (how > 0.9) v = std::clamp(std::round(v), low, high);
}

void DrawFields::on_list(const char* /*name*/, List& list, std::size_t least, std::size_t most) {
  // Short ones more often than long ones.
  const double share = random_->real(0, 1);
  list.resize(least + static_cast<std::size_t>(share * share * static_cast<double>(most - least + 1)));
  for (std::size_t i = 0; i < list.size(); ++i) list.fields_of(i, *this);
}

// ---- into ranges

void ClampFields::on_number(const char* /*name*/, std::int64_t& v, std::int64_t low, std::int64_t high,
                            std::int64_t /*simple*/) {
  v = std::clamp(v, low, high);
}

void ClampFields::on_real(const char* /*name*/, double& v, double low, double high, double /*simple*/) {
  v = std::clamp(v, low, high);
}

void ClampFields::on_list(const char* /*name*/, List& list, std::size_t least, std::size_t most) {
  list.resize(std::clamp(list.size(), least, most));
  for (std::size_t i = 0; i < list.size(); ++i) list.fields_of(i, *this);
}

// ---- changed a little

void MutateFields::on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high,
                             std::int64_t simple) {
  if (!random_->chance(chance_)) return;
  const double how = random_->real(0, 1);
  if (how < 0.25) {
    DrawFields fresh(*random_);
    std::int64_t drawn = v;
    static_cast<Fields&>(fresh).number(name, drawn, low, high, simple);
    v = drawn;
  } else {
    // A step of any size, small ones as likely as large ones.
    const double log = std::log2(static_cast<double>(high - low) + 1);
    const auto step = static_cast<std::int64_t>(std::exp2(random_->real(0, log)));
    v = std::clamp(v + (random_->chance(0.5) ? step : -step), low, high);
  }
}

void MutateFields::on_real(const char* name, double& v, double low, double high, double simple) {
  if (!random_->chance(chance_)) return;
  if (random_->chance(0.2)) {
    DrawFields fresh(*random_);
    fresh.real(name, v, low, high, simple);
  } else {
    const double step = (high - low) * std::exp2(-random_->real(1, 40));
    v = std::clamp(v + (random_->chance(0.5) ? step : -step), low, high);
  }
}

void MutateFields::on_list(const char* /*name*/, List& list, std::size_t least, std::size_t most) {
  if (random_->chance(chance_)) {
    const std::size_t n = list.size();
    if (random_->chance(0.5) && n < most) {
      list.resize(n + 1);
      DrawFields fresh(*random_);
      list.fields_of(n, fresh);
    } else if (n > least) {
      list.erase(static_cast<std::size_t>(random_->integer(0, static_cast<std::int64_t>(n) - 1)), 1);
    }
  }
  for (std::size_t i = 0; i < list.size(); ++i) list.fields_of(i, *this);
}

void CountFields::on_number(const char* /*name*/, std::int64_t& /*v*/, std::int64_t /*low*/, std::int64_t /*high*/,
                            std::int64_t /*simple*/) {
  ++count_;
}

void CountFields::on_real(const char* /*name*/, double& /*v*/, double /*low*/, double /*high*/, double /*simple*/) {
  ++count_;
}

void CountFields::on_list(const char* /*name*/, List& list, std::size_t /*least*/, std::size_t /*most*/) {
  for (std::size_t i = 0; i < list.size(); ++i) list.fields_of(i, *this);
}

// ---- text

void WriteFields::add(const char* name, const std::string& value) {
  text_ += fmt::format("{}{} {}{}", in_list_ ? " " : "", name, value, in_list_ ? "" : "\n");
}

void WriteFields::on_number(const char* name, std::int64_t& v, std::int64_t /*low*/, std::int64_t /*high*/,
                            std::int64_t /*simple*/) {
  add(name, fmt::format("{}", v));
}

void WriteFields::on_real(const char* name, double& v, double /*low*/, double /*high*/, double /*simple*/) {
  add(name, fmt::format("{}", v));  // as many digits as tell it from any other
}

void WriteFields::on_choice(const char* name, int& v, std::span<const char* const> names) {
  add(name, names[static_cast<std::size_t>(v)]);
}

void WriteFields::on_list(const char* name, List& list, std::size_t /*least*/, std::size_t /*most*/) {
  in_list_ = true;
  for (std::size_t i = 0; i < list.size(); ++i) {
    text_ += name;
    list.fields_of(i, *this);
    text_ += '\n';
  }
  in_list_ = false;
}

ReadFields::ReadFields(const std::string& text, std::string name) : name_(std::move(name)) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word;
    while (words >> word) words_.push_back({word, number});
    last_line_ = number;
  }
}

void ReadFields::fail(int line, const std::string& cause) const {
  throw Error(fmt::format("{}:{}: {}", name_, line, cause));
}

void ReadFields::end() const {
  if (at_ < words_.size()) fail(words_[at_].line, fmt::format("\"{}\" is no field of this family", words_[at_].text));
}

const ReadFields::Word& ReadFields::value(const char* name) {
  if (at_ >= words_.size()) fail(last_line_, fmt::format("the file ends where \"{}\" is wanted", name));
  if (words_[at_].text != name)
    fail(words_[at_].line, fmt::format("\"{}\" stands where \"{}\" is wanted", words_[at_].text, name));
  if (at_ + 1 >= words_.size()) fail(words_[at_].line, fmt::format("\"{}\" has no value", name));
  at_ += 2;
  return words_[at_ - 1];
}

void ReadFields::on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high,
                           std::int64_t /*simple*/) {
  const Word& word = value(name);
  if (!parse(word.text, v)) fail(word.line, fmt::format("{}: \"{}\" is no whole number", name, word.text));
  if (v < low || v > high) fail(word.line, fmt::format("{} is {}: it must be {} .. {}", name, v, low, high));
}

void ReadFields::on_real(const char* name, double& v, double low, double high, double /*simple*/) {
  const Word& word = value(name);
  if (!parse(word.text, v)) fail(word.line, fmt::format("{}: \"{}\" is no number", name, word.text));
  if (!(v >= low && v <= high)) fail(word.line, fmt::format("{} is {}: it must be {} .. {}", name, v, low, high));
}

void ReadFields::on_choice(const char* name, int& v, std::span<const char* const> names) {
  const Word& word = value(name);
  const auto found = std::find(names.begin(), names.end(), word.text);
  if (found == names.end()) fail(word.line, fmt::format("{}: \"{}\" is none of its choices", name, word.text));
  v = static_cast<int>(found - names.begin());
}

void ReadFields::on_list(const char* name, List& list, std::size_t least, std::size_t most) {
  list.resize(0);
  while (at_ < words_.size() && words_[at_].text == name) {
    const int line = words_[at_++].line;
    list.resize(list.size() + 1);
    if (list.size() > most) fail(line, fmt::format("more than {} times \"{}\"", most, name));
    list.fields_of(list.size() - 1, *this);
  }
  if (list.size() < least)
    fail(at_ < words_.size() ? words_[at_].line : last_line_, fmt::format("fewer than {} times \"{}\"", least, name));
}

// ---- simpler

std::vector<Edit> FindEdits::edits() const {
  std::vector<Edit> all = lists_;
  // Large chunks before small ones, over all lists.
  std::stable_sort(all.begin(), all.end(), [](const Edit& a, const Edit& b) { return a.count > b.count; });
  all.insert(all.end(), numbers_.begin(), numbers_.end());
  return all;
}

void FindEdits::on_number(const char* /*name*/, std::int64_t& v, std::int64_t /*low*/, std::int64_t /*high*/,
                          std::int64_t simple) {
  for (rc::Seq<std::int64_t> towards = rc::shrink::towards<std::int64_t>(v, simple);;) {
    const auto next = towards.next();
    if (!next) break;
    numbers_.push_back({Edit::Kind::number, place_, *next, 0, 0, 0});
  }
  ++place_;
}

void FindEdits::on_real(const char* /*name*/, double& v, double low, double high, double simple) {
  const auto add = [&](double to) {
    if (to != v && to >= low && to <= high) numbers_.push_back({Edit::Kind::real, place_, 0, to, 0, 0});
  };
  if (v != simple) {
    add(simple);
    if (is_whole(v) && is_whole(simple)) {
      for (rc::Seq<std::int64_t> towards =
               rc::shrink::towards<std::int64_t>(static_cast<std::int64_t>(v), static_cast<std::int64_t>(simple));
           ;) {
        const auto next = towards.next();
        if (!next) break;
        add(static_cast<double>(*next));
      }
    } else if (std::abs(v) < 0x1p50) {
      // Fewer binary digits after the point, so that each such step brings an end nearer.
      for (const int digits : {0, 1, 2, 4, 8, 16, 24, 32}) add(std::ldexp(std::trunc(std::ldexp(v, digits)), -digits));
    }
  }
  ++place_;
}

void FindEdits::on_list(const char* /*name*/, List& list, std::size_t least, std::size_t /*most*/) {
  const std::size_t n = list.size();
  for (std::size_t count = n - std::min(n, least); count > 0; count /= 2)
    for (std::size_t first = 0; first < n; first += count)
      lists_.push_back({Edit::Kind::erase, list_, 0, 0, first, std::min(count, n - first)});
  ++list_;
  for (std::size_t i = 0; i < n; ++i) list.fields_of(i, *this);
}

void ApplyEdit::on_number(const char* /*name*/, std::int64_t& v, std::int64_t /*low*/, std::int64_t /*high*/,
                          std::int64_t /*simple*/) {
  if (edit_.kind == Edit::Kind::number && edit_.place == place_) v = edit_.number;
  ++place_;
}

void ApplyEdit::on_real(const char* /*name*/, double& v, double /*low*/, double /*high*/, double /*simple*/) {
  if (edit_.kind == Edit::Kind::real && edit_.place == place_) v = edit_.real;
  ++place_;
}

void ApplyEdit::on_list(const char* /*name*/, List& list, std::size_t /*least*/, std::size_t /*most*/) {
  if (edit_.kind == Edit::Kind::erase && edit_.place == list_) list.erase(edit_.first, edit_.count);
  ++list_;
  for (std::size_t i = 0; i < list.size(); ++i) list.fields_of(i, *this);
}

}  // namespace kage::verif
