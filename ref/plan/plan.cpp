// SPDX-License-Identifier: Apache-2.0
#include "kage/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "contract/derived.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"
#include "plan/costs.hpp"
#include "plan/demand.hpp"
#include "plan/widths.hpp"

namespace kage {
namespace {

/// All configurations with the widths of one way.
struct Way {
  plan::Widths widths;
  std::vector<PlanCandidate> all;
  std::string unkept;  // how far light is off, if no widths keep the limit
};

class Planner {
 public:
  Planner(std::span<const PlannedScene> scenes, const PlanOptions& options) : scenes_(scenes), options_(options) {
    for (const PlannedScene& s : scenes) {
      const int frames = plan::frames_of(s);
      out_.frames += frames;
      out_.pixels += static_cast<std::uint64_t>(frames) * static_cast<std::uint64_t>(s.draw.width) *
                     static_cast<std::uint64_t>(s.draw.height);
    }
  }

  Plan run() {
    features_ = plan::features_of(scenes_);
    out_.size = {features_.needs.width, features_.needs.height};
    check();
    look();
    if (ways_.empty()) throw Error(*refused_);
    leave_out();
    choose();
    if (options_.front_end) add_front_end();
    return std::move(out_);
  }

 private:
  void check() const {
    const int height = features_.needs.height;
    if (options_.clock && total_lines() <= height)
      throw Error(
          fmt::format("a frame's time of {} lines leaves none blank beside the picture's {}, and a display has one "
                      "at least",
                      total_lines(), height));
  }

  /// Finds the frames' demands: units, and each way to draw shadows.
  void look() {
    const bool shadows = features_.needs.shadows;
    // One pass looks for units. Each way is looked at once, and costed by spans and, if anything goes to units, with
    // units. Until it is known better there are units, and with shadows two ways: parity and one that counts.
    passes_ = 1 + 3 * (shadows ? 2 : 1);
    units_ = plan::unit_demand_of(scenes_, features_, [this] { step(); });
    of_way_ = units_.units.value >= 1 ? 3 : 2;
    const bool table = !shadows || features_.needs.lights <= kGreatest.lights;
    if (table) look_at(false);
    // With one light a table takes less than light after light, wherever it serves.
    linear_ = shadows && (!table || features_.needs.lights > 1 || !serves());
    if (linear_) look_at(true);
  }

  /// Parity, then counting with more and more bits, until there is one volume for each light sample.
  void look_at(bool linear) {
    const bool shadows = features_.needs.shadows;
    const std::size_t first = demands_.size();
    const auto count_passes = [this](std::size_t demands) {
      passes_ = (options_.front_end ? 2 : 1) + of_way_ * static_cast<int>(demands);
    };
    for (int bits = shadows ? 1 : 0; bits <= (shadows ? kGreatest.dsf_bits : 0); ++bits) {
      count_passes(std::max(demands_.size() + 1, first + 2));
      demands_.push_back(plan::demand_of(scenes_, features_, {bits, linear}, [this] { step(); }));
      if (demands_.back().volumes.value <= 1) break;
    }
    count_passes(demands_.size());
    for (std::size_t i = first; i < demands_.size(); ++i) add_ways(demands_[i]);
  }

  /// The limit of colour that a way is sure to keep: its widths', and its classes'. Pictures say it of ways that were
  /// measured.
  [[nodiscard]] int kept_by(const Way& w) const {
    if (options_.lower) return w.unkept.empty() ? 0 : 1;
    return std::max(w.widths.color_limit, static_cast<int>(std::ceil(w.widths.class_error.value)));
  }
  /// The least of them.
  [[nodiscard]] int least_kept() const {
    int least = 256;
    for (const Way& w : ways_) least = std::min(least, kept_by(w));
    return least;
  }
  /// Whether the classes of some way keep what was asked for, or its pictures, if they were measured.
  [[nodiscard]] bool serves() const {
    return std::any_of(ways_.begin(), ways_.end(), [this](const Way& w) { return w.unkept.empty() && !is_rough(w); });
  }
  [[nodiscard]] bool is_rough(const Way& w) const {
    return !options_.lower && w.widths.class_error.value > options_.limits.color;
  }

  /// Leaves out the ways that keep less than another one does, or than was asked for.
  void leave_out() {
    const int limit = std::max(least_kept(), options_.lower ? 0 : options_.limits.color);
    for (const Way& w : ways_)
      if (kept_by(w) > limit && w.widths.config.linear_bits == 0) left_out_ = left_out_text(w, limit);
    std::erase_if(ways_, [&](const Way& w) { return kept_by(w) > limit; });
  }
  [[nodiscard]] std::string left_out_text(const Way& table, int limit) const {
    if (options_.lower) return "with a table " + table.unkept;
    const plan::Most& error = table.widths.class_error;
    if (std::ceil(error.value) <= limit)
      return fmt::format("with a table widths are sure to keep --max-color {} alone", table.widths.color_limit);
    return fmt::format("{} classes leave shadows {:.2g} steps off, root mean square, in {}, more than --max-color {}",
                       derived::most_class(table.widths.config), error.value, plan::text_of(scenes_, error.at), limit);
  }

  /// ACTIVE changes no pixel and no other parameter, so the chosen core gets as much as its frames ask for. The cores
  /// that it is compared with get as much.
  void add_front_end() {
    const plan::FrontEndDemand demand = plan::front_end_demand_of(scenes_, out_.config, [this] { step(); });
    out_.polygon_words = demand.words;
    const int most = static_cast<int>(demand.active.value);
    out_.config.active = std::max(1, most);
    plan::estimate_cells(out_.cost, out_.config);
    const auto with_front_end = [this](PlanCandidate& c) {
      c.config.active = out_.config.active;
      plan::estimate_cells(c.cost, c.config);
    };
    std::ranges::for_each(out_.others, with_front_end);
    if (out_.least) with_front_end(*out_.least);
    for (PlanReason& r : out_.reasons) {
      if (r.parameter != "ACTIVE") continue;
      r.value = out_.config.active;
      r.text = demand.left > 0
                   ? fmt::format("the most that a front end keeps; for {} it has no room, and they go as spans",
                                 counted(demand.left, "polygon"))
               : most > 0 ? fmt::format("{} at once in {}; with one less, some go as spans", counted(most, "polygon"),
                                        plan::text_of(scenes_, demand.active.at))
                          : "no polygon goes to the front end, and 0 is a core without one";
    }
  }

  /// A frame begins. The reported progress never falls, even where more passes turn out to be needed.
  void step() {
    told_ = std::max(told_, static_cast<double>(steps_) / (static_cast<double>(passes_) * out_.frames));
    ++steps_;
    if (options_.progress) options_.progress(told_);
  }

  static std::string name_of(const plan::WayDemand& d, const plan::UnitDemand* units) {
    const int bits = d.way.dsf_bits;
    std::string name = bits == 0   ? "no shadows"
                       : bits == 1 ? std::string("parity")
                                   : fmt::format("counting, {} bits", bits);
    if (d.way.linear) name += ", light after light";
    if (units != nullptr) name += ", " + counted(static_cast<int>(units->units.value), "unit");
    return name;
  }

  void add_ways(const plan::WayDemand& demand) {
    add_way(demand, nullptr);
    if (units_.units.value >= 1) add_way(demand, &units_);
  }

  void add_way(const plan::WayDemand& demand, const plan::UnitDemand* units) {
    Way way;
    try {
      way.widths = plan::widths_of(scenes_, features_, demand, units, options_.limits,
                                   options_.lower ? plan::Unkept::finest : plan::Unkept::refuse);
    } catch (const Error& e) {
      if (!refused_) refused_ = e.what();
      if (!demand.way.linear)
        left_out_ = fmt::format("with a table no widths keep --max-color {}", options_.limits.color);
      return;
    }
    if (options_.lower) {
      way.unkept = options_.lower(way.widths.config, way.widths.reasons);
      way.widths.color_limit = options_.limits.color;
      validate(way.widths.config, "plan");
      way.widths.z_error =
          plan::depth_error_share(demand.depth_span.value, way.widths.config.z_bits, way.widths.config.z_frac,
                                  features_.needs.width, features_.needs.height);
    }
    way.all =
        plan::costs_of(scenes_, way.widths.config, name_of(demand, units), options_.front_end, [this] { step(); });
    if (options_.clock)
      for (PlanCandidate& c : way.all) c.cost.meets_clock = c.cost.needed_line <= line_clocks();
    ways_.push_back(std::move(way));
  }

  /// Clocks that a line of the display has.
  [[nodiscard]] double line_clocks() const {
    const PlanClock& clock = *options_.clock;
    return clock.mhz * 1e6 / (clock.fps * total_lines());
  }
  [[nodiscard]] int total_lines() const {
    const int given = options_.clock->total_lines;
    return given > 0 ? given : usual_total_lines(features_.needs.height);
  }

  /// Where a display sets the pace, what keeps up is not late; what does not is as late as it is slow.
  static double late_of(const PlanCandidate& c) { return c.cost.meets_clock.value_or(true) ? 0 : c.cost.needed_line; }

  /// The preferred quantity of a candidate; less is better.
  static double wanted_of(const PlanCandidate& c, Prefer prefer) {
    switch (prefer) {
      case Prefer::speed:
        return static_cast<double>(c.cost.clocks);
      case Prefer::words:
        return static_cast<double>(c.cost.words);
      default:
        return c.cost.luts;
    }
  }

  /// The candidate with the least of the preferred quantity. Candidates that keep up with the display come first; where
  /// none does, the one that comes nearest to it.
  static const PlanCandidate& least_of(const std::vector<const PlanCandidate*>& list, Prefer prefer) {
    const auto key = [&](const PlanCandidate* c) {
      return std::tuple(late_of(*c), wanted_of(*c, prefer), rest_of(*c, prefer));
    };
    return **std::min_element(list.begin(), list.end(), [&](const auto* a, const auto* b) { return key(a) < key(b); });
  }

  /// Quantities that decide, in this order, among candidates that are equal in the preferred one.
  static std::tuple<double, double, double> rest_of(const PlanCandidate& c, Prefer prefer) {
    const auto clocks = static_cast<double>(c.cost.clocks);
    const auto words = static_cast<double>(c.cost.words);
    switch (prefer) {
      case Prefer::speed:
        return {c.cost.luts, words, clocks};
      case Prefer::words:
        return {c.cost.luts, clocks, words};
      default:
        return {clocks, words, c.cost.luts};
    }
  }

  /// The one that is taken: of those that are as good as the least, by what decides among equals.
  static const PlanCandidate& best_of(const std::vector<const PlanCandidate*>& list, Prefer prefer) {
    const PlanCandidate& least = least_of(list, prefer);
    const double most = wanted_of(least, prefer) * (prefer == Prefer::words ? 1 : 1 + kAsGood);
    const PlanCandidate* best = &least;
    for (const PlanCandidate* c : list)
      if (late_of(*c) == late_of(least) && wanted_of(*c, prefer) <= most &&
          rest_of(*c, prefer) < rest_of(*best, prefer))
        best = c;
    return *best;
  }

  void choose() {
    std::vector<const PlanCandidate*> all;
    for (const Way& w : ways_)
      for (const PlanCandidate& c : w.all) all.push_back(&c);
    const PlanCandidate& taken = best_of(all, options_.prefer);
    const Way* way = nullptr;
    for (const Way& w : ways_) {
      std::vector<const PlanCandidate*> of_way;
      for (const PlanCandidate& c : w.all) of_way.push_back(&c);
      if (std::find(of_way.begin(), of_way.end(), &taken) != of_way.end())
        way = &w;
      else
        out_.others.push_back(best_of(of_way, options_.prefer));
    }
    out_.config = taken.config;
    out_.cost = taken.cost;
    if (options_.clock) out_.display_line = line_clocks();
    out_.smallest = best_of(all, Prefer::area);
    if (const PlanCandidate& least = least_of(all, options_.prefer); &least != &taken) out_.least = least;
    out_.limits = options_.limits;
    out_.limits.color = way->widths.color_limit;
    out_.z_error = way->widths.z_error;
    give_reasons(*way, taken);
  }

  void give_reasons(const Way& way, const PlanCandidate& taken) {
    for (const ParamInfo& p : kParams) {
      if (out_.config.units == 0 && of_units(p)) continue;
      const auto& given = way.widths.reasons;
      const auto r =
          std::find_if(given.begin(), given.end(), [&](const PlanReason& g) { return g.parameter == p.name; });
      std::string text = r != given.end() ? r->text : arrangement_reason(p, way, taken);
      if (p.member == &Config::class_bits && taken.config.linear_bits > 0 && !left_out_.empty())
        text += "; " + left_out_;
      if (p.member == &Config::lights && features_.needs.lights > kGreatest.lights)
        text += fmt::format("; a table tells {} apart at most", kGreatest.lights);
      out_.reasons.push_back({p.name, out_.config.*(p.member), std::move(text)});
    }
  }

  [[nodiscard]] std::string arrangement_reason(const ParamInfo& p, const Way& way, const PlanCandidate& taken) const {
    if (p.member == &Config::arrangement)
      return std::string(taken.config.arrangement != 0 ? "lanes over a line in block RAM"
                                                       : "a processor for each pixel") +
             "; both arrangements show the same pixels";
    if (p.member == &Config::lanes && taken.config.arrangement == 0) return "systolic: without effect";
    if (p.member == &Config::lanes || p.member == &Config::beat_words) return pace_reason(p, way, taken);
    if (p.member == &Config::active) return "spans come from the host; --front-end rtl plans a front end";
    if (p.member == &Config::linear_bits) return linear_reason();
    return "the paper's segments are never asked for";
  }

  /// Why lights do not come one after the other.
  [[nodiscard]] std::string linear_reason() const {
    if (!features_.needs.shadows) return "no shadows";
    return linear_ ? "light after light is another way, and costed too" : "one light, and its shares keep --max-color";
  }

  static bool of_units(const ParamInfo& p) {
    return p.member == &Config::face_bits || p.member == &Config::dx_bits || p.member == &Config::seg_bits ||
           p.member == &Config::order_bits || p.member == &Config::classic;
  }

  /// Why as many lanes, or words in a beat: what the half of them would take.
  [[nodiscard]] std::string pace_reason(const ParamInfo& p, const Way& way, const PlanCandidate& taken) const {
    const PlanCost& cost = taken.cost;
    std::string text = fmt::format("worst line {} clocks ({})", cost.worst_line, plan::text_of(scenes_, cost.worst_at));
    if (options_.clock)
      text += fmt::format("; it needs {:.0f} clocks of a display's line, which has {:.0f}", cost.needed_line,
                          line_clocks());
    Config less = taken.config;
    less.*(p.member) /= 2;
    const auto half =
        std::find_if(way.all.begin(), way.all.end(), [&](const PlanCandidate& c) { return c.config == less; });
    if (half == way.all.end()) return text;
    const double more = static_cast<double>(half->cost.clocks) / static_cast<double>(cost.clocks) - 1;
    const double luts = half->cost.luts - cost.luts;
    text += fmt::format("; {} would take {:.0f} % more clocks and {:.0f} LUTs {}", less.*(p.member), 100 * more,
                        std::abs(luts), luts < 0 ? "fewer" : "more");
    if (options_.clock) text += fmt::format(", and need {:.0f}", half->cost.needed_line);
    return text;
  }

  std::span<const PlannedScene> scenes_;
  const PlanOptions& options_;
  Plan out_;
  plan::Features features_;
  plan::UnitDemand units_;
  std::vector<plan::WayDemand> demands_;
  std::optional<std::string> refused_;  // why the first way that was refused was
  bool linear_ = false;                 // light after light is costed
  std::string left_out_;                // how far off light is with a table that was left out
  int of_way_ = 2;                      // passes over the frames that a way takes
  std::vector<Way> ways_;
  int passes_ = 1;   // over all frames: those that are known of
  int steps_ = 0;    // frames that were begun, of all passes
  double told_ = 0;  // share that is done
};

}  // namespace

int usual_total_lines(int height) {
  for (const auto& [shown, all] : {std::pair{480, 525}, {720, 750}, {1080, 1125}, {2160, 2250}})
    if (shown == height) return all;
  return height + (height + 15) / 16;
}

Plan make_plan(std::span<const PlannedScene> scenes, const PlanOptions& options) {
  return Planner(scenes, options).run();
}

std::string to_yaml(const Plan& plan) {
  std::string text;
  for (const PlanReason& r : plan.reasons)
    text += fmt::format("{:<21} # {}\n", fmt::format("{}: {}", r.parameter, r.value), r.text);
  return text;
}

}  // namespace kage
