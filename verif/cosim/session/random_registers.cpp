// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/random_registers.hpp"

#include <vector>

#include "cosim/register_check.hpp"
#include "number/mixed.hpp"
#include "stimulus/random_frames.hpp"

namespace kage::cosim {
namespace {

constexpr int kSound = 12;
constexpr int kDamaged = 12;

/// Percent of clocks in which no output is taken: some, so that clocks are lost to be counted.
constexpr int kBackpressure = 50;

}  // namespace

std::optional<Difference> register_difference(const std::filesystem::path& library, const Config& config,
                                              const RtlOptions& options, const std::function<void()>& wait) {
  const std::uint64_t seed = mixed(options.seed);
  std::vector<KnownFrame> frames;
  for (int i = 0; i < kSound + kDamaged; ++i) {
    const verif::Manner manner = i < kSound ? verif::Manner::sound : verif::Manner::damaged;
    frames.push_back(cosim::known_frame(config, verif::RandomFrames(config, manner, seed).words(i)));
  }
  RtlOptions own = options;
  own.prelude = {};
  own.backpressure_percent = kBackpressure;
  Difference d;
  d.frame = cosim::kBehindFrames;
  try {
    const auto wrong = cosim::wrong_register(*cosim::make_rtl(library, config, own), config, frames, wait);
    if (!wrong) return std::nullopt;
    d.field = "register";
    d.remark = *wrong;
  } catch (const CoreFailure& e) {
    d.field = e.field();
    d.assertion = e.where();
    d.remark = e.remark();
  }
  return d;
}

}  // namespace kage::cosim
