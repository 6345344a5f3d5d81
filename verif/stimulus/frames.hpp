// SPDX-License-Identifier: Apache-2.0
//
// Random frames of tokens: valid ones, as files hold them or as a port takes them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kage/stream.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

/// Contents of a frame.
struct FrameStyle {
  int most_opaque = 8;       ///< OPs of a line
  int most_volumes = 3;      ///< of a line, with FSF
  int most_in_volume = 5;    ///< SP, NC and IF of a volume
  int most_translucent = 5;  ///< TPs of a line
  int most_samples = 4;      ///< of a line, with COUNT_BITS
  /// Spans as a port takes them: accumulators may wrap, which a file may not have, and many spans meet at the same few
  /// pixels and depths, which is what forwarding is for.
  bool port = false;
  /// With a table: every share is all of a colour. So many samples, spread over the lights, put a line in shadow from
  /// end to end, in place of others; `dark_lines` is the share of such lines.
  int dark_samples = 0;
  double dark_lines = 1;
  /// Frames with a tree, where the configuration has units: 0 none, 1 all that are narrow enough.
  double trees = 0.7;
};

/// Samples of FrameStyle::dark_samples that make the highest bit of the sum over the lights, and no other; 0 if the
/// counters do not hold so many.
int half_sum(const Config& c);

/// Append a valid frame; returns how many tokens of each kind it has.
std::array<std::uint64_t, kKinds> random_frame(Random& random, const Config& c, int width, int height,
                                               std::vector<std::uint32_t>& words, std::uint32_t number = 0,
                                               const FrameStyle& style = {});

}  // namespace kage::verif
