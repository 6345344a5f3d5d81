// SPDX-License-Identifier: Apache-2.0
//
// Expected output of a pack, frame by frame, read as it is needed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "vectors/pack.hpp"

namespace kage::board {

/// Functions throw Error that names a file that ends early. The pack has been checked (vectors::checked_pack).
class PackAnswers {
 public:
  PackAnswers(std::filesystem::path folder, const vectors::Pack& pack);

  /// The words of a frame, without those that fill its last beat.
  [[nodiscard]] std::vector<std::uint32_t> words(std::uint64_t frame) const;
  /// The signature of each line of the frames `first`, ..., one after the other.
  [[nodiscard]] std::vector<std::uint32_t> signatures(std::uint64_t first, std::uint64_t frames) const;
  /// The pixels of a frame's lines `line`, ..., with its channels.
  [[nodiscard]] std::vector<std::uint8_t> pixels(std::uint64_t frame, int line, int lines) const;

 private:
  std::filesystem::path folder_;
  const vectors::Pack& pack_;
  std::vector<std::uint64_t> lines_before_, pixels_before_;  // by frame
};

}  // namespace kage::board
