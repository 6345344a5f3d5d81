// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>

#include "image/save.hpp"
#include "kage/token.hpp"

namespace kage {

/// The picture of a frame, written as the frame flows by: its size, or the words that tell it, and then its lines.
class FramePicture {
 public:
  explicit FramePicture(std::filesystem::path path) : path_(std::move(path)) {}

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// The next words of the frame, before their lines.
  void words(std::span<const std::uint32_t> words) {
    for (std::size_t i = 0; i < words.size() && seen_ < head_.size(); ++i) head_[seen_++] = words[i];
  }

  /// The same without words.
  void size(int width, int height) { size_ = {width, height}; }

  /// The next line from the top. The file is begun with the first.
  void line(std::span<const std::uint8_t> pixels) {
    if (!writer_) {
      if (seen_ == head_.size()) {
        const FrameHeader h = FrameHeader::read(head_);
        size_ = {h.width, h.height};
      }
      const auto [width, height] = size_;
      const int channels = width == 0 ? 0 : static_cast<int>(pixels.size()) / width;
      writer_ = std::make_unique<ImageWriter>(path_, width, height, channels);
    }
    writer_->line(pixels);
  }

  /// All lines are there, or none: a frame without pixels has no picture.
  void close() {
    if (writer_) writer_->close();
  }

  /// Whether there is one.
  [[nodiscard]] bool drawn() const { return writer_ != nullptr; }

  /// Where the complete picture lies.
  [[nodiscard]] const std::filesystem::path& temp() const { return writer_->temp(); }

  /// The complete picture, if there is one, is to get its name with the others of `files`.
  void hand_over(TempFiles& files) {
    if (writer_) writer_->hand_over(files);
  }

 private:
  std::filesystem::path path_;
  std::array<std::uint32_t, 2> head_{};
  std::size_t seen_ = 0;
  std::pair<int, int> size_{};
  std::unique_ptr<ImageWriter> writer_;
};

}  // namespace kage
