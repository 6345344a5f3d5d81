// SPDX-License-Identifier: Apache-2.0
//
// The far end of a DVI 1.0 link: it takes bits as they come off four wires and gives pixels. It is written from the
// standard's decoder and from what its encoder promises, and not from the encoder itself.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "board/screen.hpp"

namespace kage::board {

/// Meaning of ten bits of a channel, of which bit 0 came first.
struct TmdsSymbol {
  bool control = false;    ///< a word of control, or one of colour
  std::uint8_t value = 0;  ///< two bits of control, or eight of colour
  bool valid = false;      ///< an encoder may send it
};

/// By the standard's decoder. A word is valid if it is one of the four control words, or if it keeps two rules. Its
/// bits 0-7 change at most three times, because the encoder takes the better of two chains. And if four of these eight
/// bits are ones, bits 8 and 9 differ.
TmdsSymbol tmds_decode(unsigned word);

class DviReceiver {
 public:
  /// Bits of the four wires at one time: channel 0 (blue), 1 (green), 2 (red), and the link's clock. Gives a pixel with
  /// each tenth bit once all channels are aligned. Words are found by twelve words of control in a row, as blanking has
  /// them.
  std::optional<VideoPixel> put(bool blue, bool green, bool red, bool clock);

  /// The first fault, with the channel and the bit since the start; else empty. Faults are:
  /// * a word that no encoder sends
  /// * a word that takes the sums of ones and zeros further apart where it should bring them together
  /// * sums that lie more than kMaxDisparity apart
  /// * channels that are not aligned with each other, lose alignment, or are not in blanking together
  /// * control bits in channels 1 and 2
  /// * a clock that is not five bits high and five low
  const std::string& fault() const { return fault_; }
  bool aligned() const { return phase_ >= 0; }
  /// The furthest that ones and zeros have been apart in a channel at the end of a word.
  int worst_disparity() const { return worst_; }

  static constexpr int kMaxDisparity = 8;

 private:
  struct Channel {
    unsigned bits = 0;               // the ten that came last, the oldest lowest
    int phase = -1;                  // of the bit that a word begins with
    std::array<int, 10> controls{};  // words of control in a row, at each phase
    int disparity = 0;               // ones less zeros since blanking
  };
  void complain(const std::string& text);
  void align(int channel);
  TmdsSymbol take(int channel);

  std::array<Channel, 3> channels_;
  unsigned clock_bits_ = 0;
  int phase_ = -1;
  std::optional<unsigned> clock_word_;
  long count_ = 0;  // bits so far
  int worst_ = 0;
  bool hsync_ = false;
  bool vsync_ = false;
  std::string fault_;
};

}  // namespace kage::board
