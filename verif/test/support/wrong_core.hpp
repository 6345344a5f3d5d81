// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cosim/core.hpp"

namespace kage::verif {

/// The golden core, but the first pixel of each line of frame `wrong` is another. Until begin() is called, as nobody
/// does for an expected core, a frame's number is -1.
class WrongCore : public cosim::Core {
 public:
  WrongCore(const Config& config, int wrong) : golden_(cosim::make_golden(config)), wrong_(wrong) {}
  [[nodiscard]] int channels() const override { return golden_->channels(); }
  void begin(int number) override { number_ = number; }
  void feed(std::span<const std::uint32_t> words, const LineSink& sink) override {
    golden_->feed(words, changed(sink));
  }
  cosim::FrameEnd finish(const LineSink& sink) override { return golden_->finish(changed(sink)); }

  /// The number of the frame at hand.
  [[nodiscard]] int number() const { return number_; }

 private:
  LineSink changed(const LineSink& sink) const {
    return [this, sink](int y, std::span<const std::uint8_t> line) {
      std::vector<std::uint8_t> copy(line.begin(), line.end());
      if (number_ == wrong_) copy.front() ^= 1U;
      sink(y, copy);
    };
  }

  std::unique_ptr<cosim::Core> golden_;
  int wrong_;
  int number_ = -1;
};

}  // namespace kage::verif
