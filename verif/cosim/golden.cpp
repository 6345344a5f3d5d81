// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "cosim/core.hpp"
#include "pipeline/stopwatch.hpp"

namespace kage::cosim {
namespace {

class Golden : public Core {
 public:
  explicit Golden(const Config& config) : channels_(config.channels), core_(config) {}

  [[nodiscard]] int channels() const override { return channels_; }

  void feed(std::span<const std::uint32_t> words, const LineSink& sink) override {
    Stopwatch watch(seconds_);
    core_.feed(words, watch.outside(sink));
  }

  FrameEnd finish(const LineSink& sink) override {
    FrameEnd end;
    {
      Stopwatch watch(seconds_);
      end.status = core_.finish(watch.outside(sink));
    }
    end.seconds = std::exchange(seconds_, 0);
    return end;
  }

 private:
  int channels_;
  GoldenCore core_;
  double seconds_ = 0;
};

}  // namespace

std::unique_ptr<Core> make_golden(const Config& config) { return std::make_unique<Golden>(config); }

}  // namespace kage::cosim
