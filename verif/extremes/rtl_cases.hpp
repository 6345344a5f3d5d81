// SPDX-License-Identifier: Apache-2.0
//
// Cases of families 12, 29 and 39 - 41 on models of the whole RTL.
#pragma once

#include <vector>

#include "extremes/lights.hpp"
#include "extremes/rtl_models.hpp"

namespace kage::verif {

/// The models that cases are run on, by the names that verif/test/rtl/CMakeLists.txt gives them.
const std::vector<const char*>& model_names();

/// A model's pixels of some words under a stall pattern that `seed` decides. Empty, and `wrong` says why, where it does
/// not come to rest.
std::vector<std::uint8_t> rtl_pixels(const CoreModel& model, const std::vector<std::uint32_t>& words,
                                     std::uint64_t seed, std::string& wrong);

/// Checks that a model's lines of samples of lights are what light_pixel() says. It draws the line twice, and the
/// second finds what the first has left. Returns the error in words, or an empty text.
std::string light_line_wrong(const CoreModel& model, std::uint64_t seed, int width,
                             const std::vector<LightSample>& samples, const std::vector<std::uint32_t>& shares,
                             const Context& context = {});

/// Family 12: the same words on models that differ in what must not show.
struct SamePixelsCase {
  int group = 0;  ///< of models
  int width = 8, height = 2;
  int words = 0;   ///< which frame of that size
  int stalls = 0;  ///< which pattern
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 29: samples of lights on a model.
struct RtlSamplesCase {
  bool several = false;  ///< lights, or one
  int stalls = 0;
  SamplesCase line;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Families 39 - 41: groups of random frames on a model.
struct TrialCase {
  int model = 0;
  int groups = 1;
  int frames = 0;   ///< which ones
  int initial = 0;  ///< of registers and memories
  void fields(Fields& f);

 protected:
  [[nodiscard]] Outcome run(const Context& context, double sound, double reset, double standstill) const;
};

/// Family 39: sound frames with stalls, resets, standstills.
struct StallsCase : TrialCase {
  [[nodiscard]] Outcome check(const Context& context) const { return run(context, 1, 0.4, 0.2); }
};
/// Family 40: damaged frames at the port.
struct DamageCase : TrialCase {
  [[nodiscard]] Outcome check(const Context& context) const { return run(context, 0.1, 0.1, 0); }
};
/// Family 41: the same frames from several initial states.
struct InitialStateCase : TrialCase {
  [[nodiscard]] Outcome check(const Context& context) const;
};

void add_rtl_families(Families& to);

}  // namespace kage::verif
