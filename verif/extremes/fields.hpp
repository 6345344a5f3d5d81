// SPDX-License-Identifier: Apache-2.0
//
// Fields of a case: numbers and choices, each with a name and a range. A case says its fields once, by fields(Fields&),
// and all that is done with cases follows from that: drawing one by chance, writing and reading its text, changing it a
// little, making it simpler.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "stimulus/random.hpp"

namespace kage::verif {

/// Visits the fields of a case in order. A range may depend on fields before it.
class Fields {
 public:
  virtual ~Fields() = default;

  /// A list as a visitor sees it.
  class List {
   public:
    virtual ~List() = default;
    [[nodiscard]] virtual std::size_t size() const = 0;
    virtual void resize(std::size_t n) = 0;
    virtual void erase(std::size_t first, std::size_t count) = 0;
    virtual void fields_of(std::size_t i, Fields& f) = 0;
  };

  /// A whole number in low .. high, both included; `simple` is what it becomes where its value does not matter. Ranges
  /// are narrower than 2^62.
  template <class T>
  void number(const char* name, T& value, std::int64_t low, std::int64_t high, std::int64_t simple = 0) {
    auto v = static_cast<std::int64_t>(value);
    on_number(name, v, low, high, std::clamp(simple, low, high));
    value = static_cast<T>(v);
  }
  void flag(const char* name, bool& value) { number(name, value, 0, 1); }
  void real(const char* name, double& value, double low, double high, double simple = 0) {
    on_real(name, value, low, high, std::clamp(simple, low, high));
  }
  /// One of some names; the first is the simplest.
  template <std::size_t N>
  void choice(const char* name, int& value, const std::array<const char*, N>& names) {
    on_choice(name, value, names);
  }
  /// A list of least .. most elements, which have fields of their own but no lists.
  template <class T>
  void list(const char* name, std::vector<T>& value, std::size_t least, std::size_t most) {
    ListOf<T> of(value);
    on_list(name, of, least, most);
  }

 protected:
  virtual void on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high,
                         std::int64_t simple) = 0;
  virtual void on_real(const char* name, double& v, double low, double high, double simple) = 0;
  virtual void on_choice(const char* name, int& v, std::span<const char* const> names) {
    std::int64_t n = v;
    on_number(name, n, 0, static_cast<std::int64_t>(names.size()) - 1, 0);
    v = static_cast<int>(n);
  }
  virtual void on_list(const char* name, List& list, std::size_t least, std::size_t most) = 0;

 private:
  template <class T>
  class ListOf final : public List {
   public:
    explicit ListOf(std::vector<T>& v) : v_(&v) {}
    [[nodiscard]] std::size_t size() const override { return v_->size(); }
    void resize(std::size_t n) override { v_->resize(n); }
    void erase(std::size_t first, std::size_t count) override {
      const auto at = v_->begin() + static_cast<std::ptrdiff_t>(first);
      v_->erase(at, at + static_cast<std::ptrdiff_t>(count));
    }
    void fields_of(std::size_t i, Fields& f) override { (*v_)[i].fields(f); }

   private:
    std::vector<T>* v_;
  };
};

/// By chance: ends of ranges and simple values often, as errors like to be there.
class DrawFields final : public Fields {
 public:
  explicit DrawFields(Random& random) : random_(&random) {}

 private:
  void on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high, std::int64_t simple) override;
  void on_real(const char* name, double& v, double low, double high, double simple) override;
  void on_list(const char* name, List& list, std::size_t least, std::size_t most) override;
  Random* random_;
};

/// Into the ranges, where a change has moved them.
class ClampFields final : public Fields {
 private:
  void on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high, std::int64_t simple) override;
  void on_real(const char* name, double& v, double low, double high, double simple) override;
  void on_list(const char* name, List& list, std::size_t least, std::size_t most) override;
};

/// Every field with a chance of its own, by a small step or anyhow.
class MutateFields final : public Fields {
 public:
  MutateFields(Random& random, double chance) : random_(&random), chance_(chance) {}

 private:
  void on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high, std::int64_t simple) override;
  void on_real(const char* name, double& v, double low, double high, double simple) override;
  void on_list(const char* name, List& list, std::size_t least, std::size_t most) override;
  Random* random_;
  double chance_;
};

/// Counts the fields that are no lists.
class CountFields final : public Fields {
 public:
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  void on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high, std::int64_t simple) override;
  void on_real(const char* name, double& v, double low, double high, double simple) override;
  void on_list(const char* name, List& list, std::size_t least, std::size_t most) override;
  std::size_t count_ = 0;
};

/// The text of a case: a line for each field, and one for each element of a list.
class WriteFields final : public Fields {
 public:
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high, std::int64_t simple) override;
  void on_real(const char* name, double& v, double low, double high, double simple) override;
  void on_choice(const char* name, int& v, std::span<const char* const> names) override;
  void on_list(const char* name, List& list, std::size_t least, std::size_t most) override;
  void add(const char* name, const std::string& value);
  std::string text_;
  bool in_list_ = false;
};

/// Reads that text. Throws Error, "NAME:LINE: cause", where a field is missing, unknown, or out of its range.
class ReadFields final : public Fields {
 public:
  ReadFields(const std::string& text, std::string name);
  /// Nothing may be left.
  void end() const;

 private:
  struct Word {
    std::string text;
    int line;
  };
  void on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high, std::int64_t simple) override;
  void on_real(const char* name, double& v, double low, double high, double simple) override;
  void on_choice(const char* name, int& v, std::span<const char* const> names) override;
  void on_list(const char* name, List& list, std::size_t least, std::size_t most) override;
  const Word& value(const char* name);
  [[noreturn]] void fail(int line, const std::string& cause) const;

  std::string name_;
  std::vector<Word> words_;
  std::size_t at_ = 0;
  int last_line_ = 1;
};

/// One way to make a case simpler.
struct Edit {
  enum class Kind : std::uint8_t { number, real, erase };
  Kind kind = Kind::number;
  std::size_t place = 0;    ///< of the number or list, in the order of visiting
  std::int64_t number = 0;  ///< what it becomes
  double real = 0;          ///< likewise
  std::size_t first = 0;    ///< elements that go
  std::size_t count = 0;    ///< likewise
};

/// Finds all edits of a case: lists lose elements first, then numbers come nearer to what is simple, as RapidCheck
/// shrinks them.
class FindEdits final : public Fields {
 public:
  /// Lists' edits, then numbers'.
  [[nodiscard]] std::vector<Edit> edits() const;

 private:
  void on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high, std::int64_t simple) override;
  void on_real(const char* name, double& v, double low, double high, double simple) override;
  void on_list(const char* name, List& list, std::size_t least, std::size_t most) override;
  std::vector<Edit> lists_;
  std::vector<Edit> numbers_;
  std::size_t place_ = 0;
  std::size_t list_ = 0;
};

/// Does one edit.
class ApplyEdit final : public Fields {
 public:
  explicit ApplyEdit(const Edit& edit) : edit_(edit) {}

 private:
  void on_number(const char* name, std::int64_t& v, std::int64_t low, std::int64_t high, std::int64_t simple) override;
  void on_real(const char* name, double& v, double low, double high, double simple) override;
  void on_list(const char* name, List& list, std::size_t least, std::size_t most) override;
  Edit edit_;
  std::size_t place_ = 0;
  std::size_t list_ = 0;
};

}  // namespace kage::verif
