// SPDX-License-Identifier: Apache-2.0
//
// The whole core against the golden core on random frames: pixels, video framing, error registers and counts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "extremes/rtl_models.hpp"
#include "kage/core.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

/// Plan of a trial, as chances; the defaults are a bit of everything.
struct TrialPlan {
  int groups = 4;           ///< of frames one right after another
  double sound = 0.5;       ///< that a frame is sound, not damaged
  double reset = 0.3;       ///< that a group begins with a reset amid a frame
  double standstill = 0.2;  ///< that input and output stop first, which the core must name
  bool lost_word = false;   ///< a word of each frame is lost on its way, for tests that must see it
};

/// One model through some groups of frames.
class CoreTrial {
 public:
  /// All that happens follows from `seed`; registers and memories begin with what `initial` makes them.
  CoreTrial(const CoreModel& model, std::uint64_t seed, std::uint64_t initial, const TrialPlan& plan = {})
      : api_(*model.api), config_(model.config), seed_(seed), initial_(initial), plan_(plan) {}

  /// Whether the core did what the golden core does.
  bool run();
  /// The error in words.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// Pixels that were compared.
  [[nodiscard]] std::uint64_t pixels() const { return pixels_; }

 private:
  using Words = std::vector<std::uint32_t>;

  /// Since the last reset.
  struct Counts {
    std::uint32_t ended = 0, errors = 0;
  };
  /// Frames one right after another, and what the golden core makes of them.
  struct Group {
    std::vector<std::uint8_t> expected;
    FrameStatus newest;  // of those with an error
    std::string story;
  };

  bool fails(const std::string& what) {
    text_ = what;
    return false;
  }
  std::uint32_t reg(kage_rtl* m, std::uint32_t address) const;
  void announce(kage_rtl* m, const Words& words) const;
  bool frames(kage_rtl* m, Random& random);
  bool standstill(kage_rtl* m, Random& random);
  void stall(kage_rtl* m, Random& random) const;
  void reset(kage_rtl* m, Random& random) const;
  bool submit(kage_rtl* m, Random& random, GoldenCore& golden, Group& group, Counts& counts);
  bool same_pixels(kage_rtl* m, const Group& group);
  bool same_registers(kage_rtl* m, const Group& group, const Counts& counts);

  const kage_rtl_table& api_;
  Config config_;
  std::uint64_t seed_;
  std::uint64_t initial_;
  TrialPlan plan_;
  std::string text_;
  std::uint64_t pixels_ = 0;
};

}  // namespace kage::verif
