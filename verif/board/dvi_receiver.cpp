// SPDX-License-Identifier: Apache-2.0
#include "dvi_receiver.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace kage::board {

namespace {

constexpr int kWordsToAlign = 12;
// Words of the control values 0, 1, 2 and 3, whose bit 0 comes first.
constexpr std::array<unsigned, 4> kControl{0x354, 0x0AB, 0x154, 0x2AB};
// Five ones and five zeros, in any of their rotations: the standard gives the clock no phase.
bool is_clock(unsigned word) {
  const unsigned changes = (word ^ (word >> 1 | (word & 1) << 9)) & 0x3FF;
  return std::popcount(word) == 5 && std::popcount(changes) == 2;
}

}  // namespace

TmdsSymbol tmds_decode(unsigned word) {
  for (unsigned i = 0; i < kControl.size(); ++i)
    if (word == kControl[i]) return {true, static_cast<std::uint8_t>(i), true};
  TmdsSymbol symbol;
  const unsigned low = word & 0xFF;
  const unsigned turned = (word >> 9 & 1) != 0 ? ~low & 0xFF : low;
  const bool exclusive = (word >> 8 & 1) != 0;
  const unsigned differences = (turned ^ turned << 1) & 0xFF;  // bit 0 against nothing
  symbol.value = static_cast<std::uint8_t>(exclusive ? differences : differences ^ 0xFE);
  const int changes = std::popcount((low ^ low >> 1) & 0x7F);
  const bool unlike = ((word >> 8 ^ word >> 9) & 1) != 0;
  symbol.valid = changes <= 3 && (std::popcount(low) != 4 || unlike);
  return symbol;
}

void DviReceiver::complain(const std::string& text) {
  if (fault_.empty()) fault_ = text + " (bit " + std::to_string(count_) + ")";
}

// A word may end with this bit: count it, if it is one of control.
void DviReceiver::align(int channel) {
  Channel& c = channels_[static_cast<std::size_t>(channel)];
  const int phase = static_cast<int>((count_ + 1) % 10);  // of the word that ends here, and of the next
  int& run = c.controls[static_cast<std::size_t>(phase)];
  run = tmds_decode(c.bits).control ? run + 1 : 0;
  if (run < kWordsToAlign || c.phase == phase) return;
  if (c.phase >= 0) complain("channel " + std::to_string(channel) + " has lost its alignment");
  c.phase = phase;
  c.disparity = 0;
}

TmdsSymbol DviReceiver::take(int channel) {
  Channel& c = channels_[static_cast<std::size_t>(channel)];
  const std::string name = "channel " + std::to_string(channel);
  const TmdsSymbol symbol = tmds_decode(c.bits);
  if (!symbol.valid) complain(name + " sends a word that has no meaning, " + std::to_string(c.bits));
  if (symbol.control) {
    c.disparity = 0;
    return symbol;
  }
  // The eight lower bits of a word that is not balanced lean to the side on which fewer bits went out; where either is
  // balanced, bits 8 and 9 differ.
  const int lean = 2 * std::popcount(c.bits & 0xFF) - 8;
  if (lean != 0 && c.disparity != 0 && (lean > 0) == (c.disparity > 0)) complain(name + " leans further to one side");
  if (c.disparity == 0 && ((c.bits >> 8 ^ c.bits >> 9) & 1) == 0)
    complain(name + " has bits 8 and 9 alike without need");
  c.disparity += 2 * std::popcount(c.bits) - 10;
  worst_ = std::max(worst_, std::abs(c.disparity));
  if (std::abs(c.disparity) > kMaxDisparity) complain(name + " has a disparity of " + std::to_string(c.disparity));
  return symbol;
}

std::optional<VideoPixel> DviReceiver::put(bool blue, bool green, bool red, bool clock) {
  const std::array<bool, 3> bits{blue, green, red};
  for (std::size_t i = 0; i < 3; ++i) {
    channels_[i].bits = channels_[i].bits >> 1 | (bits[i] ? 0x200U : 0U);
    align(static_cast<int>(i));
  }
  clock_bits_ = clock_bits_ >> 1 | (clock ? 0x200U : 0U);
  ++count_;
  const bool all = std::all_of(channels_.begin(), channels_.end(), [](const Channel& c) { return c.phase >= 0; });
  if (!all) return {};
  if (phase_ < 0)
    for (int i = 1; i < 3; ++i)
      if (channels_[static_cast<std::size_t>(i)].phase != channels_[0].phase)
        complain("channel " + std::to_string(i) + " is not aligned with channel 0");
  phase_ = channels_[0].phase;
  if (count_ % 10 != phase_) return {};

  if (!is_clock(clock_bits_)) complain("the clock is not five bits high and five low");
  if (clock_word_ && *clock_word_ != clock_bits_) complain("the clock has moved against the words");
  clock_word_ = clock_bits_;

  const TmdsSymbol b = take(0);
  const TmdsSymbol g = take(1);
  const TmdsSymbol r = take(2);
  if (b.control != g.control || b.control != r.control) complain("the channels are not in blanking together");
  VideoPixel pixel;
  pixel.active = !b.control;
  if (b.control) {
    hsync_ = (b.value & 1) != 0;
    vsync_ = (b.value & 2) != 0;
    if (g.value != 0 || r.value != 0) complain("channels 1 and 2 carry control bits");
  } else {
    pixel.rgb = static_cast<std::uint32_t>(r.value | g.value << 8 | b.value << 16);
  }
  pixel.hsync = hsync_;
  pixel.vsync = vsync_;
  return pixel;
}

}  // namespace kage::board
