// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/frame_progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kage::cosim {
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

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
  frame_start_ = std::chrono::steady_clock::now();
  if (++done_ == 0) start_ = frame_start_;
  progress_.show(progress_text(name_, done_, frames_, seconds_since(start_)));
}

void FrameProgress::wait() {
  const double frame = seconds_since(frame_start_);
  std::string text = progress_text(name_, done_, frames_, seconds_since(start_) - frame);
  if (frame >= 1) text += fmt::format(", this one for {}", time_text(std::floor(frame)));
  progress_.show(text);
}

}  // namespace kage::cosim
