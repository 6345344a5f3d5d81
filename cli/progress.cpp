// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common.hpp"

namespace kage::cli {
namespace {

std::string rate_text(double rate) {
  if (rate >= 10) return fmt::format("{:.0f} frames/s", rate);
  if (rate >= 1) return fmt::format("{:.1f} frames/s", rate);
  return fmt::format("{:.1f} s a frame", 1 / rate);
}

std::string time_text(double seconds) {
  const auto s = static_cast<long>(std::ceil(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

}  // namespace

std::string progress_text(const std::string& name, int done, int frames, double seconds) {
  std::string text = fmt::format("{}: frame {}/{}", name, std::min(done + 1, frames), frames);
  if (done < 1 || seconds < 0.1) return text;
  const double rate = done / seconds;
  return text + fmt::format(", {}, {} left", rate_text(rate), time_text((frames - done) / rate));
}

FrameProgress::FrameProgress(Progress& progress, std::string name, int frames)
    : progress_(progress), name_(std::move(name)), frames_(frames) {}

void FrameProgress::next() {
  if (++done_ == 0) start_ = std::chrono::steady_clock::now();
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
  progress_.show(progress_text(name_, done_, frames_, passed.count()));
}

}  // namespace kage::cli
