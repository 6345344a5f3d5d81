// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vectors/pack.hpp"

namespace kage::vectors {

/// The first place where a capture is not what the pack has.
struct WrongPlace {
  std::uint64_t frame = 0;  ///< of the pack, from 0
  int line = 0;             ///< of the frame
  std::optional<int> x;     ///< none: a signature tells of lines only
  std::string what;         ///< "channel 1", "TUSER", "TLAST" or "signature"
  std::uint32_t expected = 0;
  std::optional<std::uint32_t> actual;  ///< none: the capture has digits x or z
};

/// Verdict on a capture.
struct CaptureVerdict {
  std::uint64_t compared = 0;  ///< pixels, or signatures
  std::uint64_t wrong = 0;     ///< of them
  bool signatures = false;     ///< it has lines' signatures, not pixels
  std::optional<WrongPlace> first;
  std::string remark;  ///< "ends within frame 1, line 3, x 20", "has more pixels than the pack"; empty: neither

  [[nodiscard]] bool same() const { return wrong == 0 && remark.empty(); }
};

/// Holds what came out of a core that played the pack against it. By its name's end the capture is
///   .hex   a pixel a line as in pixels.hex, with its first digit or without it; or a signature a line (8 digits). A
///   digit
///          x or z, as simulators write what they do not know, is different from any
///   .png, .exr or another picture's   one frame: `frame`, or the only one that has pixels
///   .bin, .raw   bytes as in pixels.bin
/// With `frame` a capture of the two other forms is of this frame alone too. Throws Error that names file and place
/// where it is none of that.
/// `wait` is called now and then, and may throw.
CaptureVerdict judge(const std::filesystem::path& folder, const Pack& pack, const std::filesystem::path& capture,
                     std::optional<std::uint64_t> frame, const std::function<void()>& wait);

/// The words of a frame of the pack. Throws Error where they cannot be read.
std::vector<std::uint32_t> words_of(const std::filesystem::path& folder, const Pack& pack, std::uint64_t frame);

}  // namespace kage::vectors
