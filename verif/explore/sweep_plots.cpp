// SPDX-License-Identifier: Apache-2.0
// Which plots a sweep has.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "explore/sweep_page.hpp"
#include "explore/sweep_run.hpp"
#include "number/counted.hpp"

namespace kage::explore {
namespace {

using Json = nlohmann::ordered_json;

// A cost whose greatest value is so many times its least has an axis by decades.
constexpr double kManyTimes = 5;

/// A figure of a row along one axis; none: there is no error.
using Figure = std::optional<double> (*)(const Json& row);

struct CostKind {
  std::string_view kind;
  std::string_view tab;
  std::string_view title;
  Figure of;
  bool (*estimated)(const Json& row);
};

struct ErrorKind {
  std::string_view kind;
  std::string_view tab;
  std::string_view words;
  plot::Axis axis;
  Figure of;
};

std::optional<double> ppm_of(const Json& row) {
  const Json& a = row.at("accuracy");
  const double wrong = a.at("visible_wrong").get<double>() + a.at("shadow_wrong").get<double>();
  if (wrong == 0) return {};
  return 1e6 * wrong / a.at("pixels").get<double>();
}

std::optional<double> psnr_db(const Json& row) {
  const Json& psnr = row.at("accuracy").at("psnr");
  return psnr.is_null() ? std::optional<double>() : psnr.get<double>();
}

std::optional<double> flip_of(const Json& row) {
  const double mean = row.at("accuracy").at("flip").get<double>();
  return mean == 0 ? std::optional<double>() : mean;
}

const CostKind kLuts{"luts", "look-up tables", "look-up tables (LUT4 of an ECP5)",
                     [](const Json& row) { return std::optional(row.at("area").at("luts").get<double>()); },
                     [](const Json& row) { return !row.at("area").at("counted").get<bool>(); }};
const CostKind kClocks{
    "clocks", "clocks", "clocks a pixel",
    [](const Json& row) { return std::optional(row.at("speed").at("rtl_cycles_per_pixel").get<double>()); },
    [](const Json& row) { return row.at("speed").at("rtl_cycles_from") != "cosim"; }};
const ErrorKind kWrong{"wrong",
                       "wrong pixels",
                       "wrong pixels",
                       {.title = "wrong pixels in a million (face or shadow)", .log = true, .none = "0"},
                       ppm_of};
const ErrorKind kPsnr{"psnr",
                      "PSNR",
                      "error of colour",
                      {.title = "PSNR of colours, dB (more is better)", .more_is_better = true, .none = "equal"},
                      psnr_db};
const ErrorKind kFlip{"flip",
                      "FLIP",
                      "error of colour as seen",
                      {.title = "FLIP, mean (0: alike, 1: black on white)", .log = true, .none = "0"},
                      flip_of};

/// The base of the sweep, as far as there is one.
bool is_base(const Json& row) {
  return row.at("axis") == "base" && row.at("value").get_ref<const std::string&>().empty();
}

plot::ParetoPlot plot_of(const std::vector<PageRow>& rows, const std::vector<std::size_t>& members,
                         const ErrorKind& error, const CostKind& cost) {
  const Json& first = rows[members.front()].row;
  plot::ParetoPlot out;
  out.title = fmt::format("{}: {} against {}", group_of(first), error.words, cost.tab);
  out.cost.title = cost.title;
  out.error = error.axis;
  std::map<std::pair<double, std::optional<double>>, std::vector<std::size_t>> alike;
  double least = cost.of(first).value_or(0);
  double greatest = least;
  for (const std::size_t i : members) {
    const Json& row = rows[i].row;
    plot::PlotPoint& p = out.points.emplace_back();
    p.row = static_cast<int>(i);
    p.cost = cost.of(row).value_or(0);
    p.error = error.of(row);
    p.estimated = cost.estimated(row);
    p.base = is_base(row);
    p.name = name_of(row);
    p.full_name = fmt::format("{}: {} {:.6g}{}, {} {}", p.name, cost.tab, p.cost, p.estimated ? " (estimated)" : "",
                              error.tab, p.error ? fmt::format("{:.4g}", *p.error) : error.axis.none);
    least = std::min(least, p.cost);
    greatest = std::max(greatest, p.cost);
    alike[{p.cost, p.error}].push_back(out.points.size() - 1);
  }
  // Points at one place have one name: that of the base, or of the first.
  for (const auto& [place, at] : alike) {
    if (at.size() == 1) continue;
    const auto base = std::find_if(at.begin(), at.end(), [&](std::size_t k) { return out.points[k].base; });
    const std::string name =
        fmt::format("{} (+{})", out.points[base != at.end() ? *base : at.front()].name, at.size() - 1);
    for (const std::size_t k : at) out.points[k].name = name;
  }
  out.cost.log = least > 0 && greatest > kManyTimes * least;
  out.subtitle = fmt::format("{}, {}, {}", counted(members.size(), "configuration"),
                             counted(first.at("frames").get<std::size_t>(), "frame"),
                             counted(first.at("accuracy").at("pixels").get<std::size_t>(), "pixel"));
  return out;
}

}  // namespace

std::string name_of(const Json& row) {
  auto axis = row.at("axis").get<std::string>();
  auto value = row.at("value").get<std::string>();
  if (value.empty()) return axis;
  return axis == "grid" ? value : axis + " " + value;
}

std::vector<SweepPlot> plots_of(const std::vector<PageRow>& rows, const std::vector<std::size_t>& members) {
  std::vector<std::pair<const ErrorKind*, const CostKind*>> kinds{
      {&kWrong, &kLuts}, {&kWrong, &kClocks}, {&kPsnr, &kLuts}, {&kPsnr, &kClocks}};
  const bool seen = std::none_of(members.begin(), members.end(),
                                 [&](std::size_t i) { return rows[i].row.at("accuracy").at("flip").is_null(); });
  if (seen) {
    kinds.emplace_back(&kFlip, &kLuts);
    kinds.emplace_back(&kFlip, &kClocks);
  }
  std::vector<SweepPlot> out;
  for (const auto& [error, cost] : kinds)
    out.push_back({fmt::format("{}_{}", error->kind, cost->kind), fmt::format("{}, {}", error->tab, cost->tab),
                   plot_of(rows, members, *error, *cost)});
  return out;
}

}  // namespace kage::explore
