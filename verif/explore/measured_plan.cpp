// SPDX-License-Identifier: Apache-2.0
#include "explore/measured_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <string>
#include <tuple>
#include <utility>

#include "contract/params.hpp"
#include "explore/screen_truth.hpp"
#include "explore/sweep_scene.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"
#include "plan/demand.hpp"
#include "plan/figures.hpp"
#include "plan/widths.hpp"

namespace kage::explore {
namespace {

constexpr const char* kCannot = "cannot represent the scene";

/// A frame with all that is true of it.
struct Judged {
  SceneFrame frame;
  const DrawOptions* draw = nullptr;
  ScreenTruth truth;
  std::shared_ptr<const LightTruth> light;
  std::deque<std::pair<std::array<int, 5>, DrawnFrame>> finest;  // by what decides how light is shown
};

/// Parameters that decide how light is shown. Colours are compared between pictures that share them; how wrong these
/// make light is measured against the truth of light.
std::array<int, 5> light_of(const Config& c) {
  return {c.smooth, c.count_bits, c.lights, c.class_bits, c.linear_bits > 0 ? 1 : 0};
}

/// The same features with every width that may be lowered at its finest.
Config finest_of(Config c) {
  c.z_bits = kGreatest.z_bits;
  c.z_frac = kGreatest.z_frac;
  if (c.smooth > 0) c.color_frac = kGreatest.color_frac;
  if (c.dsf_bits > 0 && c.linear_bits == 0) c.shade_frac = kGreatest.shade_frac;
  if (c.class_bits > 1) c.class_bits = kGreatest.class_bits;
  if (c.linear_bits > 0) c.linear_bits = kGreatest.linear_bits;
  return c;
}

/// A width that may be lowered, and its steps.
struct Width {
  int Config::*member;
  int least;
  int (*step)(int);
};

int fraction_step(int v) { return plan::position_step(std::max(v, 1)); }
int shade_step(int v) { return std::min(plan::four_step(v), kGreatest.shade_frac); }

int any_step(int v) { return v; }

/// One bit is no table.
int class_bits_step(int v) { return v > 1 ? plan::class_step(v) : v; }

/// The widths that may be lowered of a configuration, each with its least value; classes, if light can be kept.
std::vector<Width> widths_of(const Config& c, bool classes = true) {
  std::vector<Width> list{{&Config::z_bits, 4, plan::four_step}, {&Config::z_frac, 0, fraction_step}};
  if (c.smooth > 0) list.push_back({&Config::color_frac, 0, plan::four_step});
  if (c.linear_bits > 0) list.push_back({&Config::linear_bits, plan::least_linear_bits(), any_step});
  if (c.dsf_bits > 0 && c.linear_bits == 0) list.push_back({&Config::shade_frac, 1, shade_step});
  // With one bit there is no table, which several lights need.
  if (c.class_bits > 1 && classes) list.push_back({&Config::class_bits, 2, class_bits_step});
  return list;
}

}  // namespace

struct MeasuredPlan::Data {
  std::span<const PlannedScene> scenes;
  MeasuredLimits limits;
  std::function<void()> step;
  plan::Features features;
  std::vector<Judged> frames;  // empty until they are asked for
  std::uint64_t pixels = 0;
  std::uint64_t light_pixels = 0;
  std::array<std::optional<bool>, 2> light_kept;  // keeps_light(), by a table and light after light
  std::vector<Lowered> lowered;

  /// A configuration with the finest widths, light being shown by a table or one after the other.
  [[nodiscard]] Config finest_config(bool linear) const {
    return finest_of(plan::finest(features, {features.needs.shadows ? 1 : 0, linear}, 0));
  }

  /// The picture of a frame with the finest widths, light being shown as `config` does.
  const DrawnFrame& finest_picture(Judged& of, const Config& config) const {
    const auto kept =
        std::find_if(of.finest.begin(), of.finest.end(), [&](const auto& f) { return f.first == light_of(config); });
    if (kept != of.finest.end()) return kept->second;
    Config c = finest_config(config.linear_bits > 0);
    std::tie(c.smooth, c.count_bits, c.lights, c.class_bits) =
        std::tie(config.smooth, config.count_bits, config.lights, config.class_bits);
    c.color_frac = c.smooth > 0 ? kGreatest.color_frac : 0;
    DrawnFrame drawn = draw(of.frame, c, *of.draw);
    // Widths are lowered one after the other: what the last two showed light by is asked for again.
    constexpr std::size_t kKept = 2;
    while (of.finest.size() >= kKept) of.finest.erase(of.finest.begin());
    return of.finest.emplace_back(light_of(config), std::move(drawn)).second;
  }

  /// Whether all frames may be within the limits although some are missing: errors are counted as if these had none.
  bool may_be_within(const MeasuredErrors& some) const {
    const Accuracy& a = some.pictures;
    const double light = light_pixels > 0 ? std::sqrt(some.light.squares / (3 * static_cast<double>(light_pixels))) : 0;
    return (light <= limits.color || !some.light_is_kept) && a.z_max <= limits.z && a.color_max <= limits.color &&
           (!limits.wrong || a.wrong_ppm(pixels) <= *limits.wrong);
  }

  void judge_all() {
    if (!frames.empty()) return;
    features = plan::features_of(scenes);
    // Parity is right for any caster, so its volumes are what the oracle is asked about.
    const Config config = finest_config(false);
    for (const PlannedScene& scene : scenes) {
      const int count = plan::frames_of(scene);
      SweepPoint point;
      point.config = config;
      point.width = scene.draw.width;
      point.height = scene.draw.height;
      point.look = scene.draw.look;
      DrawOptions drawn = scene.draw;
      drawn.frames = count;
      SweepScene lit(scene.scene, drawn, point, step);
      for (int i = 0; i < count; ++i) {
        step();
        Judged j;
        j.frame = scene.scene->frame(i, count);
        j.draw = &scene.draw;
        const FrameGeometry g =
            make_geometry(j.frame, config, scene.draw.width, scene.draw.height, {.look = scene.draw.look});
        j.truth = screen_truth(g, config, scene.draw.threads);
        if (!scene.draw.look.cull) j.light = lit.light(i, point);
        pixels += j.truth.pixels.size();
        if (j.light) light_pixels += j.light->pixels.size();
        frames.push_back(std::move(j));
      }
    }
  }

  /// Whether the finest pictures that show light as this configuration does are within the limit of light.
  bool keeps_light(const Config& config) {
    std::optional<bool>& known = light_kept[config.linear_bits > 0 ? 1 : 0];
    if (!known) {
      const Config finest = finest_config(config.linear_bits > 0);
      LightErrors light;
      for (Judged& j : frames)
        if (j.light) light += light_errors(*j.light, finest_picture(j, finest));
      known = light.rms() <= limits.color;
    }
    return *known;
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

bool MeasuredPlan::within(const MeasuredErrors& errors) const {
  const MeasuredLimits& l = data_->limits;
  const Accuracy& a = errors.pictures;
  return (errors.light.rms() <= l.color || !errors.light_is_kept) && a.z_max <= l.z && a.color_max <= l.color &&
         (!l.wrong || a.wrong_ppm(data_->pixels) <= *l.wrong);
}

std::optional<MeasuredErrors> MeasuredPlan::measure(const Config& config, bool whole) {
  data_->judge_all();
  try {
    validate(config, "plan");
  } catch (const Error&) {
    return std::nullopt;
  }
  MeasuredErrors all;
  all.light_is_kept = data_->keeps_light(config);
  for (Judged& j : data_->frames) {
    data_->step();
    try {
      const DrawnFrame drawn = draw(j.frame, config, *j.draw);
      all.pictures += compare(j.truth, data_->finest_picture(j, config), drawn, config);
      if (j.light) all.light += light_errors(*j.light, drawn);
    } catch (const Error&) {
      return std::nullopt;
    }
    if (!whole && !data_->may_be_within(all)) break;
  }
  return all;
}

std::string MeasuredPlan::text(const MeasuredErrors& errors) const {
  const MeasuredLimits& l = data_->limits;
  const Accuracy& a = errors.pictures;
  const auto figure = [](double value, double limit, const char* name, int digits) {
    const plan::FigureText t = plan::told_apart(value, limit, digits);
    return std::pair(t.value, value > limit ? fmt::format(" (over {} {})", name, t.limit) : std::string());
  };
  const double ppm = a.wrong_ppm(data_->pixels);
  const auto [wrong, over_wrong] = figure(ppm, l.wrong.value_or(ppm), "--max-wrong", 6);
  const auto [z, over_z] = figure(a.z_max, l.z, "--max-z", 3);
  const std::string over_color = a.color_max > l.color ? fmt::format(" (over --max-color {})", l.color) : std::string();
  const auto [light, over_light] = figure(errors.light.rms(), l.color, "--max-color", 2);
  return fmt::format("{} ppm wrong{}, depth off by {}{}, colour by {}{}{}", wrong, over_wrong, z, over_z,
                     counted(a.color_max, "step"), over_color,
                     errors.light.pixels == 0 ? ""
                     : errors.light_is_kept
                         ? fmt::format(", light by {}{}", light, over_light)
                         : fmt::format(", light by {} (no widths keep --max-color {})", light, l.color));
}

std::string MeasuredPlan::limits_text() const {
  const MeasuredLimits& l = data_->limits;
  return (l.wrong ? fmt::format("--max-wrong {:.6g}, ", *l.wrong) : std::string()) +
         (l.z < 1 ? fmt::format("--max-z {:.3g}, ", l.z) : std::string()) + fmt::format("--max-color {}", l.color);
}

std::string MeasuredPlan::widths_text(const Config& config) {
  std::string text;
  for (const Width& w : widths_of(config))
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", info_of(w.member).name, config.*w.member);
  return text;
}

const MeasuredPlan::Lowered* MeasuredPlan::lowered(const Config& config) const {
  for (const Lowered& l : data_->lowered) {
    Config same = l.taken;
    same.arrangement = config.arrangement;
    same.lanes = config.lanes;
    same.beat_words = config.beat_words;
    if (same == config) return &l;
  }
  return nullptr;
}

std::string MeasuredPlan::lower(Config& widths, std::vector<PlanReason>& reasons) {
  const auto serves = [&](const std::optional<MeasuredErrors>& a) { return a && within(*a); };
  Config at = widths;
  if (!serves(measure(at))) {
    at = finest_of(at);
    if (!data_->keeps_light(at)) at.class_bits = widths.class_bits;
    if (!serves(measure(at))) {
      const std::optional<MeasuredErrors> most = measure(at, true);
      throw Error(fmt::format("the finest widths ({}) {}", widths_text(at), most ? "give " + text(*most) : kCannot));
    }
  }
  const std::vector<Width> list = widths_of(at, data_->keeps_light(at));
  // One width after the other, until a whole round lowers none: then each of them, one less, was over a limit.
  std::vector<std::string> one_less(list.size());
  for (bool lowered = true; lowered;) {
    lowered = false;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Width& w = list[k];
      while (at.*w.member > w.least) {
        Config less = at;
        less.*w.member -= 1;
        const std::optional<MeasuredErrors> a = measure(less);
        if (!serves(a)) {
          const std::optional<MeasuredErrors> all = a ? measure(less, true) : a;
          one_less[k] = fmt::format("; {} {}", at.*w.member - 1, all ? "give " + text(*all) : kCannot);
          break;
        }
        at = less;
        lowered = true;
      }
      if (w.member == &Config::class_bits && at.class_bits == w.least && at.lights == 1) {
        Config none = at;
        none.class_bits = 1;
        if (data_->features.needs.samples == 1) none.count_bits = 0;
        const std::optional<MeasuredErrors> a = measure(none);
        const std::optional<MeasuredErrors> all = serves(a) || !a ? a : measure(none, true);
        one_less[k] = serves(a) ? std::string("; no core has fewer")
                                : fmt::format("; without a table {}", all ? "pictures give " + text(*all) : kCannot);
        if (serves(a)) {
          at = none;
          lowered = true;
        }
      } else if (at.*w.member == w.least)
        one_less[k] =
            w.least == info_of(w.member).min ? "; no core has fewer" : fmt::format("; {} {}", w.least - 1, kCannot);
    }
  }
  Lowered found{at, measure(at, true).value(), at, {}};
  for (const Width& w : list) found.taken.*w.member = w.step(at.*w.member);
  // More bits are finer, but other roundings may move more pixels of these frames: then what was measured is taken.
  const std::optional<MeasuredErrors> stepped = measure(found.taken, true);
  const bool exact = !serves(stepped);
  if (exact) found.taken = at;
  found.taken_gives = exact ? found.least_gives : *stepped;
  const std::string kept = text(found.least_gives);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Width& w = list[k];
    const auto name = info_of(w.member).name;
    const auto reason =
        std::find_if(reasons.begin(), reasons.end(), [&](const PlanReason& r) { return r.parameter == name; });
    if (reason == reasons.end()) continue;
    const int raw = at.*w.member;
    reason->value = found.taken.*w.member;
    reason->text = fmt::format("measured: {} give {}{}{}", raw, kept, one_less[k],
                               exact && w.step(raw) != raw ? std::string(" (the next steps are over a limit)")
                               : reason->value == raw      ? std::string()
                                                           : fmt::format(" (the next step is {})", reason->value));
  }
  for (PlanReason& r : reasons)
    if (r.parameter == info_of(&Config::count_bits).name && r.value != found.taken.count_bits) {
      r.value = found.taken.count_bits;
      r.text = "one light, a point or at infinity, and no table";
    }
  widths = found.taken;
  data_->lowered.push_back(found);
  if (found.taken_gives.light_is_kept) return "";
  return fmt::format("light is {:.2g} steps off, root mean square, more than --max-color {}",
                     found.taken_gives.light.rms(), data_->limits.color);
}

}  // namespace kage::explore
