// SPDX-License-Identifier: Apache-2.0
#include "cosim/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace kage::cosim {
namespace {

const char* channel_name(int channels, int channel) {
  static constexpr const char* kColors[] = {"red", "green", "blue"};
  return channels == 1 ? "grey" : kColors[channel];
}

}  // namespace

void Lines::add(std::span<const std::uint8_t> line) {
  if (!repeats_.empty() && std::equal(line.begin(), line.end(), bytes_.end() - static_cast<std::ptrdiff_t>(length_))) {
    ++repeats_.back();
    return;
  }
  length_ = line.size();
  bytes_.insert(bytes_.end(), line.begin(), line.end());
  repeats_.push_back(1);
}

std::span<const std::uint8_t> Lines::front() const { return std::span(bytes_).subspan(next_ * length_, length_); }

void Lines::pop() {
  if (--repeats_[next_] == 0) ++next_;
}

void FrameComparison::actual(std::span<const std::uint8_t> line) {
  const int y = lines_++;
  const auto channels = static_cast<std::size_t>(channels_);
  pixels_ += line.size() / channels;
  std::span<const std::uint8_t> want;
  if (!expected_.empty()) want = expected_.front().front();
  const auto n = static_cast<std::ptrdiff_t>(std::min(want.size(), line.size()));
  const auto at =
      static_cast<std::size_t>(std::mismatch(want.begin(), want.begin() + n, line.begin()).first - want.begin());
  if (at < static_cast<std::size_t>(n) && !first_)
    first_ = Difference{frame_,
                        y,
                        static_cast<int>(at / channels),
                        channel_name(channels_, static_cast<int>(at % channels)),
                        want[at],
                        line[at],
                        {},
                        {}};
  if (line.size() != want.size() && !unlike_)
    unlike_ = {y, static_cast<int>(want.size() / channels), static_cast<int>(line.size() / channels)};
  if (keep_ && (first_ || unlike_)) {
    if (kept_.empty()) {
      kept_from_ = y;
      kept_line_ = line.size();
    }
    kept_.insert(kept_.end(), line.begin(), line.end());
  }
  if (expected_.empty()) return;
  expected_.front().pop();
  if (expected_.front().empty()) expected_.pop_front();
}

std::optional<Difference> FrameComparison::finish(const FrameEnd& expected, const FrameEnd& actual) const {
  std::optional<Difference> d = first_of(expected, actual);
  if (!d) return d;
  d->before = actual.before;
  d->ahead = actual.ahead_wrong && d->field == "port";
  return d;
}

std::optional<Difference> FrameComparison::first_of(const FrameEnd& e, const FrameEnd& a) const {
  const FrameStatus& es = e.status;
  const FrameStatus& as = a.status;
  const auto whole = [&](int line, const char* field, std::int64_t want, std::int64_t got) {
    return Difference{frame_, line, -1, field, want, got, a.misconduct, {}};
  };
  if (failure_) {
    // Registers are asked when all lines have come.
    const bool in_line = lines_ < es.height && failure_->field() != "register";
    Difference d = first_.value_or(whole(in_line ? lines_ : -1, failure_->field().c_str(), 0, 1));
    d.remark = failure_->remark();
    d.assertion = failure_->where();
    return d;
  }
  if (first_) return first_;
  if (es.width != as.width) return whole(-1, "width", es.width, as.width);
  if (es.height != as.height) return whole(std::min(es.height, as.height), "height", es.height, as.height);
  if (lines_ < es.height || (unlike_ && unlike_->actual < unlike_->expected))
    return Difference{frame_,
                      unlike_ ? unlike_->line : lines_,
                      unlike_ ? unlike_->actual : 0,
                      "missing",
                      std::int64_t{es.width} * es.height,
                      static_cast<std::int64_t>(pixels_),
                      a.misconduct,
                      {}};
  if (lines_ > es.height) return whole(es.height, "height", es.height, lines_);
  if (unlike_) return whole(unlike_->line, "width", unlike_->expected, unlike_->actual);
  const auto line = static_cast<int>(es.line);
  if (es.error != as.error) return whole(line, "error", static_cast<int>(es.error), static_cast<int>(as.error));
  if (es.frame != as.frame) return whole(line, "error_frame", es.frame, as.frame);
  if (es.line != as.line) return whole(line, "error_line", es.line, as.line);
  if (es.token != as.token) return whole(line, "error_token", es.token, as.token);
  if (es.unit != as.unit) return whole(line, "error_unit", es.unit, as.unit);
  if (e.misconduct != a.misconduct) return whole(-1, "port", 0, 1);
  return std::nullopt;
}

FrameComparison::Drawn FrameComparison::drawn(const Image& expected) const {
  Image image = expected;
  if (expected.data.empty()) {
    const auto width = static_cast<int>(kept_line_) / channels_;
    image = Image(width, width == 0 ? 0 : static_cast<int>(kept_.size() / kept_line_), channels_);
  }
  // The kept lines begin at the first difference. Without kept lines, the difference is that lines are missing.
  const auto same = std::min(image.data.size(), image.index(0, kept_.empty() ? lines_ : kept_from_));
  const auto have = std::min(image.data.size() - same, kept_.size());
  const auto end = std::copy_n(kept_.begin(), have, image.data.begin() + static_cast<std::ptrdiff_t>(same));
  std::fill(end, image.data.end(), std::uint8_t{0});
  const std::size_t came = same + have;
  return {std::move(image), came};
}

std::string describe(const Difference& d) {
  std::string text = d.frame == kBehindFrames ? "register check behind the frames" : fmt::format("frame {}", d.frame);
  if (d.line >= 0) text += fmt::format(", line {}", d.line);
  if (d.x >= 0) text += fmt::format(", x {}", d.x);
  if (d.field == "missing") {
    text += fmt::format(": only {} of {} pixels came", d.actual, d.expected);
  } else if (d.field == "error") {
    text += fmt::format(": expected {}, got {}", kErrorNames[static_cast<std::size_t>(d.expected) % kErrorNames.size()],
                        kErrorNames[static_cast<std::size_t>(d.actual) % kErrorNames.size()]);
  } else if (d.field != "port" && d.field != "assertion" && d.field != "finish" && d.field != "register" &&
             d.field != "stage") {
    text += fmt::format(", {}: expected {}, got {}", d.field, d.expected, d.actual);
  }
  if (!d.remark.empty()) text += ": " + d.remark;
  return d.other_state ? text + "; with another initial state of registers and memories, and not with the seed's own"
                       : text;
}

}  // namespace kage::cosim
