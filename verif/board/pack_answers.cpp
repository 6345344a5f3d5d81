// SPDX-License-Identifier: Apache-2.0
#include "board/pack_answers.hpp"

#include <charconv>
#include <fstream>
#include <string>
#include <utility>

#include "kage/error.hpp"
#include "vectors/capture.hpp"
#include "vectors/texts.hpp"

namespace kage::board {
namespace {

constexpr std::size_t kRow = 9;  // eight digits and the line's end

/// Bytes of a file, from a place on.
void read(const std::filesystem::path& path, std::uint64_t from, char* to, std::size_t bytes) {
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(from));
  if (!in.read(to, static_cast<std::streamsize>(bytes))) throw Error(path.string() + ": ends early");
}

}  // namespace

PackAnswers::PackAnswers(std::filesystem::path folder, const vectors::Pack& pack)
    : folder_(std::move(folder)), pack_(pack) {
  std::uint64_t lines = 0;
  std::uint64_t pixels = 0;
  for (const vectors::PackFrame& f : pack.frames) {
    lines_before_.push_back(lines);
    pixels_before_.push_back(pixels);
    lines += f.pixels() == 0 ? 0 : f.lines();
    pixels += f.pixels();
  }
  lines_before_.push_back(lines);
}

std::vector<std::uint32_t> PackAnswers::words(std::uint64_t frame) const {
  return vectors::words_of(folder_, pack_, frame);
}

std::vector<std::uint32_t> PackAnswers::signatures(std::uint64_t first, std::uint64_t frames) const {
  const std::uint64_t from = lines_before_.at(first);
  const std::filesystem::path path = folder_ / vectors::kSignaturesHex;
  std::vector<std::uint32_t> all(lines_before_.at(first + frames) - from);
  std::string text(kRow * all.size(), ' ');
  if (!all.empty()) read(path, kRow * from, text.data(), text.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const char* const row = text.data() + kRow * i;
    const auto [stop, error] = std::from_chars(row, row + kRow - 1, all[i], 16);
    if (error != std::errc{} || stop != row + kRow - 1) throw Error(path.string() + ": is not a signature a line");
  }
  return all;
}

std::vector<std::uint8_t> PackAnswers::pixels(std::uint64_t frame, int line, int lines) const {
  const auto channels = static_cast<std::uint64_t>(pack_.config.channels);
  const auto width = static_cast<std::uint64_t>(pack_.frames.at(frame).status.width);
  const std::uint64_t from = channels * (pixels_before_.at(frame) + width * static_cast<std::uint64_t>(line));
  std::vector<std::uint8_t> all(channels * width * static_cast<std::uint64_t>(lines));
  if (!all.empty()) read(folder_ / vectors::kPixelsBin, from, reinterpret_cast<char*>(all.data()), all.size());
  return all;
}

}  // namespace kage::board
