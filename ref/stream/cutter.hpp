// SPDX-License-Identifier: Apache-2.0
//
// Words that come in pieces of any size, taken token by token.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kage/defs.hpp"

namespace kage {

/// A run of words within one piece is handed out in place; one that lies across pieces is put together here, so memory
/// holds no more than the longest run asked for.
class WordCutter {
 public:
  /// Forget what is left.
  void start() {
    rest_ = {};
    held_count_ = 0;
  }

  /// The next piece; the one before must have been taken, up to what take() refused. It must live until it is taken.
  void feed(std::span<const std::uint32_t> words) {
    assert(rest_.empty());
    rest_ = words;
  }

  /// The first word not taken, or nullptr if there is none.
  [[nodiscard]] const std::uint32_t* peek() const {
    if (held_count_ != 0) return held_.data();
    return rest_.empty() ? nullptr : rest_.data();
  }

  /// The next `count` words, valid until the next call; nothing if they are not all there yet: then the same number
  /// must be asked for after the next piece.
  std::span<const std::uint32_t> take(std::size_t count) {
    assert(count > 0 && count <= held_.size());
    if (held_count_ == 0 && rest_.size() >= count) {
      const auto words = rest_.first(count);
      rest_ = rest_.subspan(count);
      return words;
    }
    const std::size_t n = std::min(count - held_count_, rest_.size());
    std::copy_n(rest_.begin(), n, held_.begin() + static_cast<std::ptrdiff_t>(held_count_));
    rest_ = rest_.subspan(n);
    held_count_ += n;
    if (held_count_ < count) return {};
    held_count_ = 0;
    return std::span(held_).first(count);
  }

 private:
  std::span<const std::uint32_t> rest_;
  std::array<std::uint32_t, std::max<std::size_t>(kMostTokenWords, kHeaderWords)> held_{};
  std::size_t held_count_ = 0;
};

}  // namespace kage
