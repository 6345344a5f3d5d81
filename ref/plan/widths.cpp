// SPDX-License-Identifier: Apache-2.0
#include "plan/widths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "contract/derived.hpp"
#include "contract/params.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"
#include "plan/figures.hpp"

namespace kage::plan {
namespace {

int bits_for(double greatest) { return static_cast<int>(std::bit_width(static_cast<unsigned>(greatest))); }

/// " (10 would do; the next step is 11)".
std::string step_text(int least, int taken) {
  return taken == least ? std::string() : fmt::format(" ({} would do; the next step is {})", least, taken);
}

/// "; 9 cannot represent the scene": what one less than `least` would break. Nothing where no core has less.
std::string one_less_text(int least, const ParamInfo& p) {
  return least <= p.min ? std::string() : fmt::format("; {} cannot represent the scene", least - 1);
}

/// "12 pixels", of a whole number that was searched for as the greatest.
std::string counted_most(const Most& most, std::string_view singular, std::string_view plural) {
  return counted(static_cast<int>(most.value), singular, plural);
}

/// "0.8 steps", "1 step".
std::string steps_text(const std::string& figure) { return figure + (figure == "1" ? " step" : " steps"); }

/// The largest difference that a group's samples can make at a pixel whose colour is off by `before`. Each sample of a
/// light adds its share's error of a full colour, less its share of the difference that the colour has already. Samples
/// that would lessen the difference are left out.
double group_error(const ShareGroup& group, double before, int shade_frac) {
  double error = before;
  for (const Share& s : group.shares) {
    const double share = s.value * 0x1p-16;
    const double unit = std::ldexp(1.0, -shade_frac);
    const double kept = std::floor(share / unit + 0.5) * unit;
    // The share itself is known to 2^-17; the rounding of it is at most half a unit.
    const double off = std::min(std::abs(share - kept) + 0x1p-17, unit / 2);
    error += s.samples * std::max(0.0, 255 * off - before * share);
  }
  return error;
}

class Maker {
 public:
  Maker(std::span<const PlannedScene> scenes, const Features& features, const WayDemand& way, const UnitDemand* units,
        const PlanLimits& limits, Unkept unkept)
      : scenes_(scenes), features_(features), way_(way), units_(units), limits_(limits), unkept_(unkept) {
    out_.color_limit = limits.color;
  }

  Widths run() {
    positions();
    depth();
    shadows();
    color();
    rest();
    validate(out_.config, "plan");
    return std::move(out_);
  }

 private:
  void set(int Config::*member, int value, std::string text) {
    out_.config.*member = value;
    out_.reasons.push_back({info_of(member).name, value, std::move(text)});
  }
  [[nodiscard]] std::string at(const Most& most) const { return text_of(scenes_, most.at); }

  void positions() {
    const int width = features_.needs.width;
    const int least = bits_for(width);
    const int taken = position_step(least);
    set(&Config::x_bits, taken,
        fmt::format("positions reach {}, which {}{}{}", width, counted(least, "bit holds", "bits hold"),
                    one_less_text(least, info_of(&Config::x_bits)), step_text(least, taken)));
    const int max_width = std::min(width_step(width), (1 << taken) - 1);
    set(&Config::max_width, max_width,
        fmt::format("lines of {}{}{}", counted(width, "pixel"), one_less_text(width, info_of(&Config::max_width)),
                    max_width == width ? std::string() : fmt::format("; the next named width is {}", max_width)));
  }

  void depth() {
    const int width = features_.needs.width;
    const int height = features_.needs.height;
    const double pixels = std::max(way_.depth_span.value, 1.0);
    const auto share = [&](int bits, int frac) { return depth_error_share(pixels, bits, frac, width, height); };
    const ParamInfo& z = info_of(&Config::z_bits);
    const ParamInfo& f = info_of(&Config::z_frac);
    const std::string span = counted(static_cast<int>(pixels), "pixel");
    int bits = z.min;
    while (bits <= z.max && share(bits, f.max) > limits_.z) ++bits;
    if (bits > z.max && unkept_ == Unkept::refuse)
      throw Error(fmt::format("--max-z {:.3g}: with {} bits of depth the bound is {:.3g} already (longest span {}, {})",
                              limits_.z, z.max, share(z.max, f.max), span, at(way_.depth_span)));
    bits = std::min(bits, z.max);
    const int taken = four_step(bits);
    set(&Config::z_bits, taken,
        fmt::format("with {} {}, {} keep {} of the range{}{}", f.name, f.max, bits, share_text(share(bits, f.max)),
                    bits == z.min ? "" : fmt::format(", {} give {}", bits - 1, over_text(share(bits - 1, f.max))),
                    step_text(bits, taken)));
    int frac = f.min;
    while (frac < f.max && share(taken, frac) > limits_.z) ++frac;
    const int frac_taken = position_step(std::max(frac, 1));
    set(&Config::z_frac, frac_taken,
        fmt::format("longest span {} in {}: {} keep {} of the range{}{}", span, at(way_.depth_span), frac,
                    share_text(share(taken, frac)),
                    frac == f.min ? "" : fmt::format(", {} give {}", frac - 1, over_text(share(taken, frac - 1))),
                    frac == frac_taken ? ""
                                       : fmt::format(" ({} would do; the next step, {}, keeps {})", frac, frac_taken,
                                                     share_text(share(taken, frac_taken)))));
    out_.z_error = share(taken, frac_taken);
  }

  /// A share of the range beside --max-z, in as many digits as show that it is within.
  [[nodiscard]] std::string share_text(double share) const { return told_apart(share, limits_.z).value; }
  [[nodiscard]] std::string over_text(double share) const {
    const FigureText text = told_apart(share, limits_.z);
    return fmt::format("{}, more than --max-z {}", text.value, text.limit);
  }

  void shadows() {
    const Needs& needs = features_.needs;
    if (!needs.shadows) {
      set(&Config::dsf_bits, 0,
          "nothing opaque casts a shadow, or what does is one convex body, which keeps no light from itself");
      set(&Config::fsf, 0, "no shadows");
      set(&Config::count_bits, 0, "no shadows");
      set(&Config::lights, 1, "no shadows");
      set(&Config::class_bits, 1, "no shadows");
      return;
    }
    // Commands refuse a core of parity without FSF where casters may have several volumes, whatever these frames have.
    const bool several = way_.volumes.value > 1;
    const int dsf_bits = way_.way.dsf_bits;
    const bool possible = dsf_bits == 1 && needs.several_volumes;
    const std::string volumes = counted(static_cast<int>(way_.volumes.value), "volume");
    Config of_way;
    of_way.dsf_bits = dsf_bits;
    set(&Config::dsf_bits, dsf_bits,
        dsf_bits == 1
            ? fmt::format("parity: {} for a light sample at most, {}{}", volumes, at(way_.volumes),
                          one_less_text(1, info_of(&Config::dsf_bits)))
            : fmt::format("counting to {}: {} for a light sample at most, {}; {} is another way, and costed too",
                          derived::most_dsf(of_way), volumes, at(way_.volumes), dsf_bits - 1));
    set(&Config::fsf, several || possible ? 1 : 0,
        several    ? "several volumes for a light sample; 0 cannot represent the scene"
        : possible ? "one volume for each light sample here; several casters, or one that is not convex, may have "
                     "more, and 0 cannot represent the scene then"
                   : "one volume for each light sample");
    if (way_.way.linear) return light_after_light();
    const bool table = needs.lights > 1 || needs.share_error > limits_.color;
    const bool counts = needs.samples > 1 || table;
    const int count = counts ? bits_for(needs.samples) : 0;
    set(&Config::count_bits, count,
        !counts ? "one light, a point or at infinity, and no table"
        : needs.samples == 1 && needs.lights == 1
            ? fmt::format(
                  "one light, a point or at infinity, with a table; without one, and its counter, one share for "
                  "all leaves shadows {} off, root mean square, more than --max-color {}",
                  steps(needs.share_error), limits_.color)
            : fmt::format("{} for a light, {}{}", counted(needs.samples, "sample"), counted(needs.lights, "light"),
                          one_less_text(count, info_of(&Config::count_bits))));
    set(&Config::lights, needs.lights,
        needs.lights == 1
            ? "one light"
            : fmt::format("{} lights{}", needs.lights, one_less_text(needs.lights, info_of(&Config::lights))));
    if (table)
      classes();
    else
      set(&Config::class_bits, 1,
          fmt::format("with one share for all shadows they are {} off, root mean square", steps(needs.share_error)));
  }

  void light_after_light() {
    const Needs& needs = features_.needs;
    const int count = needs.samples > 1 ? bits_for(needs.samples) : 0;
    set(&Config::count_bits, count,
        count == 0 ? "every light is a point or at infinity"
                   : fmt::format("{} for a light{}", counted(needs.samples, "sample"),
                                 one_less_text(count, info_of(&Config::count_bits))));
    set(&Config::lights, 1, fmt::format("one counter for {}, one after the other", counted(needs.lights, "light")));
    set(&Config::class_bits, 1, "light after light has no table");
  }

  /// The first step whose classes keep the limit, or the last.
  void classes() {
    const Needs& needs = features_.needs;
    std::size_t step = 0;
    while (step + 1 < kClassSteps.size() && way_.class_errors[step].value > limits_.color) ++step;
    const Most& error = way_.class_errors[step];
    out_.class_error = error;
    const std::string before = step > 0 ? fmt::format("; {} leave {}, more than --max-color {}", kClassSteps[step - 1],
                                                      steps(way_.class_errors[step - 1].value), limits_.color)
                               : needs.lights > 1
                                   ? std::string("; 1 cannot represent the scene")
                                   : fmt::format("; one share for all leaves {}, more than --max-color {}",
                                                 steps(needs.share_error), limits_.color);
    set(&Config::class_bits, kClassSteps[step],
        fmt::format("{} classes leave shadows {} off, root mean square, in {}{}", (1 << kClassSteps[step]) - 1,
                    steps(error.value), at(error), before));
  }

  static std::string steps(double error) { return steps_text(fmt::format("{:.2g}", error)); }

  [[nodiscard]] bool smooth() const { return features_.needs.smooth || features_.needs.color_spread > limits_.color; }

  /// The least SHADE_FRAC with which a drawn colour off by `drawn` is shown within the limit; none: past the greatest.
  [[nodiscard]] int shade_frac(double drawn) const {
    const ParamInfo& p = info_of(&Config::shade_frac);
    int frac = p.min;
    while (frac <= p.max && shown_error(drawn, way_.groups, frac) > out_.color_limit) ++frac;
    return frac;
  }

  /// Says which channels there are; refuses a limit that the finest widths are not sure to keep, or raises it.
  template <class Feasible>
  void begin_color(Feasible feasible, std::string_view because) {
    if (!feasible()) {
      const int asked = out_.color_limit;
      while (!feasible() && out_.color_limit < 255) ++out_.color_limit;
      if (limits_.color_given && unkept_ == Unkept::refuse)
        throw Error(fmt::format("--max-color {}: no widths keep it, because {}; --max-color {} can be kept", asked,
                                because, out_.color_limit));
    }
    set(&Config::channels, features_.needs.color ? 3 : 1,
        features_.needs.color ? "some colour is not grey; 1 cannot represent the scene"
                              : "all colours in view are grey");
  }

  void color() {
    if (way_.way.linear) return linear_color();
    const Needs& needs = features_.needs;
    const ParamInfo& c = info_of(&Config::color_frac);
    const ParamInfo& s = info_of(&Config::shade_frac);
    const auto feasible = [&] { return shade_frac(smooth() ? color_error(way_.color_span.value, c.max) : 0) <= s.max; };
    begin_color(feasible, fmt::format("shares of {} bits fraction are off by more", s.max));
    if (!smooth()) {
      set(&Config::smooth, 0,
          needs.color_spread > 0
              ? fmt::format("each polygon has one colour, by which light is {} off", steps(needs.color_spread))
              : "each polygon has one colour");
      set(&Config::color_frac, 0, "no slopes of colour");
    } else {
      set(&Config::smooth, 1,
          needs.smooth ? "colour varies within a face; 0 cannot represent the scene"
                       : fmt::format("light varies within a face: with 0 it is {} off, more than --max-color {}",
                                     steps(needs.color_spread), limits_.color));
      color_frac(c, s);
    }
    const double drawn = smooth() ? color_error(way_.color_span.value, out_.config.color_frac) : 0;
    if (!needs.shadows) {
      set(&Config::shade_frac, s.min, "no shadows");
      return;
    }
    const int frac = std::min(shade_frac(drawn), s.max);
    const int taken = std::min(four_step(frac), s.max);
    const auto shown = [&](int f) { return told_apart(shown_error(drawn, way_.groups, f), out_.color_limit, 2).value; };
    set(&Config::shade_frac, taken,
        fmt::format("{} show colours within {}{}{}", frac, steps_text(shown(frac)),
                    frac == s.min ? ""
                                  : fmt::format(", {} within {}, more than --max-color {}", frac - 1, shown(frac - 1),
                                                out_.color_limit),
                    step_text(frac, taken)));
  }

  /// LINEAR_BITS with the finest COLOR_FRAC, and then that.
  void linear_color() {
    const ParamInfo& b = info_of(&Config::linear_bits);
    const ParamInfo& c = info_of(&Config::color_frac);
    const double pixels = std::max(way_.color_span.value, 1.0);
    const auto off = [&](int bits, int frac) {
      return linear_error(way_.lights.value, way_.lit_samples.value, pixels, bits, frac);
    };
    const auto keeps = [&](int bits, int frac) { return std::ceil(off(bits, frac)) <= out_.color_limit; };
    begin_color([&] { return keeps(b.max, c.max); },
                fmt::format("{} one after the other, by {} bits, are off by more where it is dark",
                            counted(static_cast<int>(way_.lights.value), "light"), b.max));
    set(&Config::smooth, 1, "light after light takes a fraction of colour, and no core has fewer for it");
    const auto figure = [&](int bits, int frac) { return told_apart(off(bits, frac), out_.color_limit, 2).value; };
    const int least = least_linear_bits();
    int bits = least;
    while (bits < b.max && !keeps(bits, c.max)) ++bits;
    set(&Config::linear_bits, bits,
        fmt::format("{} of {} on a line, {}: where it is dark, {} bits are off by {}{}",
                    counted(static_cast<int>(way_.lights.value), "light"),
                    counted(static_cast<int>(way_.lit_samples.value), "sample"), at(way_.lit_samples), bits,
                    steps_text(figure(bits, c.max)),
                    bits == least ? ""
                                  : fmt::format(", {} by {}, more than --max-color {}", bits - 1,
                                                figure(bits - 1, c.max), out_.color_limit)));
    const int floor = std::max(0, bits + out_.config.count_bits - 8);
    int frac = floor;
    while (frac < c.max && !keeps(bits, frac)) ++frac;
    const int taken = std::min(four_step(frac), c.max);
    set(&Config::color_frac, taken,
        fmt::format("{}: with {} light is off by {}{}{}",
                    way_.color_span.at.scene < 0
                        ? "no span changes colour"
                        : fmt::format("longest span that changes colour {} in {}",
                                      counted(static_cast<int>(pixels), "pixel"), at(way_.color_span)),
                    frac, steps_text(figure(bits, frac)),
                    frac == floor ? "; no core has fewer for a sample's light"
                                  : fmt::format(", with {} by {}, more than --max-color {}", frac - 1,
                                                figure(bits, frac - 1), out_.color_limit),
                    step_text(frac, taken)));
    set(&Config::shade_frac, info_of(&Config::shade_frac).min, "light after light takes no shares");
  }

  void color_frac(const ParamInfo& c, const ParamInfo& s) {
    const double pixels = std::max(way_.color_span.value, 1.0);
    int frac = c.min;
    const auto serves = [&](int f) {
      const double drawn = color_error(pixels, f);
      return std::ceil(drawn) <= out_.color_limit && shade_frac(drawn) <= s.max;
    };
    while (frac < c.max && !serves(frac)) ++frac;
    const int taken = std::min(four_step(frac), c.max);
    set(&Config::color_frac, taken,
        fmt::format("longest span that changes colour {} in {}: {} are off by {}{}{}",
                    counted(static_cast<int>(pixels), "pixel"), at(way_.color_span), frac,
                    steps_text(told_apart(color_error(pixels, frac), out_.color_limit).value),
                    frac == c.min ? "" : ", " + coarser_color_text(pixels, frac - 1), step_text(frac, taken)));
  }

  /// Why a COLOR_FRAC does not do: by itself, or because no share is fine enough for what it leaves.
  [[nodiscard]] std::string coarser_color_text(double pixels, int frac) const {
    const double off = color_error(pixels, frac);
    const FigureText text = told_apart(off, out_.color_limit);
    return std::ceil(off) > out_.color_limit
               ? fmt::format("{} by {}, more than --max-color {}", frac, text.value, text.limit)
               : fmt::format("{} by {}, and then no SHADE_FRAC keeps --max-color {}", frac, text.value, text.limit);
  }

  void rest() {
    set(&Config::translucency, features_.needs.translucency ? 1 : 0,
        features_.needs.translucency ? "something translucent is in view; 0 cannot represent the scene"
                                     : "all that is in view is opaque");
    if (units_ == nullptr || units_->units.value < 1) {
      set(&Config::units, 0, units_ == nullptr ? "convex bodies go by spans" : "no convex body can go to a unit");
      return;
    }
    const int units = static_cast<int>(units_->units.value);
    set(&Config::units, units,
        fmt::format("{}, sharing units, {}; {}", counted_most(units_->bodies, "body at a time", "bodies at a time"),
                    at(units_->units),
                    units == 1 ? std::string("0 is another way, and costed too")
                               : fmt::format("{} have no room for that", units - 1)));
    set_room(&Config::face_bits, bits_for(units_->faces.value),
             fmt::format("{}, {}; all ones is blank", counted_most(units_->faces, "face in a unit", "faces in a unit"),
                         at(units_->faces)));
    set_room(&Config::dx_bits, bits_for(units_->dx.value),
             fmt::format("a segment of {}, {}", counted_most(units_->dx, "pixel", "pixels"), at(units_->dx)));
    set_room(&Config::seg_bits, bits_for(units_->segments.value - 1),
             fmt::format("{} of a unit on a line, {}", counted_most(units_->segments, "segment", "segments"),
                         at(units_->segments)));
    set_room(&Config::order_bits, bits_for(units_->last_index.value),
             fmt::format("the last body in a unit is number {:.0f}, from 0, {}", units_->last_index.value,
                         at(units_->last_index)));
  }

  /// Sets a width that gives room for the bodies that go to units.
  void set_room(int Config::*member, int least, const std::string& text) {
    const ParamInfo& p = info_of(member);
    const int value = std::max(p.min, least);
    set(member, value, value == p.min ? text : fmt::format("{}; {} have no room for that", text, value - 1));
  }

  std::span<const PlannedScene> scenes_;
  const Features& features_;
  const WayDemand& way_;
  const UnitDemand* units_;
  const PlanLimits& limits_;
  Unkept unkept_;
  Widths out_;
};

}  // namespace

int least_linear_bits() { return std::countr_zero(info_of(&Config::linear_bits).allowed >> 1) + 1; }

int position_step(int least) {
  for (const int step : {8, 11, 12, 15})
    if (step >= least) return step;
  return least;
}

int four_step(int least) { return (least + 3) / 4 * 4; }

int class_step(int least) {
  const auto step = std::find_if(kClassSteps.begin(), kClassSteps.end(), [&](int s) { return s >= least; });
  return step != kClassSteps.end() ? *step : least;
}

int width_step(int least) {
  int best = 0;
  for (const NamedConfig& n : named_configs())
    if (n.config.max_width >= least && (best == 0 || n.config.max_width < best)) best = n.config.max_width;
  return best == 0 ? least : best;
}

double depth_error(double pixels, int z_frac, int width, int height) {
  const double planes = (width + height + 1) * 0x1p-25 + 0x1p-16;
  return pixels * std::ldexp(0.5, -z_frac) + (z_frac > 0 ? 0.5 : 0.0) + planes;
}

double depth_error_share(double pixels, int z_bits, int z_frac, int width, int height) {
  return depth_error(pixels, z_frac, width, height) / (std::ldexp(1.0, z_bits) - 3);
}

double color_error(double pixels, int color_frac) { return pixels * std::ldexp(0.5, -color_frac); }

double linear_error(double lights, double samples, double pixels, int linear_bits, int color_frac) {
  constexpr double kSteepest = 12.92 * 255;  // the least light's part of sRGB (IEC 61966-2-1), in steps
  // The light from everywhere is rounded once to the pixel's bits. A light is, too, and each of its samples to finer
  // ones: together less than a step. Slopes are off by half of the fraction's last place at each pixel, in 2^-8.
  const double rounded = (lights + 0.5) * std::ldexp(1.0, -linear_bits);
  const double drawn = (1 + samples) * color_error(pixels, color_frac) / 256;
  return kSteepest * (rounded + drawn);
}

double shown_error(double drawn, std::span<const ShareGroup> groups, int shade_frac) {
  const double before = std::ceil(drawn);
  double most = before;
  for (const ShareGroup& g : groups) most = std::max(most, group_error(g, before, shade_frac));
  return most;
}

Widths widths_of(std::span<const PlannedScene> scenes, const Features& features, const WayDemand& way,
                 const UnitDemand* units, const PlanLimits& limits, Unkept unkept) {
  return Maker(scenes, features, way, units, limits, unkept).run();
}

}  // namespace kage::plan
