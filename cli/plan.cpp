// SPDX-License-Identifier: Apache-2.0
// kage plan SCENE...: the least configuration of the core that draws scenes, with the reason for each parameter.
#include "kage/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "contract/derived.hpp"
#include "cosim/session/planned.hpp"
#include "cosim/session/remarks.hpp"
#include "cosim/session/source.hpp"
#include "device_clock.hpp"
#include "explore/measured_plan.hpp"
#include "inputs.hpp"
#include "kage/error.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

struct PlanCommand : Options {
  std::vector<std::string> inputs;
  PlanOptions plan;
  std::optional<double> clock;
  std::string device;
  std::optional<double> fps;
  std::optional<int> total_lines;
  bool measured = false;
  std::optional<double> max_z;
  std::optional<double> max_wrong;
};

const std::map<std::string, Prefer>& preferences() {
  static const std::map<std::string, Prefer> kAll{
      {"speed", Prefer::speed}, {"area", Prefer::area}, {"words", Prefer::words}};
  return kAll;
}

std::string name_of(Prefer prefer) {
  for (const auto& [name, value] : preferences())
    if (value == prefer) return name;
  return {};
}

PlannedScene open(const PlanCommand& o, const std::string& input, Progress& progress) {
  refuse_random(input);
  cosim::refuse_order_tree(input);
  refuse_pack(input);
  if (is_stream_file(input)) throw Error(fmt::format("{}: a stream has its configuration already", input));
  return cosim::planned_scene(o, std::make_shared<const Scene>(cosim::load_scene(input, o, terminal())), terminal(),
                              progress);
}

PlanOptions options_of(const PlanCommand& o, Progress& progress) {
  PlanOptions options = o.plan;
  options.front_end = o.level == Level::polygons;
  if (o.max_z) options.limits.z = *o.max_z;
  if (o.max_wrong && !o.measured)
    throw Error("--max-wrong: how many pixels a bit moves is a property of the scene: it needs --guarantee measured");
  if (o.clock || !o.device.empty()) {
    PlanClock clock;
    clock.mhz = o.clock ? *o.clock : device_clock(o.device, options.front_end).mhz;
    clock.fps = o.fps.value_or(clock.fps);
    clock.total_lines = o.total_lines.value_or(0);
    options.clock = clock;
  } else if (o.fps || o.total_lines) {
    throw Error(
        "--fps, --total-lines: of a display that the core keeps up with; --clock MHZ or --device NAME says "
        "how fast the core is");
  }
  options.progress = cosim::plan_progress(terminal(), progress);
  return options;
}

/// The limit of depth: who allows wrong pixels asks for none besides, unless it is given.
double measured_z(const PlanCommand& o, double given) { return o.max_wrong && !o.max_z ? 1.0 : given; }

/// A display's lines hold the picture's, and one at least that is blank.
void check_total_lines(const PlanCommand& o, const std::vector<PlannedScene>& scenes) {
  if (!o.total_lines) return;
  for (const PlannedScene& s : scenes)
    if (*o.total_lines <= s.draw.height)
      throw Error(fmt::format("--total-lines {}: a frame's time holds the picture's {} and a blank one at least",
                              *o.total_lines, counted(s.draw.height, "line")));
}

double per_frame(const Plan& plan, std::uint64_t all) { return static_cast<double>(all) / plan.frames; }
double per_pixel(const Plan& plan, double all) { return all / static_cast<double>(plan.pixels); }

/// Colours of a line that come back wait until the line before has left, so nothing of the way out evens lines out.
bool needs_fifo(const Config& config) { return derived::has_loads(config); }

std::string keeps_up(const Config& config) {
  return needs_fifo(config) ? "keeps up if a FIFO of two lines follows" : "keeps up";
}

/// One line of what a configuration costs.
std::string cost_text(const Plan& plan, const Config& config, const PlanCost& c) {
  std::string text = fmt::format(
      "{:.0f} words a frame, {:.2f} clocks a pixel, worst line {} clocks, {:.0f} LUTs (within {:.0f} %), {:.0f} "
      "flip-flops, {} bits of RAM, {} bits a pixel",
      per_frame(plan, c.words), per_pixel(plan, static_cast<double>(c.clocks)), c.worst_line, c.luts, 100 * c.luts_off,
      c.flip_flops, c.ram_bits, c.bits_per_pixel);
  if (c.meets_clock)
    text += *c.meets_clock ? "; " + keeps_up(config)
                           : fmt::format("; does not keep up: needs {:.0f} clocks a line, the display has {:.0f}",
                                         std::ceil(c.needed_line), std::floor(*plan.display_line));
  return text;
}

std::string shape_text(const Config& c) {
  return c.arrangement == 0 ? fmt::format("systolic, BEAT_WORDS {}", c.beat_words)
                            : fmt::format("LANES {}, BEAT_WORDS {}", c.lanes, c.beat_words);
}

/// A share as per cent: 26, 0.7.
std::string per_cent(double share) { return fmt::format("{:.{}f} %", 100 * share, share < 0.0995 ? 1 : 0); }

/// Why another than the one with the fewest clocks or look-up tables was taken; nothing if it is that one.
std::string least_text(const Plan& plan, Prefer prefer) {
  if (!plan.least) return {};
  const PlanCost& least = plan.least->cost;
  const double luts = plan.cost.luts - least.luts;
  const auto change = [](std::uint64_t now, std::uint64_t then) {
    return static_cast<double>(now) / static_cast<double>(then) - 1;
  };
  const double clocks = change(plan.cost.clocks, least.clocks);
  const std::string than = fmt::format("{} ({})", plan.least->way, shape_text(plan.least->config));
  const std::string luts_text = fmt::format("{:.{}f} LUTs", std::abs(luts), std::abs(luts) < 9.5 ? 1 : 0);
  if (prefer == Prefer::speed)
    return fmt::format("# clocks within {:.0f} % of the fewest count as equal: {} more than {} save {}\n",
                       100 * kAsGood, per_cent(clocks), than, luts_text);
  return fmt::format("# LUTs within {:.0f} % of the fewest count as equal: {} more than {} buy {} fewer {}\n",
                     100 * kAsGood, luts_text, than,
                     per_cent(clocks < 0 ? -clocks : -change(plan.cost.words, least.words)),
                     clocks < 0 ? "clocks" : "words");
}

/// The cost of speed beside the clocks it saves, against the smallest configuration; empty if that one was taken.
std::string speed_text(const Plan& plan) {
  const PlanCost& c = plan.cost;
  const PlanCost& least = plan.smallest.cost;
  if (plan.smallest.config == plan.config) return {};
  const auto of = [](auto a, auto b) { return static_cast<double>(a) - static_cast<double>(b); };
  return fmt::format(
      "# the smallest, {} ({}): {}\n"
      "# speed against the smallest: {} fewer clocks ({:.2f} a pixel, not {:.2f}) for {:+.0f} LUTs, "
      "{:+.0f} flip-flops, {:+.0f} bits of RAM, {:+.0f} bits a pixel\n",
      plan.smallest.way, shape_text(plan.smallest.config), cost_text(plan, plan.smallest.config, least),
      per_cent(of(least.clocks, c.clocks) / static_cast<double>(least.clocks)),
      per_pixel(plan, static_cast<double>(c.clocks)), per_pixel(plan, static_cast<double>(least.clocks)),
      c.luts - least.luts, c.flip_flops - least.flip_flops, of(c.ram_bits, least.ram_bits),
      of(c.bits_per_pixel, least.bits_per_pixel));
}

/// The error of the plan's pictures, as its inequalities bound it or as it was measured.
std::string error_text(const Plan& plan, const PlanOptions& options, const explore::MeasuredPlan* measured) {
  if (measured == nullptr)
    return fmt::format("# depth within {:.3g} of its range, colour at most {}/255 from exact arithmetic{}\n",
                       plan.z_error, plan.limits.color,
                       plan.limits.color > options.limits.color ? " (no core is bound to keep less here)" : "");
  const explore::MeasuredPlan::Lowered& l = *measured->lowered(plan.config);
  std::string text = fmt::format("# measured in these frames: {}; allowed: {}\n", measured->text(l.taken_gives),
                                 measured->limits_text());
  if (!(l.least == l.taken))
    text += fmt::format("# measured before the next steps were taken, with {}: {}\n",
                        explore::MeasuredPlan::widths_text(l.least), measured->text(l.least_gives));
  return text;
}

/// The notes that kage render has on the scenes, a line each: ignored and added parts, and visible effects of the
/// plan's depth.
std::vector<std::string> notes_of(const PlanCommand& o, const Plan& plan, const std::vector<PlannedScene>& scenes) {
  std::vector<std::string> lines;
  for (const PlannedScene& s : scenes) {
    const int frames = s.draw.frames > 0 ? s.draw.frames : s.scene->frame_count();
    cosim::FrameRemarks remarks(plan.config, o.size, o.cull);
    std::vector<std::string> notes = cosim::scene_notes(*s.scene, s.scene->frame(0, frames), o);
    for (int i = 0; i < frames; ++i) {
      check_interrupt();
      remarks.add(*s.scene, s.scene->frame(i, frames));
    }
    for (std::string& note : remarks.notes()) notes.push_back(std::move(note));
    for (const std::string& note : notes)
      lines.push_back(fmt::format("{}: {}", cosim::plain_name(s.scene->name()), note));
  }
  return lines;
}

std::string text_of(const PlanCommand& o, const Plan& plan, const PlanOptions& options,
                    const std::vector<std::string>& notes, const explore::MeasuredPlan* measured) {
  std::string text = fmt::format("# kage plan {}: {} of up to {}x{}, --prefer {}\n",
                                 shown(fmt::format("{}", fmt::join(o.inputs, " "))), counted(plan.frames, "frame"),
                                 plan.size[0], plan.size[1], name_of(o.plan.prefer));
  for (const std::string& note : notes) text += fmt::format("# {}\n", shown(note));
  text += error_text(plan, options, measured);
  if (options.clock)
    text += fmt::format(
        "# a display of {:g} frames a second and {} each, blanking included, at {:g} MHz: {}\n", options.clock->fps,
        counted(options.clock->total_lines > 0 ? options.clock->total_lines : usual_total_lines(plan.size[1]), "line"),
        options.clock->mhz,
        *plan.cost.meets_clock ? "the core " + keeps_up(plan.config) : "no core keeps up, this one comes nearest");
  if (!o.device.empty())
    text += fmt::format(
        "# {:g} MHz is what the slowest core placed on {} reached, {}; others are faster (docs/timing.md)\n",
        options.clock->mhz, o.device, device_clock(o.device, options.front_end).core);
  text += fmt::format("# costs {}\n", cost_text(plan, plan.config, plan.cost));
  if (plan.polygon_words > 0) {
    text +=
        "# words are those with spans from the host; clocks are those behind the front end, cells and RAM with it\n";
    text += plan.polygon_words < plan.cost.words
                ? fmt::format("# at the polygon level the frames take {:.1f} times fewer words, {}\n",
                              static_cast<double>(plan.cost.words) / static_cast<double>(plan.polygon_words),
                              counted(plan.polygon_words, "word"))
                : fmt::format("# at the polygon level the frames take no fewer words: {}, not {}\n",
                              counted(plan.polygon_words, "word"), plan.cost.words);
  }
  text += least_text(plan, o.plan.prefer);
  for (const PlanCandidate& c : plan.others)
    text += fmt::format("# instead, {} ({}): {}\n", c.way, shape_text(c.config), cost_text(plan, c.config, c.cost));
  if (o.plan.prefer == Prefer::speed) text += speed_text(plan);
  return wrapped_comments(text + to_yaml(plan));
}

Json place_json(const PlanPlace& at) {
  if (at.scene < 0) return nullptr;
  return {{"scene", at.scene}, {"frame", at.frame}, {"line", at.line >= 0 ? Json(at.line) : Json(nullptr)}};
}

Json cost_json(const Plan& plan, const Config& config, const PlanCost& c) {
  Json j;
  j["words_per_frame"] = per_frame(plan, c.words);
  j["clocks_per_pixel"] = per_pixel(plan, static_cast<double>(c.clocks));
  j["worst_line_cycles"] = c.worst_line;
  j["worst_line_at"] = place_json(c.worst_at);
  j["needed_line_cycles"] = c.needed_line;
  j["needed_at"] = place_json(c.needed_at);
  j["needed_lines"] = c.needed_lines;
  j["luts"] = c.luts;
  j["luts_off"] = c.luts_off;
  j["flip_flops"] = c.flip_flops;
  j["ram_bits"] = c.ram_bits;
  j["bits_per_pixel"] = c.bits_per_pixel;
  j["golden_ns_per_pixel"] = per_pixel(plan, c.golden_seconds * 1e9);
  j["meets_clock"] = c.meets_clock ? Json(*c.meets_clock) : Json(nullptr);
  j["needs_fifo"] = needs_fifo(config);
  return j;
}

Json candidate_json(const Plan& plan, const PlanCandidate& c) {
  return {{"way", c.way}, {"config", cli::to_json(c.config)}, {"cost", cost_json(plan, c.config, c.cost)}};
}

Json errors_json(const explore::MeasuredErrors& e) {
  return {{"wrong_ppm", e.pictures.wrong_ppm()},
          {"z_error", e.pictures.z_max},
          {"color_steps", e.pictures.color_max},
          {"light_rms", e.light.pixels > 0 ? Json(e.light.rms()) : Json(nullptr)}};
}

/// Measured errors of pictures with the plan's widths, and with the widths before they were rounded up to steps.
Json measured_json(const Plan& plan, const explore::MeasuredPlan* measured) {
  if (measured == nullptr) return nullptr;
  const explore::MeasuredPlan::Lowered& l = *measured->lowered(plan.config);
  Json j = errors_json(l.taken_gives);
  j["before_steps"] = errors_json(l.least_gives);
  j["before_steps"]["config"] = cli::to_json(l.least);
  return j;
}

Json json_of(const PlanCommand& o, const Plan& plan, const std::vector<std::string>& notes,
             const explore::MeasuredPlan* measured) {
  Json j;
  j["scenes"] = o.inputs;
  j["notes"] = notes;
  j["frames"] = plan.frames;
  j["width"] = plan.size[0];
  j["height"] = plan.size[1];
  j["prefer"] = name_of(o.plan.prefer);
  j["guarantee"] = o.measured ? "measured" : "bound";
  j["limits"] = {{"max_z", measured_z(o, plan.limits.z)},
                 {"max_color", plan.limits.color},
                 {"max_wrong", o.max_wrong ? Json(*o.max_wrong) : Json(nullptr)}};
  j["z_error_bound"] = plan.z_error;
  j["polygon_words"] = plan.polygon_words > 0 ? Json(plan.polygon_words) : Json(nullptr);
  j["measured"] = measured_json(plan, measured);
  j["config"] = cli::to_json(plan.config);
  Json reasons = Json::object();
  for (const PlanReason& r : plan.reasons) reasons[std::string(r.parameter)] = r.text;
  j["reasons"] = reasons;
  j["worst_line_cycles"] = plan.cost.worst_line;
  j["meets_clock"] = plan.cost.meets_clock ? Json(*plan.cost.meets_clock) : Json(nullptr);
  j["display_line_cycles"] = plan.display_line ? Json(*plan.display_line) : Json(nullptr);
  j["cost"] = cost_json(plan, plan.config, plan.cost);
  j["others"] = Json::array();
  for (const PlanCandidate& c : plan.others) j["others"].push_back(candidate_json(plan, c));
  j["smallest"] = candidate_json(plan, plan.smallest);
  j["least"] = plan.least ? candidate_json(plan, *plan.least) : Json(nullptr);
  return j;
}

int run(const PlanCommand& o) {
  reads_files(o.inputs);
  check_json(o, o.json);
  Progress progress;
  std::vector<PlannedScene> scenes;
  refuse_repeated(o.inputs);
  PlanOptions options = options_of(o, progress);
  for (const std::string& input : o.inputs) scenes.push_back(open(o, input, progress));
  check_total_lines(o, scenes);
  std::optional<explore::MeasuredPlan> measured;
  if (o.measured) {
    int drawn = 0;
    const explore::MeasuredLimits limits{o.max_wrong, measured_z(o, options.limits.z), options.limits.color};
    measured.emplace(scenes, limits, [&progress, drawn]() mutable {
      check_interrupt();
      progress.show(fmt::format("plan: {} drawn", counted(++drawn, "frame")));
    });
    options.lower = [&measured](Config& widths, std::vector<PlanReason>& reasons) {
      return measured->lower(widths, reasons);
    };
  }
  const Plan plan = make_plan(scenes, options);
  progress.clear();
  TempFiles files;
  const std::vector<std::string> notes = notes_of(o, plan, scenes);
  const explore::MeasuredPlan* pictures = measured ? &*measured : nullptr;
  finish(o.json, {"kage.plan/1", json_of(o, plan, notes, pictures)}, files, text_of(o, plan, options, notes, pictures));
  if (json_only(o.json))
    for (const std::string& note : notes) fmt::print(stderr, "{}\n", shown(note));
  return kSame;
}

}  // namespace

void add_plan(Program& program, Action& action) {
  Command c = program.add("plan", "Find the least configuration of the core that draws scenes",
                          "  kage plan courtyard > mine.yaml && kage cosim courtyard --config mine.yaml\n"
                          "  kage plan bunny.obj --prefer words --json -\n"
                          "  kage plan courtyard glass --device ecp5-25f --fps 60\n"
                          "  kage plan penumbra --samples 64 --max-z 1e-4 --max-color 2\n"
                          "  kage plan courtyard --guarantee measured --max-wrong 20\n"
                          "  kage plan courtyard --front-end rtl\n"
                          "Each parameter comes with its reason; docs/plan.md has the inequalities.");
  const auto o = std::make_shared<PlanCommand>();
  option_scenes(c, o->inputs);
  c.add_option("--max-z", o->max_z,
               "how far a stored depth may be off, as a share of the depth range; default one step of 24 bits")
      .check(real_number(1e-9, 1))
      .type_name("SHARE");
  c.add_option_function<int>(
       "--max-color",
       [limits = &o->plan.limits](const int& steps) {
         limits->color = steps;
         limits->color_given = true;
       },
       "how many steps of 255 a colour may be off: by rounding at most, and root mean square by light that faces or "
       "shadows share; default 1, or the least that any core is bound to keep")
      .check(whole_number(1, 255))
      .type_name("STEPS");
  c.add_option(
       "--max-wrong", o->max_wrong,
       "with --guarantee measured: how many pixels in a million may show another face or shadow than the oracle, "
       "near ties too; then depth is limited by --max-z only where that is given")
      .check(real_number(0, 1e6))
      .type_name("PPM");
  c.add_option_function<std::string>(
       "--guarantee", [o](const std::string& name) { o->measured = name == "measured"; },
       "bound: each width follows from an inequality, whatever the scene; measured: each width was lowered until the "
       "pictures of these frames were over a limit; default bound")
      .option_text("bound|measured")
      .check(one_of({"bound", "measured"}))
      .type_name("HOW");
  c.add_option_function<std::string>(
       "--prefer", [plan = &o->plan](const std::string& name) { plan->prefer = preferences().at(name); },
       fmt::format(
           "which of several that serve: speed has the fewest clocks, and of those within {0:.0f} % of them the fewest "
           "look-up tables; area has the fewest look-up tables, and of those within {0:.0f} % of them the fewest "
           "clocks; "
           "words has the shortest stream; default area",
           100 * kAsGood))
      .option_text("speed|area|words")
      .check(one_of({"speed", "area", "words"}))
      .type_name("WHAT");
  const Option clock = c.add_option("--clock", o->clock, "the core's clock in MHz, to keep up with a display")
                           .check(real_number(0.001, 10000))
                           .type_name("MHZ");
  c.add_option("--device", o->device,
               "the same: the clock of the slowest core that was placed on a device of constraints/figures.json")
      .excludes(clock)
      .type_name("NAME");
  c.add_option("--fps", o->fps, "frames a second of the display, default 60")
      .check(real_number(0.001, 100000))
      .type_name("F");
  c.add_option("--total-lines", o->total_lines,
               "lines in a frame's time of the display, blanking included; default 525 for 480, 750 for 720, 1125 for "
               "1080, 2250 for 2160, else a sixteenth more than the picture's; at least one more than the picture's")
      .check(whole_number(1, 100000))
      .type_name("N");
  option_front_end(c, *o);
  c.option("--front-end")
      .description(
          "who makes spans of polygons, default host: with rtl the core gets a front end, and ACTIVE is the most "
          "polygons that a line has, as far as a front end keeps so many (docs/plan.md)");
  options_of_pictures(c, *o);
  option_json(c, o->json);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
