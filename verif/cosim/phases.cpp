// SPDX-License-Identifier: Apache-2.0
#include "cosim/phases.hpp"

#include <limits>

#include "contract/kinds.hpp"

namespace kage::cosim {
void PhaseMarker::mark(std::span<const std::uint32_t> words, std::vector<std::uint8_t>& marks) {
  marks.reserve(marks.size() + words.size());
  for (const std::uint32_t word : words) {
    if (first_) level_ = FrameHeader::read({&word, 1}).level();
    first_ = false;
    if (left_ == 0) {
      left_ = layout_.words_of(word, level_);
      phase_ = left_ == 0 ? Phase::state : phase_of(kind_of(word, level_));
      if (left_ == 0) left_ = std::numeric_limits<std::uint64_t>::max();
    }
    --left_;
    marks.push_back(static_cast<std::uint8_t>(phase_));
  }
}

}  // namespace kage::cosim
