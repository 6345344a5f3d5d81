// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "image/picture.hpp"
#include "plugin/foreign_code.hpp"

namespace kage {

/// A picture's lines from the top on, of memory or, a step at a time, of a file.
class PictureLines {
 public:
  /// The picture stays as long as the object.
  explicit PictureLines(const Picture& picture) : head_(picture) {}
  /// So does the reader. Throws Error where it does.
  explicit PictureLines(PictureReader& reader)
      : head_(reader.head()),
        reader_(&reader),
        piece_(reader.line_bytes() * static_cast<std::size_t>(std::min(reader.step(), head_.height))) {}

  /// All but the data.
  [[nodiscard]] const Picture& head() const { return head_; }

  /// A line; `y` is the last one that was asked for, or the next. It is there until another is asked for.
  const std::byte* row(int y) {
    if (reader_ == nullptr) return head_.row(y);
    if (y >= end_) {
      begin_ = end_;
      end_ = std::min(begin_ + reader_->step(), head_.height);
      const ForeignCode mark("reading a picture");
      reader_->read(begin_, end_ - begin_, piece_.data());
    }
    return piece_.data() + static_cast<std::size_t>(y - begin_) * reader_->line_bytes();
  }

 private:
  const Picture& head_;
  PictureReader* reader_ = nullptr;
  std::vector<std::byte> piece_;  // lines begin_ .. end_ - 1
  int begin_ = 0;
  int end_ = 0;
};

}  // namespace kage
