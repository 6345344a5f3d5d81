// SPDX-License-Identifier: Apache-2.0
// kage order MESH: polygons back to front, the fast way against recursion.
#include "kage/order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <numeric>
#include <optional>

#include "command.hpp"
#include "cosim/report/html.hpp"
#include "cosim/session/order_build.hpp"
#include "cosim/session/source.hpp"
#include "geometry/order_mesh.hpp"
#include "inputs.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "order/baseline.hpp"
#include "order/measure.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

struct OrderCommand : Options {
  int eyes = 200;
  int repeats = 5;
  std::string save;
  std::string plot;
};

OrderTree make_tree(const OrderCommand& o, Progress& progress, double& seconds) {
  if (is_order_file(o.input)) return OrderTree::load(o.input);
  progress.show("reading");
  const Scene scene = cosim::load_scene(o.input, o, terminal(), 1);
  const OrderMesh mesh = order_mesh(scene.frame(0, scene.frame_count()));
  OrderBuildOptions options = cosim::order_build(o, terminal(), progress, o.input + ": visibility order");
  options.seed = o.seed;
  const auto start = std::chrono::steady_clock::now();
  try {
    OrderTree tree = OrderTree::build(mesh, options);
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return tree;
  } catch (const TooManyFragments& e) {
    cosim::refuse_fragments(o.input, e);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: {}", o.input, e.what()));
  }
}

std::string name_of(double degrees) {
  return degrees == order::MeasureOptions::kRandom ? "random" : fmt::format("{:g}", degrees);
}

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

Json number(double x) { return x > 0 ? Json(x) : Json(nullptr); }

Json to_json(const OrderTree& tree, const order::Measured& m, const OrderCommand& o, double build_seconds) {
  const OrderBuildStats& s = tree.stats();
  Json rows = Json::array();
  for (const order::MeasureRow& r : m.rows) {
    Json j;
    j["polygons"] = s.polygons;
    j["nodes"] = s.nodes;
    if (r.degrees == order::MeasureOptions::kRandom)
      j["step_degrees"] = "random";
    else
      j["step_degrees"] = r.degrees;
    j["eyes"] = o.eyes;
    j["recursion_seconds"] = r.baseline_a.order;
    j["switching_seconds"] = r.fast.order;
    j["speedup"] = number(ratio(r.baseline_a.order, r.fast.order));
    j["flips_share"] = r.flips_share;
    j["bsp_bytes"] = m.baseline_a_bytes;
    j["list_bytes"] = m.fast_bytes;
    j["identical"] = r.identical;
    j["steps"] = r.steps;
    j["recursion_walk_seconds"] = r.baseline_a.walk;
    j["switching_walk_seconds"] = r.fast.walk;
    j["preorder_seconds"] = r.baseline_b.order;
    j["preorder_walk_seconds"] = r.baseline_b.walk;
    j["paper_list_seconds"] = r.list.order;
    j["paper_list_walk_seconds"] = r.list.walk;
    j["preorder_speedup"] = number(ratio(r.baseline_b.order, r.fast.order));
    j["tested_share"] = r.tested_share;
    j["rebuilds"] = r.rebuilds;
    j["exchanges"] = r.exchanges;
    j["unsure_tests"] = r.unsure;
    j["exact_tests"] = r.exact;
    j["faces"] = s.faces;
    j["fragments"] = s.fragments;
    j["splits"] = s.splits;
    j["depth"] = s.depth;
    j["build_seconds"] = number(build_seconds);
    j["paper_list_bytes"] = m.list_bytes;
    j["seed"] = o.seed;
    rows.push_back(j);
  }
  return rows;
}

std::string text_of(const OrderTree& tree, const order::Measured& m, const OrderCommand& o, double build_seconds) {
  std::string text;
  const auto line = [&text]<class... Values>(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
  };
  const OrderBuildStats& s = tree.stats();
  const auto per_face = [&](std::uint64_t n) { return ratio(static_cast<double>(n), static_cast<double>(s.faces)); };
  const auto per_node = [&](std::uint64_t n) { return ratio(static_cast<double>(n), static_cast<double>(s.nodes)); };
  line("{}: {}, {} ({:.2f} per face), {} ({:.2f} per face), {}, depth {}\n", shown(o.input), counted(s.faces, "face"),
       counted(s.nodes, "node"), per_face(s.nodes), counted(s.fragments, "fragment"), per_face(s.fragments),
       counted(s.splits, "split"), s.depth);
  if (s.flat != 0) line("{} without area left out\n", counted(s.flat, "polygon"));
  if (s.bent != 0) line("{} not plane, cut into triangles\n", counted(s.bent, "polygon"));
  if (build_seconds > 0)
    line("built in {:.2f} s: {} of vertices, {} decided by integers; seed {}\n", build_seconds,
         counted(s.side_tests, "side test"), s.exact_tests, o.seed);
  if (m.rows.empty()) return text;
  line("ways to the order, with their bytes per node, tree included:\n");
  const auto way = [&](const char* name, std::uint64_t bytes, const std::string& what) {
    line("  {:<12} {:>6.1f}  {}\n", name, per_node(bytes), what);
  };
  way("A recursion", m.baseline_a_bytes, fmt::format("over {}, each from the heap", order::BaselineA::kNodeText));
  way("B preorder", m.baseline_b_bytes,
      "recursion over packed nodes, with a stack of its own: what the fast way is to be held against");
  way("paper's list", m.list_bytes, "[Tanaka 2005]: a linked list, relinked where the eye has changed sides");
  way("fast way", m.fast_bytes, "kage::order's: an array, moved or made again where the eye has changed sides");
  line(
      "microseconds for an eye step of so many degrees: order alone | with a walk over it; {} steps, processor time, "
      "least of {}\n",
      m.rows[0].steps, o.repeats);
  line("flips: nodes whose side the eye changed; tested: nodes whose side the fast way looked at\n");
  line("{:>7} {:>8} {:>8} {:>17} {:>17} {:>17} {:>17} {:>13} {:>13} {:>9}\n", "degrees", "flips %", "tested %",
       "A recursion", "B preorder", "paper's list", "fast way", "A / fast", "B / fast", "identical");
  for (const order::MeasureRow& r : m.rows) {
    const auto pair = [&](const order::WaySeconds& w) {
      return fmt::format("{:.1f} | {:.1f}", w.order / r.steps * 1e6, w.walk / r.steps * 1e6);
    };
    const auto times = [&](const order::WaySeconds& w) {
      return fmt::format("{:.1f} | {:.1f}", ratio(w.order, r.fast.order), ratio(w.walk, r.fast.walk));
    };
    line("{:>7} {:>8.3f} {:>8.1f} {:>17} {:>17} {:>17} {:>17} {:>13} {:>13} {:>9}\n", name_of(r.degrees),
         100 * r.flips_share, 100 * r.tested_share, pair(r.baseline_a), pair(r.baseline_b), pair(r.list), pair(r.fast),
         times(r.baseline_a), times(r.baseline_b), r.identical ? "yes" : "NO");
  }
  return text;
}

/// Where labels stand that are to be at these heights: in the same order, and at least `gap` apart.
std::vector<double> spread(const std::vector<double>& wanted, double gap) {
  std::vector<std::size_t> from_top(wanted.size());
  std::iota(from_top.begin(), from_top.end(), std::size_t{0});
  std::sort(from_top.begin(), from_top.end(), [&](auto a, auto b) { return wanted[a] < wanted[b]; });
  std::vector<double> at = wanted;
  for (std::size_t i = 1; i < from_top.size(); ++i)
    at[from_top[i]] = std::max(at[from_top[i]], at[from_top[i - 1]] + gap);
  return at;
}

/// A curve of the plot: its seconds a step.
struct PlotLine {
  const char* name;
  const char* color;
  double (*seconds)(const order::MeasureRow&);
};
constexpr std::array<PlotLine, 4> kPlotLines{{
    {"A, recursion", "#b33", [](const order::MeasureRow& r) { return r.baseline_a.order / r.steps; }},
    {"B, preorder", "#c80", [](const order::MeasureRow& r) { return r.baseline_b.order / r.steps; }},
    {"paper's list", "#38c", [](const order::MeasureRow& r) { return r.list.order / r.steps; }},
    {"fast way", "#283", [](const order::MeasureRow& r) { return r.fast.order / r.steps; }},
}};

/// Time a step against the step angle, both logarithmic.
std::string plot(const order::Measured& m, const OrderTree& tree, const std::string& name) {
  std::vector<const order::MeasureRow*> rows;
  for (const order::MeasureRow& r : m.rows)
    if (r.degrees > 0) rows.push_back(&r);
  constexpr double kLeft = 80;
  constexpr double kTop = 50;
  constexpr double kWidth = 480;
  constexpr double kHeight = 300;
  constexpr double kLabelGap = 15;  // letters are 13 high
  double low = 1e300;
  double high = -1e300;
  for (const auto* r : rows)
    for (const PlotLine& l : kPlotLines) {
      low = std::min(low, std::log10(l.seconds(*r)));
      high = std::max(high, std::log10(l.seconds(*r)));
    }
  low = std::floor(low);
  high = std::max(std::ceil(high), low + 1);
  const double first = std::log10(rows.front()->degrees);
  const double last = std::log10(rows.back()->degrees);
  const auto x = [&](double degrees) { return kLeft + kWidth * (std::log10(degrees) - first) / (last - first); };
  const auto y = [&](double log) { return kTop + kHeight * (high - log) / (high - low); };
  const std::string title = report::escaped(std::filesystem::path(name).filename().string());
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 410\" font-family=\"DejaVu Sans, Helvetica, Arial, "
      "sans-serif\" font-size=\"13\">\n  <title>Time of a step against its angle</title>\n"
      "  <rect width=\"720\" height=\"410\" fill=\"#fff\"/>\n  <text x=\"{}\" y=\"28\">{}, {} nodes: time a "
      "step</text>\n",
      kLeft, title, tree.node_count());
  for (double log = low; log <= high; ++log)
    svg += fmt::format(
        "  <path d=\"M{} {:.1f} h{}\" stroke=\"#ddd\"/>\n  <text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:g} "
        "us</text>\n",
        kLeft, y(log), kWidth, kLeft - 8, y(log) + 4, std::pow(10, log + 6));
  for (const auto* r : rows)
    svg += fmt::format("  <text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:g}°</text>\n", x(r->degrees),
                       kTop + kHeight + 22, r->degrees);
  std::vector<double> ends;
  for (const PlotLine& l : kPlotLines) ends.push_back(y(std::log10(l.seconds(*rows.back()))) + 4);
  const std::vector<double> labels = spread(ends, kLabelGap);
  for (std::size_t i = 0; i < kPlotLines.size(); ++i) {
    const PlotLine& l = kPlotLines[i];
    std::string path;
    for (const auto* r : rows)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x(r->degrees), y(std::log10(l.seconds(*r))));
    svg += fmt::format("  <path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", path, l.color);
    svg += fmt::format("  <text x=\"{}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n", kLeft + kWidth + 10, labels[i], l.color,
                       l.name);
  }
  return svg + "</svg>\n";
}

int run(const OrderCommand& o) {
  check_json(o, o.json);
  refuse_random(o.input);
  TempFiles files;
  std::optional<OutputFile> saved;
  if (!o.save.empty()) saved.emplace(files, o.save);
  check_output(o.plot);
  check_output(o.save);
  Progress progress;
  double build_seconds = 0;
  const OrderTree tree = make_tree(o, progress, build_seconds);
  if (tree.node_count() == 0) throw Error(fmt::format("{}: no polygon has an area", o.input));
  if (saved) {
    tree.save(*saved);
    saved->close();
  }

  order::MeasureOptions options;
  options.seed = o.seed;
  options.eyes = o.eyes;
  options.repeats = o.repeats;
  options.progress = [&](double degrees) {
    check_interrupt();
    progress.show(fmt::format("measuring: {}", degrees < 0 ? "random eyes" : name_of(degrees) + " degrees"));
  };
  const order::Measured measured = order::measure(tree, options);
  progress.clear();
  if (!o.plot.empty()) write_text(files, o.plot, plot(measured, tree, o.input));
  finish(o.json, {"kage.order/1", to_json(tree, measured, o, build_seconds)}, files,
         text_of(tree, measured, o, build_seconds));
  for (const order::MeasureRow& r : measured.rows)
    if (!r.identical) return kDifferent;
  return kSame;
}

}  // namespace

void add_order(Program& program, Action& action) {
  Command c = program.add(
      "order", "Put a mesh's polygons in order, back to front, from many eyes, and measure each way to do it",
      "  kage order horse.3ds\n"
      "  kage order horse.3ds --save horse.bsp --plot horse.svg --json horse.json\n"
      "  kage order horse.bsp --eyes 1000 --seed 7\n"
      "Exit code 0: all ways gave the same order after every step; 1: they did not.");
  const auto o = std::make_shared<OrderCommand>();
  c.add_option("MESH", o->input, "a mesh or scene, as for render, or a tree that --save wrote").required();
  c.add_option("--eyes", o->eyes, "eyes for each step angle, default 200")
      .check(whole_number(2, 1000000))
      .type_name("N");
  c.add_option("--repeats", o->repeats, "times are the least of N runs, default 5")
      .check(whole_number(1, 1000))
      .type_name("N");
  option_max_fragments(c, *o);
  c.add_option("--save", o->save, "write the tree").type_name("FILE");
  c.add_option("--plot", o->plot, "write a plot of time against step angle, SVG").type_name("FILE");
  option_seed(c, o->seed);
  option_threads(c, *o);
  option_outside(c, *o);
  option_json(c, o->json);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
