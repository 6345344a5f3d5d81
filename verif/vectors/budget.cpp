// SPDX-License-Identifier: Apache-2.0
#include "vectors/budget.hpp"

#include <algorithm>
#include <numeric>

#include "stimulus/coverage.hpp"
#include "stimulus/parts.hpp"

namespace kage::vectors {
namespace {

struct Line {
  int frame = 0;
  std::size_t y = 0;
  std::uint64_t words = 0;   // of the line alone, without header, frame state and END
  std::vector<bool> points;  // that a frame of this line alone reaches
};

std::uint64_t beats_of(const Config& config, std::uint64_t words) {
  const auto width = static_cast<std::uint64_t>(config.beat_words);
  return (words + width - 1) / width;
}

class Chooser {
 public:
  Chooser(FrameSource& source, std::uint64_t bytes) : source_(source), config_(source.config()), bytes_(bytes) {
    for (int i = 0; i < source.frames(); ++i) take_apart(i);
    reached_.resize(lines_.empty() ? 0 : lines_.front().points.size());
    chosen_.resize(lines_.size());
  }

  std::vector<ChosenFrame> run() {
    while (take([&](const Line& line) { return static_cast<double>(news(line)) / static_cast<double>(cost(line)); })) {
    }
    while (take([](const Line& line) { return static_cast<double>(line.words); })) {
    }
    std::vector<ChosenFrame> frames;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!chosen_[i]) continue;
      if (frames.empty() || frames.back().from != lines_[i].frame) frames.push_back({lines_[i].frame, {}, {}});
      frames.back().lines.push_back(lines_[i].y);
    }
    for (ChosenFrame& f : frames)
      f.words = verif::only_lines(config_, source_.words(f.from),
                                  [&](std::size_t y) { return std::binary_search(f.lines.begin(), f.lines.end(), y); });
    return frames;
  }

 private:
  void take_apart(int frame) {
    const std::vector<std::uint32_t> words = source_.words(frame);
    const int height = FrameHeader::read(words).height;
    base_.push_back(0);
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
      const std::vector<std::uint32_t> alone =
          verif::only_lines(config_, words, [y](std::size_t of) { return of == y; });
      verif::Coverage coverage(config_);
      coverage.words(alone);
      coverage.end_frame();
      Line line{frame, y, alone.size(), {}};
      for (const verif::CoveragePoint& p : coverage.points()) line.points.push_back(p.frames > 0);
      lines_.push_back(std::move(line));
    }
    // Words that all lines of the frame share: the sum of the lines alone has them once a line, the frame has them
    // once.
    const std::uint64_t sum = std::accumulate(lines_.end() - height, lines_.end(), std::uint64_t{0},
                                              [](std::uint64_t s, const Line& l) { return s + l.words; });
    base_.back() = height > 1 ? (sum - words.size()) / static_cast<std::uint64_t>(height - 1) : kHeaderWords + 1;
    for (auto line = lines_.end() - height; line != lines_.end(); ++line) line->words -= base_.back();
  }

  [[nodiscard]] std::uint64_t news(const Line& line) const {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < reached_.size(); ++i) count += line.points[i] && !reached_[i] ? 1 : 0;
    return count;
  }
  /// Bytes that the line adds. A beat that is not full counts whole, as a frame's last one may be.
  [[nodiscard]] std::uint64_t cost(const Line& line) const {
    const bool first =
        used_.size() <= static_cast<std::size_t>(line.frame) || !used_[static_cast<std::size_t>(line.frame)];
    const std::uint64_t words = line.words + (first ? base_[static_cast<std::size_t>(line.frame)] : 0);
    return board_bytes(config_, words + (first ? static_cast<std::uint64_t>(config_.beat_words) - 1 : 0), 1);
  }

  /// Takes the line that has most of `value` and fits; false if none has any.
  template <class Value>
  bool take(Value value) {
    std::size_t best = lines_.size();
    double most = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (chosen_[i] || cost(lines_[i]) > bytes_) continue;
      if (const double v = value(lines_[i]); v > most) {
        most = v;
        best = i;
      }
    }
    if (best == lines_.size()) return false;
    const Line& line = lines_[best];
    bytes_ -= cost(line);
    chosen_[best] = true;
    const auto frame = static_cast<std::size_t>(line.frame);
    if (used_.size() <= frame) used_.resize(frame + 1);
    used_[frame] = true;
    for (std::size_t i = 0; i < reached_.size(); ++i) reached_[i] = reached_[i] || line.points[i];
    return true;
  }

  FrameSource& source_;
  Config config_;
  std::uint64_t bytes_;  // left
  std::vector<Line> lines_;
  std::vector<std::uint64_t> base_;  // words of each frame that are of no line
  std::vector<bool> chosen_, used_, reached_;
};

}  // namespace

std::uint64_t board_bytes(const Config& config, std::uint64_t words, std::uint64_t lines) {
  return beats_of(config, words) * static_cast<std::uint64_t>(config.beat_words) * 4 + 4 * lines;
}

std::vector<ChosenFrame> choose_lines(FrameSource& source, std::uint64_t bytes) { return Chooser(source, bytes).run(); }

}  // namespace kage::vectors
