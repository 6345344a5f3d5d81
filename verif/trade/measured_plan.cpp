// SPDX-License-Identifier: Apache-2.0
#include "trade/measured_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "kage/error.hpp"
#include "plan/demand.hpp"
#include "plan/widths.hpp"
#include "trade/screen_truth.hpp"

namespace kage::trade {
namespace {

/// A frame with all that is true of it.
struct Judged {
  SceneFrame frame;
  const DrawOptions* draw = nullptr;
  ScreenTruth truth;
  DrawnFrame finest;
};

/// Depth as fine as it can be, for the oracle.
Config finest_depth(Config c) {
  c.z_bits = kGreatest.z_bits;
  c.z_frac = kGreatest.z_frac;
  return c;
}

/// Of all pixels, however many of them were compared.
double wrong_ppm(const Accuracy& a, std::uint64_t pixels) {
  return 1e6 * static_cast<double>(a.visible_wrong + a.shadow_wrong) / static_cast<double>(pixels);
}

std::string text_of(const std::optional<Accuracy>& a) {
  if (!a) return "cannot represent the scene";
  return fmt::format("{:.3g} ppm wrong, depth off by {:.3g}, colour by {}", a->wrong_ppm(), a->z_max, a->color_max);
}

/// ": over --max-z 5.96e-08", with each limit that is passed; nothing where none is.
std::string over_text(const std::optional<Accuracy>& a, const MeasuredLimits& limits, std::uint64_t pixels) {
  if (!a) return {};
  std::string text;
  const auto add = [&](bool passed, const std::string& limit) {
    if (passed) text += (text.empty() ? ": over " : ", ") + limit;
  };
  add(a->z_max > limits.z, fmt::format("--max-z {:.3g}", limits.z));
  add(a->color_max > limits.color, fmt::format("--max-color {}", limits.color));
  if (limits.wrong) add(wrong_ppm(*a, pixels) > *limits.wrong, fmt::format("--max-wrong {:g}", *limits.wrong));
  return text;
}

/// A width that may be lowered, and its steps.
struct Width {
  int Config::*member;
  int least;
  int (*step)(int);
};

int fraction_step(int v) { return plan::position_step(std::max(v, 1)); }
int shade_step(int v) { return std::min(plan::four_step(v), kGreatest.shade_frac); }
int class_step(int v) { return v <= 1 ? v : plan::class_step(v); }

std::string_view name_of(int Config::*member) {
  return std::find_if(kParams.begin(), kParams.end(), [&](const ParamInfo& p) { return p.member == member; })->name;
}

}  // namespace

struct MeasuredPlan::Data {
  std::span<const PlannedScene> scenes;
  MeasuredLimits limits;
  std::function<void()> step;
  plan::Features features;
  std::vector<Judged> frames;  // empty until they are asked for
  std::uint64_t pixels = 0;

  void judge_all() {
    if (!frames.empty()) return;
    features = plan::features_of(scenes);
    // Parity is right for any caster, so its volumes are what the oracle is asked about.
    const Config config = finest_depth(plan::finest(features, features.needs.shadows ? 1 : 0, 0));
    for (const PlannedScene& scene : scenes) {
      const int count = plan::frames_of(scene);
      for (int i = 0; i < count; ++i) {
        step();
        Judged j;
        j.frame = scene.scene->frame(i, count);
        j.draw = &scene.draw;
        const FrameGeometry g =
            make_geometry(j.frame, config, scene.draw.width, scene.draw.height, {.look = scene.draw.look});
        j.truth = screen_truth(g, config, scene.draw.threads);
        j.finest = draw(j.frame, config, scene.draw);
        pixels += j.truth.pixels.size();
        frames.push_back(std::move(j));
      }
    }
  }
};

MeasuredPlan::MeasuredPlan(std::span<const PlannedScene> scenes, const MeasuredLimits& limits,
                           std::function<void()> step)
    : data_(std::make_unique<Data>()) {
  data_->scenes = scenes;
  data_->limits = limits;
  data_->step = std::move(step);
}

MeasuredPlan::~MeasuredPlan() = default;

bool MeasuredPlan::within(const Accuracy& a) const {
  const MeasuredLimits& l = data_->limits;
  return a.z_max <= l.z && a.color_max <= l.color && (!l.wrong || wrong_ppm(a, data_->pixels) <= *l.wrong);
}

std::optional<Accuracy> MeasuredPlan::measure(const Config& config, bool whole) {
  data_->judge_all();
  Accuracy all;
  for (const Judged& j : data_->frames) {
    data_->step();
    try {
      all += compare(j.truth, j.finest, draw(j.frame, config, *j.draw), config);
    } catch (const Error&) {
      return std::nullopt;
    }
    if (!whole && !within(all)) break;
  }
  return all;
}

void MeasuredPlan::lower(Config& widths, std::vector<PlanReason>& reasons) {
  const auto serves = [&](const std::optional<Accuracy>& a) { return a && within(*a); };
  Config at = widths;
  std::optional<Accuracy> now = measure(at, true);
  if (!serves(now)) {
    at = finest_depth(at);
    const std::string given = text_of(now);
    now = measure(at, true);
    if (!serves(now))
      throw Error(fmt::format("the limits cannot be kept: {} bits of depth give {}, and {} bits, the most, {}",
                              widths.z_bits, given, at.z_bits, text_of(now)));
  }
  std::vector<Width> list{{&Config::z_bits, 4, plan::four_step}, {&Config::z_frac, 0, fraction_step}};
  if (at.color_frac > 0) list.push_back({&Config::color_frac, 0, plan::four_step});
  if (at.dsf_bits > 0) list.push_back({&Config::shade_frac, 1, shade_step});
  if (at.class_bits > 1) list.push_back({&Config::class_bits, 2, class_step});
  // One width after the other, until a whole round lowers none: then each of them, one less, was over a limit.
  std::vector<std::string> one_less(list.size());
  for (bool lowered = true; lowered;) {
    lowered = false;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Width& w = list[k];
      while (at.*w.member > w.least) {
        Config less = at;
        less.*w.member -= 1;
        const std::optional<Accuracy> a = measure(less);
        if (!serves(a)) {
          const std::optional<Accuracy> all = a ? measure(less, true) : a;
          one_less[k] = text_of(all) + over_text(all, data_->limits, data_->pixels);
          break;
        }
        at = less;
        lowered = true;
      }
      if (at.*w.member == w.least) one_less[k].clear();
    }
  }
  const std::string kept = text_of(measure(at, true));
  Config stepped = at;
  for (const Width& w : list) stepped.*w.member = w.step(at.*w.member);
  // More bits are finer, but other roundings may move more pixels of these frames: then what was measured is taken.
  const bool exact = !serves(measure(stepped));
  if (exact) stepped = at;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Width& w = list[k];
    const auto name = name_of(w.member);
    const auto reason =
        std::find_if(reasons.begin(), reasons.end(), [&](const PlanReason& r) { return r.parameter == name; });
    if (reason == reasons.end()) continue;
    const int raw = at.*w.member;
    reason->value = stepped.*w.member;
    reason->text = fmt::format("measured: {} give {}{}{}", raw, kept,
                               one_less[k].empty() ? "" : fmt::format("; {} give {}", raw - 1, one_less[k]),
                               exact && w.step(raw) != raw ? std::string(" (the next steps are over a limit)")
                               : reason->value == raw      ? std::string()
                                                           : fmt::format(" (the next step is {})", reason->value));
  }
  widths = stepped;
}

}  // namespace kage::trade
