// SPDX-License-Identifier: Apache-2.0
#include "vectors/cover.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include "cosim/model/rtl.hpp"
#include "stimulus/coverage.hpp"

namespace kage::vectors {
namespace {

constexpr int kStalls = 25;  // per cent of clocks in which each stream stops

/// Aims to be reached, and the frames that reach each.
class Aims {
 public:
  void reach(const std::string& name, int frame) { frames_of_[name].push_back(frame); }
  void know(const std::string& name) { frames_of_.try_emplace(name); }

  /// Per frame of `chosen`: how much it alone reaches of them.
  [[nodiscard]] std::vector<int> alone(const std::vector<bool>& chosen) const {
    std::vector<int> count(chosen.size());
    for (const auto& [name, frames] : frames_of_) {
      int by = -1;
      int many = 0;
      for (const int f : frames) {
        if (!chosen[static_cast<std::size_t>(f)]) continue;
        by = f;
        ++many;
      }
      if (many == 1) ++count[static_cast<std::size_t>(by)];
    }
    return count;
  }
  /// Per frame: how much it reaches that none of `chosen` does.
  [[nodiscard]] std::vector<int> news(const std::vector<bool>& chosen) const {
    std::vector<int> count(chosen.size());
    for (const auto& [name, frames] : frames_of_) {
      const bool there =
          std::any_of(frames.begin(), frames.end(), [&](int f) { return chosen[static_cast<std::size_t>(f)]; });
      if (!there)
        for (const int f : frames) ++count[static_cast<std::size_t>(f)];
    }
    return count;
  }
  [[nodiscard]] const std::map<std::string, std::vector<int>>& all() const { return frames_of_; }

 private:
  std::map<std::string, std::vector<int>> frames_of_;
};

/// How often each line and branch runs while the frames follow each other on a core out of reset.
std::map<std::string, std::uint64_t> counts_of(const std::filesystem::path& library, const Config& config,
                                               std::uint64_t seed,
                                               const std::vector<const std::vector<std::uint32_t>*>& frames) {
  cosim::RtlOptions options;
  options.seed = seed;
  options.idle_percent = kStalls;
  options.backpressure_percent = kStalls;
  const std::unique_ptr<cosim::RtlCore> rtl = cosim::make_rtl(library, config, options);
  const LineSink nowhere = [](int, std::span<const std::uint8_t>) {};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    rtl->begin(static_cast<int>(i));
    rtl->feed(*frames[i], nowhere);
    (void)rtl->finish(nowhere);
  }
  return rtl->lines();
}

/// Kinds of tokens and errors.
void look_at(const Config& config, int frame, const std::vector<std::uint32_t>& words, Aims& points) {
  verif::Coverage coverage(config);
  coverage.words(words);
  coverage.end_frame();
  for (const verif::CoveragePoint& p : coverage.points())
    if (p.frames > 0 && (p.group == "token" || p.group == "error")) points.reach(p.group + " " + p.name, frame);
}

}  // namespace

Cover cover(FrameSource& source, const std::filesystem::path& library, std::uint64_t seed,
            const std::function<void(int frame)>& progress) {
  const Config& config = source.config();
  const auto count = static_cast<std::size_t>(source.frames());
  Aims lines;
  Aims points;
  std::vector<std::size_t> size(count);
  for (int i = 0; i < source.frames(); ++i) {
    progress(i);
    const std::vector<std::uint32_t> words = source.words(i);
    size[static_cast<std::size_t>(i)] = words.size();
    for (const auto& [place, times] : counts_of(library, config, seed, {&words})) {
      lines.know(place);
      if (times > 0) lines.reach(place, i);
    }
    look_at(config, i, words, points);
  }
  std::vector<bool> chosen(count);
  const auto gain = [&] {
    std::vector<int> sum = lines.news(chosen);
    const std::vector<int> more = points.news(chosen);
    std::transform(sum.begin(), sum.end(), more.begin(), sum.begin(), std::plus<>());
    return sum;
  };
  while (true) {
    const std::vector<int> news = gain();
    std::size_t best = 0;
    for (std::size_t i = 1; i < count; ++i)  // news / size, without a division
      if (static_cast<std::uint64_t>(news[i]) * size[best] > static_cast<std::uint64_t>(news[best]) * size[i]) best = i;
    if (count == 0 || news[best] == 0) break;
    chosen[best] = true;
  }
  // The first ones taken may be needless by now: the largest goes first.
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
  for (const std::size_t i : order)
    if (chosen[i] && lines.alone(chosen)[i] == 0 && points.alone(chosen)[i] == 0) chosen[i] = false;

  // The chosen frames count as they follow each other, where they may reach more than each alone, or less. If an aim is
  // lost so, the smallest frame that has it is taken too.
  const auto play = [&] {
    std::vector<std::vector<std::uint32_t>> held;
    for (std::size_t i = 0; i < count; ++i)
      if (chosen[i]) held.push_back(source.words(static_cast<int>(i)));
    std::vector<const std::vector<std::uint32_t>*> in_order;
    for (const auto& words : held) in_order.push_back(&words);
    return counts_of(library, config, seed, in_order);
  };
  std::map<std::string, std::uint64_t> together = play();
  for (bool more = true; more;) {
    more = false;
    for (const auto& [place, frames] : lines.all()) {
      if (together.at(place) > 0) continue;
      const auto by = std::min_element(frames.begin(), frames.end(), [&](int a, int b) {
        return std::pair(chosen[static_cast<std::size_t>(a)], size[static_cast<std::size_t>(a)]) <
               std::pair(chosen[static_cast<std::size_t>(b)], size[static_cast<std::size_t>(b)]);
      });
      if (by == frames.end() || chosen[static_cast<std::size_t>(*by)]) continue;
      chosen[static_cast<std::size_t>(*by)] = true;
      more = true;
      break;
    }
    if (more) together = play();
  }

  Cover result;
  for (std::size_t i = 0; i < count; ++i)
    if (chosen[i]) result.frames.push_back({static_cast<int>(i), {}, source.words(static_cast<int>(i))});
  for (const auto& [place, times] : together) (times == 0 ? result.unreached : result.reached).push_back(place);
  result.points = points.all().size();
  return result;
}

}  // namespace kage::vectors
