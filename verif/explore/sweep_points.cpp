// SPDX-License-Identifier: Apache-2.0
#include "explore/sweep_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <optional>
#include <set>
#include <utility>

#include "contract/derived.hpp"
#include "kage/error.hpp"
#include "kage/light.hpp"

namespace kage::explore {
namespace {

constexpr std::array<std::pair<std::string_view, TranslucentWay>, 3> kOrders{
    {{"exact", TranslucentWay::exact},
     {"centroid", TranslucentWay::centroid},
     {"submission", TranslucentWay::submission}}};

/// An axis that is no parameter of the core.
struct LookAxis {
  std::string_view name;
  int least;
  int most;
  int Look::*member;
};
constexpr std::array<LookAxis, 4> kLookAxes{{{"SUB_BITS", kLeastSubBits, kMostSubBits, &Look::sub_bits},
                                             {"SAMPLES", 1, kMaxSamples, &Look::samples},
                                             {"CLASSES", 1, kMaxClasses, &Look::classes},
                                             {"MAX_SHADING", 0, 255, &Look::max_shading}}};

const ParamInfo* parameter(std::string_view name) {
  const auto found = std::find_if(kParams.begin(), kParams.end(), [&](const ParamInfo& p) { return p.name == name; });
  return found == kParams.end() ? nullptr : &*found;
}

std::optional<int> number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

std::string refusal(std::string_view axis, std::string_view value, const std::string& why) {
  return fmt::format("--axes {}: {} is {}", axis, value.empty() ? "an empty value" : value, why);
}

[[noreturn]] void refuse(std::string_view axis, std::string_view value, const std::string& why) {
  throw Error(refusal(axis, value, why));
}

/// A value that is one of its axis, and not possible with those of the others.
struct NotTogether : Error {
  using Error::Error;
};

int number_of(std::string_view axis, std::string_view value, int least, int most) {
  const std::optional<int> n = number(value);
  if (!n || *n < least || *n > most) refuse(axis, value, fmt::format("no whole number from {} to {}", least, most));
  return *n;
}

void need_counts(SweepPoint& p) {
  p.config.dsf_bits = std::max(p.config.dsf_bits, 1);
  p.config.fsf = 1;
  p.config.count_bits = std::max(p.config.count_bits, static_cast<int>(std::bit_width(unsigned(p.look.samples))));
}

void need_width(SweepPoint& p) {
  p.config.max_width = std::max(p.config.max_width, p.width);
  p.config.x_bits = std::max(p.config.x_bits, static_cast<int>(std::bit_width(unsigned(p.config.max_width))));
}

void set_size(SweepPoint& p, const std::string& value) {
  const std::size_t x = value.find('x');
  const auto w = number(std::string_view(value).substr(0, x));
  const auto h = x == std::string::npos ? std::nullopt : number(std::string_view(value).substr(x + 1));
  if (!w || !h || *w < 1 || *h < 1 || *w > kMaxSize || *h > kMaxSize)
    refuse("SIZE", value, fmt::format("no size like 320x240, up to {}x{}", kMaxSize, kMaxSize));
  p.width = *w;
  p.height = *h;
  need_width(p);
}

void set_look(SweepPoint& p, const LookAxis& axis, const std::string& value) {
  const int n = p.look.*axis.member = number_of(axis.name, value, axis.least, axis.most);
  if (axis.member == &Look::samples && n > 1) need_counts(p);
  if (axis.member == &Look::max_shading && n > 0 && p.config.smooth == 0) {
    p.config.smooth = 1;
    p.config.color_frac = 8;
  }
  if (axis.member != &Look::classes) return;
  need_counts(p);
  p.config.class_bits = std::max(2, static_cast<int>(std::bit_width(unsigned(n))));
}

/// Light after light has no table, one counter, and colours of spans with a sample's fraction.
void need_linear(Config& c) {
  c.dsf_bits = std::max(c.dsf_bits, 1);
  c.smooth = c.lights = c.class_bits = 1;
  c.color_frac = std::max(c.color_frac, derived::lane_level_bits(c) - 8);
}

void set_parameter(SweepPoint& p, const ParamInfo& info, const std::string& value) {
  const int n = info.member == &Config::arrangement && value == "systolic" ? 0
                : info.member == &Config::arrangement && value == "banked"
                    ? 1
                    : number_of(info.name, value, info.min, info.max);
  p.config.*info.member = n;
  if (info.member == &Config::color_frac && n > 0) p.config.smooth = 1;
  if (info.member == &Config::smooth && n > 0 && p.config.color_frac == 0) p.config.color_frac = 8;
  if (info.member == &Config::class_bits && n > 1) p.config.count_bits = std::max(p.config.count_bits, 1);
  if (info.member == &Config::lights && n > 1) need_counts(p);
  if (info.member == &Config::lights && n > 1) p.config.class_bits = std::max(p.config.class_bits, 8);
  if ((info.member == &Config::count_bits || info.member == &Config::fsf) && n > 0)
    p.config.dsf_bits = std::max(p.config.dsf_bits, 1);
  if (info.member == &Config::dsf_bits && n > 0) p.config.fsf = 1;
  if (info.member == &Config::linear_bits && n > 0) need_linear(p.config);
  // A processor for each pixel: no more of them than the picture has columns.
  if (info.member == &Config::arrangement && n == 0) p.config.max_width = p.width;
  for (const RuleInfo& rule : kRules)
    if (!rule.holds(p.config)) rule.repair(p.config);
  if (p.config.*info.member != n || p.config.max_width < p.width)
    throw NotTogether(
        refusal(info.name, value, "not possible with the other parameters: docs/stream.md, Parameters, has the rules"));
  validate(p.config, fmt::format("--axes {}={}", info.name, value));
}

/// The value that a point has on an axis, as its picture and core show it: one sample where a counter holds no more.
std::string value_of(const SweepPoint& p, std::string_view axis) {
  if (axis == "SIZE") return fmt::format("{}x{}", p.width, p.height);
  if (axis == "ORDER")
    return std::string(std::find_if(kOrders.begin(), kOrders.end(), [&](const auto& o) {
                         return o.second == p.look.translucent;
                       })->first);
  if (axis == "SAMPLES") return std::to_string(samples_of(p));
  // A table tells as many classes apart as its bits do; without one there are none.
  if (axis == "CLASSES")
    return std::to_string(derived::has_table(p.config) ? std::min(p.look.classes, derived::most_class(p.config)) : 0);
  // Without smooth colour nothing is diced.
  if (axis == "MAX_SHADING") return std::to_string(p.config.smooth > 0 ? p.look.max_shading : 0);
  if (axis == "SUB_BITS") return std::to_string(p.look.sub_bits);
  return std::to_string(p.config.*parameter(axis)->member);
}

/// A point of a grid, and why it is none: a value that it names is not there. Empty: it is one.
struct Combination {
  SweepPoint point;
  std::string why;
};

/// Sets the values in this order, and looks whether all of them are there in the end.
void set_all(Combination& c, std::span<const SweepAxis> axes, std::span<const std::size_t> chosen,
             std::span<const std::size_t> order) {
  c.why.clear();
  std::vector<std::string> given(axes.size());
  for (const std::size_t i : order) {
    try {
      c.point = with(c.point, axes[i].name, axes[i].values[chosen[i]]);
    } catch (const NotTogether&) {
      if (c.why.empty()) c.why = fmt::format("{} is not possible with the others", axes[i].name);
    }
    given[i] = value_of(c.point, axes[i].name);
  }
  for (std::size_t i = 0; i < axes.size() && c.why.empty(); ++i) {
    const std::string has = value_of(c.point, axes[i].name);
    if (has != given[i]) c.why = fmt::format("{} becomes {}", axes[i].name, has);
  }
}

Combination combination(const SweepPoint& base, std::span<const SweepAxis> axes, std::span<const std::size_t> chosen) {
  Combination c{base, {}};
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < axes.size(); ++i) order.push_back(i);
  // A processor for each column: the columns come first.
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return axes[i].name == "SIZE"; });
  set_all(c, axes, chosen, order);
  // A value may change another named value, which stays if it is set later: COLOR_FRAC 0 and SMOOTH.
  if (const std::string why = c.why; !why.empty()) {
    std::reverse(order.begin(), order.end());
    set_all(c, axes, chosen, order);
    if (!c.why.empty()) c.why = why;
  }
  c.point.axis = "grid";
  c.point.value.clear();
  for (std::size_t i = 0; i < axes.size(); ++i)
    c.point.value += fmt::format("{}{}={}", i == 0 ? "" : " ", axes[i].name, axes[i].values[chosen[i]]);
  return c;
}

/// The numbers of a list as texts, as axes take them.
std::vector<std::string> texts(std::initializer_list<int> values) {
  std::vector<std::string> out;
  for (const int v : values) out.push_back(std::to_string(v));
  return out;
}

SweepPoint with_all(SweepPoint p, std::string axis, std::string value,
                    std::initializer_list<std::pair<std::string_view, int>> values) {
  for (const auto& [name, v] : values) p = with(p, name, std::to_string(v));
  p.axis = std::move(axis);
  p.value = std::move(value);
  return p;
}

/// Each point once, the first of those that are one.
std::vector<SweepPoint> each_once(std::vector<SweepPoint> points) {
  std::set<std::string> seen;
  std::erase_if(points, [&](const SweepPoint& p) { return !seen.insert(text_of(p)).second; });
  return points;
}

void add_corners(const SweepPoint& base, const Needs& needs, std::vector<SweepPoint>& out) {
  const bool soft = needs.samples > 1;
  const bool smooth = needs.smooth;
  SweepPoint coarse = with_all(base, "corner", "coarse", {{"SUB_BITS", 4}, {"Z_BITS", 12}, {"Z_FRAC", 4}});
  SweepPoint fine =
      with_all(base, "corner", "fine", {{"SUB_BITS", 8}, {"Z_BITS", kGreatest.z_bits}, {"Z_FRAC", kGreatest.z_frac}});
  if (needs.shadows) {
    coarse = with_all(coarse, "corner", "coarse", {{"SHADE_FRAC", 4}});
    fine = with_all(fine, "corner", "fine", {{"SHADE_FRAC", kGreatest.shade_frac}});
  }
  if (smooth) {
    coarse = with_all(coarse, "corner", "coarse", {{"SMOOTH", 0}});
    fine = with_all(fine, "corner", "fine", {{"COLOR_FRAC", kGreatest.color_frac}});
  }
  if (soft) {
    coarse = with_all(coarse, "corner", "coarse", {{"SAMPLES", 1}, {"COUNT_BITS", 1}});
    fine = with_all(fine, "corner", "fine", {{"SAMPLES", kMaxSamples}});
  }
  out.push_back(with_all(coarse, "corner", "coarse, slow", {{"LANES", 1}, {"BEAT_WORDS", 1}}));
  out.push_back(with_all(coarse, "corner", "coarse, fast", {{"LANES", 32}, {"BEAT_WORDS", 8}}));
  out.push_back(with_all(fine, "corner", "fine, slow", {{"LANES", 1}, {"BEAT_WORDS", 1}}));
  out.push_back(with_all(fine, "corner", "fine, fast", {{"LANES", 32}, {"BEAT_WORDS", 8}}));
}

}  // namespace

std::string text_of(const SweepPoint& p) {
  std::string text = fmt::format("{}x{}", p.width, p.height);
  for (const ParamInfo& info : kParams) text += fmt::format(" {}={}", info.name, p.config.*info.member);
  return text + fmt::format(" SUB_BITS={} SAMPLES={} CLASSES={} MAX_SHADING={} ORDER={} SEED={} CULL={}",
                            p.look.sub_bits, p.look.samples, p.look.classes, p.look.max_shading,
                            static_cast<int>(p.look.translucent), p.look.seed, p.look.cull ? 1 : 0);
}

int samples_of(const SweepPoint& p) {
  // Lights without shadows shine from their samples, which nothing counts.
  const bool fits = p.config.dsf_bits == 0 || p.look.samples >> p.config.count_bits == 0;
  return fits ? p.look.samples : 1;
}

std::vector<std::string> axis_names() {
  std::vector<std::string> names;
  for (const LookAxis& a : kLookAxes) names.emplace_back(a.name);
  names.insert(names.end(), {"ORDER", "SIZE"});
  for (const ParamInfo& p : kParams) names.emplace_back(p.name);
  return names;
}

SweepAxis parse_axis(const std::string& text) {
  const std::size_t sign = text.find('=');
  SweepAxis axis{text.substr(0, sign), {}};
  const auto names = axis_names();
  if (std::find(names.begin(), names.end(), axis.name) == names.end())
    throw Error(fmt::format("--axes {}: there is no axis {}; there are {}", text, axis.name, fmt::join(names, ", ")));
  if (sign == std::string::npos || sign + 1 == text.size())
    throw Error(fmt::format("--axes {}: it has no values, as in --axes Z_BITS=12,16,20", text));
  for (std::size_t at = sign + 1; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    axis.values.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return axis;
}

SweepPoint with(const SweepPoint& base, std::string_view axis, const std::string& value) {
  SweepPoint p = base;
  p.axis = axis;
  p.value = value;
  if (axis == "SIZE") {
    set_size(p, value);
  } else if (axis == "ORDER") {
    const auto found = std::find_if(kOrders.begin(), kOrders.end(), [&](const auto& o) { return o.first == value; });
    if (found == kOrders.end()) refuse(axis, value, "none of exact, centroid, submission");
    p.look.translucent = found->second;
  } else if (const auto look =
                 std::find_if(kLookAxes.begin(), kLookAxes.end(), [&](const LookAxis& a) { return a.name == axis; });
             look != kLookAxes.end()) {
    set_look(p, *look, value);
  } else if (const ParamInfo* info = parameter(axis)) {
    set_parameter(p, *info, value);
  } else {
    throw Error(fmt::format("there is no axis {}", axis));
  }
  return p;
}

std::vector<SweepPoint> alone(const SweepPoint& base, std::span<const SweepAxis> axes) {
  std::vector<SweepPoint> out{base};
  for (const SweepAxis& axis : axes)
    for (const std::string& value : axis.values) out.push_back(with(base, axis.name, value));
  return each_once(std::move(out));
}

void add_axis(std::vector<SweepAxis>& axes, SweepAxis axis) {
  const auto found =
      std::find_if(axes.begin(), axes.end(), [&](const SweepAxis& known) { return known.name == axis.name; });
  if (found == axes.end())
    axes.push_back(std::move(axis));
  else
    found->values.insert(found->values.end(), axis.values.begin(), axis.values.end());
}

Grid grid(const SweepPoint& base, std::span<const SweepAxis> axes) {
  Grid out;
  std::vector<std::size_t> chosen(axes.size(), 0);
  std::size_t count = 1;
  for (const SweepAxis& axis : axes) count *= axis.values.size();
  for (std::size_t n = 0; n < count; ++n) {
    // The last axis goes first, as digits of a number do.
    for (std::size_t i = axes.size(), rest = n; i-- > 0; rest /= axes[i].values.size())
      chosen[i] = rest % axes[i].values.size();
    Combination c = combination(base, axes, chosen);
    if (c.why.empty())
      out.points.push_back(std::move(c.point));
    else if (out.left_out++ == 0)
      out.example = fmt::format("{}: {}", c.point.value, c.why);
  }
  if (out.points.empty())
    throw Error(fmt::format("--grid: no combination can have all the values that it names, as {}", out.example));
  out.points = each_once(std::move(out.points));
  return out;
}

std::vector<SweepPoint> default_points(const SweepPoint& base, const Needs& needs) {
  std::vector<SweepAxis> axes{{"SUB_BITS", texts({4, 5, 6, 7, 8})},
                              {"Z_BITS", texts({10, 12, 14, 16, 18, 20, 22, 24, 26, 28})},
                              {"Z_FRAC", texts({0, 2, 4, 6, 8, 10, 11, 12, 14, 16})}};
  if (needs.smooth) {
    axes.push_back({"SMOOTH", texts({0, 1})});
    axes.push_back({"COLOR_FRAC", texts({0, 2, 4, 6, 8, 12, 16})});
  }
  if (needs.color) axes.push_back({"CHANNELS", texts({1, 3})});
  if (needs.shadows) {
    axes.push_back({"DSF_BITS", texts({0, 1, 2, 3, 4, 8})});
    axes.push_back({"FSF", texts({0})});
    axes.push_back({"SHADE_FRAC", texts({2, 4, 6, 8, 10, 12, 16})});
    axes.push_back({"LINEAR_BITS", texts({10, 12, 14})});
  }
  if (needs.samples > 1) axes.push_back({"SAMPLES", texts({1, 3, 7, 15, 31, 63, 127, 255})});
  if (derived::has_table(base.config)) axes.push_back({"CLASSES", texts({7, 31, 127, 511, 1024, 2047})});
  if (needs.translucency) axes.push_back({"ORDER", {"exact", "centroid", "submission"}});
  axes.push_back({"LANES", texts({1, 2, 4, 8, 16, 32})});
  axes.push_back({"BEAT_WORDS", texts({1, 2, 4, 8})});
  axes.push_back({"ARRANGEMENT", {"systolic"}});
  axes.push_back({"UNITS", texts({8})});
  SweepAxis size{"SIZE", {}};
  for (const auto& [over, under] : {std::pair{1, 4}, {1, 2}, {3, 2}, {2, 1}}) {
    const int w = base.width * over / under;
    const int h = base.height * over / under;
    if (w >= 1 && h >= 1 && w <= kMaxSize && h <= kMaxSize) size.values.push_back(fmt::format("{}x{}", w, h));
  }
  axes.push_back(std::move(size));
  std::vector<SweepPoint> out = alone(base, axes);
  add_corners(base, needs, out);
  return each_once(std::move(out));
}

std::vector<SweepPoint> with_seeds(std::vector<SweepPoint> points, int seeds) {
  std::vector<SweepPoint> out = std::move(points);
  const std::size_t first = out.size();
  for (int s = 1; s < seeds; ++s)
    for (std::size_t i = 0; i < first; ++i) {
      if (samples_of(out[i]) == 1) continue;
      SweepPoint p = out[i];
      p.look.seed += static_cast<std::uint64_t>(s);
      p.value += fmt::format("{}seed {}", p.value.empty() ? "" : " ", p.look.seed);
      out.push_back(std::move(p));
    }
  return out;
}

std::string features_text(const Config& c) {
  return fmt::format(
      "arrangement {} lanes {} beat {} channels {} smooth {} shadows {} fsf {} counts {} lights {} table "
      "{} linear {} blend {} units {} classic {}",
      c.arrangement, c.arrangement == 0 ? 0 : c.lanes, c.beat_words, c.channels, c.smooth,
      c.dsf_bits == 0   ? 0
      : c.dsf_bits == 1 ? 1
                        : 2,
      c.fsf, c.count_bits > 0 ? 1 : 0, c.lights, derived::has_table(c) ? 1 : 0, c.linear_bits > 0 ? 1 : 0,
      c.translucency, c.units, c.classic);
}

}  // namespace kage::explore
