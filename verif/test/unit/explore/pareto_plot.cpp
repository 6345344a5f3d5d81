// SPDX-License-Identifier: Apache-2.0
// Plots of error against cost: who is on the frontier, where it bends, which values axes name, and that names cover
// nothing.
#include "explore/plot/pareto_plot.hpp"

#include <algorithm>
#include <random>
#include <set>

#include "explore/plot/scale.hpp"
#include "test/support/catch.hpp"

namespace kage::plot {
namespace {

using Index = std::vector<std::size_t>;

ParetoPlot plot_of(const std::vector<std::pair<double, std::optional<double>>>& points, bool more_is_better = false) {
  ParetoPlot plot{.title = "a & <b>",
                  .subtitle = "",
                  .cost = {.title = "cost"},
                  .error = {.title = "error", .none = "0"},
                  .points = {}};
  plot.error.more_is_better = more_is_better;
  for (const auto& [cost, error] : points)
    plot.points.push_back({.row = static_cast<int>(plot.points.size()),
                           .cost = cost,
                           .error = error,
                           .name = "p" + std::to_string(plot.points.size()),
                           .full_name = "<full>"});
  return plot;
}

/// The edges of a text, as far as its estimated width goes.
struct Box {
  double left, top, right, bottom;
};
Box box_of(const Text& t) {
  const double wide = width_of(t.text, t.size, t.bold);
  const double left = t.anchor == Anchor::start    ? t.at.x
                      : t.anchor == Anchor::middle ? t.at.x - wide / 2
                                                   : t.at.x - wide;
  if (t.up) return {t.at.x - t.size * 0.8, t.at.y - wide / 2, t.at.x + t.size * 0.2, t.at.y + wide / 2};
  return {left, t.at.y - t.size * 0.75, left + wide, t.at.y + t.size * 0.2};
}
bool overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

TEST_CASE("the frontier is what no other beats in both") {
  CHECK(frontier(plot_of({{1, 5}, {2, 5}, {2, 3}, {1, 6}, {4, 3}, {5, 1}})) == Index{0, 2, 5});
  CHECK(frontier(plot_of({{3, 1}, {3, 1}})) == Index{0});
  CHECK(frontier(plot_of({{1, 5}, {2, std::nullopt}, {3, 1}})) == Index{0, 1});
  CHECK(frontier(plot_of({{1, 5}, {2, 7}, {3, 6}, {4, std::nullopt}}, true)) == Index{0, 1, 3});
  // By the definition, for many.
  std::mt19937 random(3);
  for (int n = 0; n < 200; ++n) {
    std::vector<std::pair<double, std::optional<double>>> points;
    for (int i = 0; i < 12; ++i) {
      const double error = static_cast<double>(random() % 6);
      points.emplace_back(1 + random() % 6, error == 0 ? std::optional<double>() : error);
    }
    const ParetoPlot plot = plot_of(points);
    std::set<std::pair<double, double>> places;
    for (const std::size_t i : frontier(plot)) places.emplace(points[i].first, points[i].second.value_or(0));
    CHECK(places.size() == frontier(plot).size());
    for (const auto& [cost, error] : points) {
      const bool beaten =
          std::any_of(points.begin(), points.end(), [&, c = cost, e = error.value_or(0)](const auto& o) {
            const double f = o.second.value_or(0);
            return o.first <= c && f <= e && (o.first < c || f < e);
          });
      CHECK(places.count({cost, error.value_or(0)}) == (beaten ? 0 : 1));
    }
  }
}

TEST_CASE("a chain bends where it leaves the straight line") {
  CHECK(bends({}, 1).empty());
  CHECK(bends({{0, 0}}, 1) == Index{0});
  CHECK(bends({{0, 0}, {5, 0.5}, {10, 0}}, 1) == Index{0, 2});
  CHECK(bends({{0, 0}, {5, 3}, {10, 0}}, 1) == Index{0, 2, 1});
  CHECK(bends({{0, 0}, {1, 9}, {2, 9.1}, {10, 10}}, 1) == Index{0, 3, 1});
  // The farthest first, behind the ends.
  CHECK(bends({{0, 0}, {10, 2}, {20, 0}, {30, 8}, {40, 0}}, 1) == Index{0, 4, 3, 2, 1});
}

TEST_CASE("axes name few values, round ones, that lie on them") {
  std::mt19937 random(5);
  for (int n = 0; n < 500; ++n) {
    const bool log = n % 2 == 0;
    const double low = std::pow(10.0, static_cast<double>(random() % 900) / 100 - 4);
    const double high = low * (1 + static_cast<double>(random() % 1000) / (random() % 2 == 0 ? 1 : 500));
    const Scale scale({low, high}, log);
    for (const int most : {4, 8, 10}) {
      const auto labels = scale.labels(most);
      INFO(low << " .. " << high << (log ? " by decades" : ""));
      CHECK(!labels.empty());
      CHECK(labels.size() <= static_cast<std::size_t>(most) + 1);
      for (const double v : labels) {
        CHECK((scale.at(v) >= -1e-9 && scale.at(v) <= 1 + 1e-9));
        CHECK(std::stod(number_text(v)) == Approx(v));
        CHECK(number_text(v).size() <= 9);
      }
    }
    CHECK((scale.at(low) > 0 && scale.at(low) <= scale.at(high) && scale.at(high) < 1));
  }
}

TEST_CASE("names cover neither each other nor the frontier, and all is within the drawing") {
  std::mt19937 random(11);
  for (int n = 0; n < 60; ++n) {
    std::vector<std::pair<double, std::optional<double>>> points;
    const int many = 1 + static_cast<int>(random() % 80);
    for (int i = 0; i < many; ++i) {
      const double x = static_cast<double>(random() % 1000) / 1000;
      const double y = std::pow(10, 4 * (1 - x) * static_cast<double>(random() % 1000) / 1000);
      points.emplace_back(1000 + 20000 * x, random() % 9 == 0 ? std::optional<double>() : y);
    }
    ParetoPlot plot = plot_of(points);
    plot.error.log = true;
    plot.cost.log = n % 3 == 0;
    plot.points[random() % plot.points.size()].base = true;
    for (PlotPoint& p : plot.points) p.name += " as long as a name is";
    for (const PlotFormat& format : {kWidePlot, kNarrowPlot}) {
      const Drawing drawing = draw(plot, format);
      std::vector<Box> names;
      std::vector<int> rows;
      for (const auto& shape : drawing.shapes) {
        if (const auto* text = std::get_if<Text>(&shape)) {
          const Box box = box_of(*text);
          CHECK((box.left >= 0 && box.top >= 0 && box.right <= drawing.width && box.bottom <= drawing.height));
          for (const Box& other : names) CHECK(!overlap(box, other));
          names.push_back(box);
        } else if (const auto* mark = std::get_if<Mark>(&shape); mark != nullptr && mark->row >= 0) {
          rows.push_back(mark->row);
        }
      }
      for (const auto& shape : drawing.shapes)
        if (const auto* mark = std::get_if<Mark>(&shape); mark != nullptr && mark->row >= 0 && mark->ink == Ink::front)
          for (const Box& name : names)
            CHECK(!overlap(name, {mark->at.x - 4, mark->at.y - 4, mark->at.x + 4, mark->at.y + 4}));
      std::sort(rows.begin(), rows.end());
      CHECK(rows.size() == plot.points.size());
      CHECK(std::unique(rows.begin(), rows.end()) == rows.end());
    }
  }
}

TEST_CASE("the same drawing as SVG and as pixels") {
  Drawing drawing{.width = 40, .height = 20, .title = "a & <b>", .description = "\"", .shapes = {}};
  drawing.shapes.emplace_back(Mark{.at = {10, 10}, .radius = 5, .ink = Ink::front, .row = 3, .name = "x < y"});
  drawing.shapes.emplace_back(Mark{.at = {30, 10}, .radius = 5, .ink = Ink::base, .hollow = true});
  const std::string svg = to_svg(drawing);
  CHECK(svg.find("<title>a &amp; &lt;b&gt;</title>") != std::string::npos);
  CHECK(svg.find("data-row=\"3\" data-x=\"10\" data-y=\"10\"") != std::string::npos);
  CHECK(svg.find("<title>x &lt; y</title>") != std::string::npos);
  CHECK(svg.find("prefers-color-scheme:dark") != std::string::npos);
  const Image image = to_image(drawing, 3);
  REQUIRE((image.width == 120 && image.height == 60));
  const auto color = [&](int x, int y) {
    const std::uint8_t* p = &image.data[image.index(3 * x, 3 * y)];
    return std::uint32_t{p[0]} << 16 | std::uint32_t{p[1]} << 8 | p[2];
  };
  CHECK(color(10, 10) == colors_of(Ink::front).light);
  CHECK(color(30, 10) == 0xffffff);
  CHECK(color(25, 10) == colors_of(Ink::base).light);
  CHECK(color(1, 1) == 0xffffff);
}

}  // namespace
}  // namespace kage::plot
