// SPDX-License-Identifier: Apache-2.0
#include "explore/plot/pareto_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>

#include "explore/plot/scale.hpp"

namespace kage::plot {
namespace {

/// A rectangle, its edges.
struct Box {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

Box round_about(const Place& p, double radius) { return {p.x - radius, p.y - radius, p.x + radius, p.y + radius}; }

/// Whether a level or upright stretch of a line passes through.
bool crosses(const Box& box, const Place& a, const Place& b) {
  return overlap(box, {std::min(a.x, b.x) - 1, std::min(a.y, b.y) - 1, std::max(a.x, b.x) + 1, std::max(a.y, b.y) + 1});
}

double from_line(const Place& p, const Place& a, const Place& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double length = std::hypot(dx, dy);
  if (length == 0) return std::hypot(p.x - a.x, p.y - a.y);
  return std::abs(dx * (p.y - a.y) - dy * (p.x - a.x)) / length;
}

/// Draws one plot.
class Plotter {
 public:
  Plotter(const ParetoPlot& plot, const PlotFormat& format)
      : plot_(plot), format_(format), narrow_(format.width < 500) {}

  Drawing draw() {
    out_.width = format_.width;
    out_.height = format_.height;
    out_.title = plot_.title;
    front_ = frontier(plot_);
    head();
    area();
    scales();
    const auto line = step_line();
    out_.shapes.emplace_back(Line{line, Ink::front, 2});
    marks();
    names(line);
    describe();
    return std::move(out_);
  }

 private:
  void text(Place at, const std::string& letters, double size, Ink ink, Anchor anchor, bool bold = false) {
    out_.shapes.emplace_back(Text{.at = at, .text = letters, .size = size, .ink = ink, .anchor = anchor, .bold = bold});
  }

  /// Words, broken where they are wider than the plot.
  void paragraph(const std::string& words, double size, Ink ink, bool bold) {
    const double room = format_.width - 2 * kEdge;
    std::string line;
    for (std::size_t at = 0; at < words.size();) {
      const std::size_t space = std::min(words.find(' ', at), words.size());
      const std::string word = words.substr(at, space - at);
      const std::string longer = line.empty() ? word : fmt::format("{} {}", line, word);
      if (!line.empty() && width_of(longer, size, bold) > room) {
        put_line(line, size, ink, bold);
        line = word;
      } else {
        line = longer;
      }
      at = space + 1;
    }
    put_line(line, size, ink, bold);
  }

  void put_line(const std::string& line, double size, Ink ink, bool bold) {
    top_ += size * 1.35;
    text({kEdge, top_}, line, size, ink, Anchor::start, bold);
  }

  void head() {
    top_ = kEdge / 2;
    paragraph(plot_.title, format_.text + 2, Ink::text, true);
    if (!plot_.subtitle.empty()) paragraph(plot_.subtitle, format_.text - 1, Ink::soft, false);
    legend();
  }

  struct Key {
    std::string text;
    Mark mark;
    bool line = false;
  };

  void legend() {
    const auto any = [&](auto test) { return std::any_of(plot_.points.begin(), plot_.points.end(), test); };
    const bool hollow = any([](const PlotPoint& p) { return p.estimated; });
    const bool filled = any([](const PlotPoint& p) { return !p.estimated; });
    std::vector<Key> keys{{"no other beats it", {.ink = Ink::front, .hollow = !filled}, true}};
    if (front_.size() < plot_.points.size()) keys.push_back({"others", {.ink = Ink::other, .hollow = !filled}});
    if (any([](const PlotPoint& p) { return p.base; }))
      keys.push_back({"base", {.radius = kBaseMark, .ink = Ink::base, .hollow = !filled, .diamond = true}});
    if (hollow)
      keys.push_back({filled ? "hollow: estimated" : "hollow: all are estimated", {.ink = Ink::soft, .hollow = true}});
    const double size = format_.text - 1;
    double x = kEdge;
    top_ += size * 1.6;
    for (Key& key : keys) {
      const double sign = key.line ? 34 : 16;
      const double wide = sign + width_of(key.text, size, false) + 18;
      if (x > kEdge && x + wide - 18 > format_.width - kEdge) {
        x = kEdge;
        top_ += size * 1.5;
      }
      const double y = top_ - size * 0.36;
      if (key.line) out_.shapes.emplace_back(Line{{{x, y}, {x + 26, y}}, Ink::front, 2});
      key.mark.at = {x + (key.line ? 13 : 5), y};
      out_.shapes.emplace_back(key.mark);
      text({x + sign, top_}, key.text, size, Ink::text, Anchor::start);
      x += wide;
    }
  }

  /// Where the points come: between what is written at the edges.
  void area() {
    std::vector<double> costs;
    std::vector<double> errors;
    for (const PlotPoint& p : plot_.points) {
      costs.push_back(p.cost);
      if (p.error) errors.push_back(*p.error);
    }
    const bool strip = errors.size() < plot_.points.size();
    cost_ = std::make_unique<Scale>(costs, plot_.cost.log);
    if (!errors.empty()) error_ = std::make_unique<Scale>(errors, plot_.error.log);
    const double size = format_.text - 1;
    const int rows = narrow_ ? 6 : 8;
    if (error_) error_labels_ = error_->labels(rows);
    double wide = strip ? width_of(plot_.error.none, size, false) : 0;
    for (const double v : error_labels_) wide = std::max(wide, width_of(number_text(v), size, false));
    area_ = {kEdge + size * 1.6 + wide + 8, top_ + size * 1.2, format_.width - kEdge - 4,
             format_.height - kEdge - size * 3.2};
    // Points without an error stand apart, at the better end.
    const double tall = strip ? (error_ ? size * 2.2 : area_.bottom - area_.top) : 0;
    strip_ = plot_.error.more_is_better ? Box{area_.left, area_.top, area_.right, area_.top + tall}
                                        : Box{area_.left, area_.bottom - tall, area_.right, area_.bottom};
    main_ = plot_.error.more_is_better ? Box{area_.left, area_.top + tall, area_.right, area_.bottom}
                                       : Box{area_.left, area_.top, area_.right, area_.bottom - tall};
  }

  [[nodiscard]] double x_of(double cost) const { return area_.left + cost_->at(cost) * (area_.right - area_.left); }

  [[nodiscard]] double y_of(const std::optional<double>& error) const {
    if (!error) return (strip_.top + strip_.bottom) / 2;
    return main_.bottom - error_->at(*error) * (main_.bottom - main_.top);
  }

  [[nodiscard]] Place place_of(const PlotPoint& p) const { return {x_of(p.cost), y_of(p.error)}; }

  void scales() {
    const double size = format_.text - 1;
    const int columns = narrow_ ? 4 : 10;
    for (const double v : cost_->lines(columns))
      out_.shapes.emplace_back(Line{{{x_of(v), area_.top}, {x_of(v), area_.bottom}}, Ink::grid});
    if (error_)
      for (const double v : error_->lines(static_cast<int>(error_labels_.size())))
        out_.shapes.emplace_back(Line{{{area_.left, y_of(v)}, {area_.right, y_of(v)}}, Ink::grid});
    double free = -std::numeric_limits<double>::infinity();
    for (const double v : cost_->labels(columns)) {
      const double half = width_of(number_text(v), size, false) / 2;
      if (x_of(v) - half < free || x_of(v) + half > format_.width) continue;
      free = x_of(v) + half + size;
      out_.shapes.emplace_back(Line{{{x_of(v), area_.bottom}, {x_of(v), area_.bottom + 5}}, Ink::axis});
      text({x_of(v), area_.bottom + 5 + size}, number_text(v), size, Ink::text, Anchor::middle);
    }
    const auto at_left = [&](double y, const std::string& letters) {
      out_.shapes.emplace_back(Line{{{area_.left - 5, y}, {area_.left, y}}, Ink::axis});
      text({area_.left - 8, y + size * 0.36}, letters, size, Ink::text, Anchor::end);
    };
    for (const double v : error_labels_) at_left(y_of(v), number_text(v));
    if (strip_.bottom > strip_.top) {
      at_left(y_of({}), plot_.error.none);
      const double y = plot_.error.more_is_better ? strip_.bottom : strip_.top;
      if (error_) out_.shapes.emplace_back(Line{{{area_.left, y}, {area_.right, y}}, Ink::axis, 1, true});
    }
    out_.shapes.emplace_back(Line{{{area_.left, area_.top},
                                   {area_.left, area_.bottom},
                                   {area_.right, area_.bottom},
                                   {area_.right, area_.top},
                                   {area_.left, area_.top}},
                                  Ink::axis});
    text({(area_.left + area_.right) / 2, format_.height - kEdge}, plot_.cost.title, format_.text, Ink::text,
         Anchor::middle);
    out_.shapes.emplace_back(Text{.at = {kEdge + size * 0.6, (area_.top + area_.bottom) / 2},
                                  .text = plot_.error.title,
                                  .size = format_.text,
                                  .anchor = Anchor::middle,
                                  .up = true});
  }

  /// The least error that so much buys, along all costs.
  [[nodiscard]] std::vector<Place> step_line() const {
    std::vector<Place> line;
    const Place first = place_of(plot_.points[front_.front()]);
    line.push_back({first.x, plot_.error.more_is_better ? area_.bottom : area_.top});
    for (const std::size_t i : front_) {
      const Place p = place_of(plot_.points[i]);
      line.push_back({p.x, line.back().y});
      line.push_back(p);
    }
    line.push_back({area_.right, line.back().y});
    line.erase(line.begin());  // the first stretch runs down to the cheapest point
    line.front().y = plot_.error.more_is_better ? area_.bottom : area_.top;
    return line;
  }

  void marks() {
    std::vector<bool> best(plot_.points.size(), false);
    for (const std::size_t i : front_) best[i] = true;
    // The frontier above the others, and the base above all.
    for (const int layer : {0, 1, 2})
      for (std::size_t i = 0; i < plot_.points.size(); ++i) {
        const PlotPoint& p = plot_.points[i];
        if ((p.base ? 2 : best[i] ? 1 : 0) != layer) continue;
        out_.shapes.emplace_back(Mark{.at = place_of(p),
                                      .radius = p.base ? kBaseMark : 4,
                                      .ink = p.base    ? Ink::base
                                             : best[i] ? Ink::front
                                                       : Ink::other,
                                      .hollow = p.estimated,
                                      .diamond = p.base,
                                      .row = p.row,
                                      .name = p.full_name});
      }
  }

  /// Which points are to be named, the most important first.
  [[nodiscard]] std::vector<std::size_t> named() const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < plot_.points.size(); ++i)
      if (plot_.points[i].base) out.push_back(i);
    std::vector<Place> chain;
    for (const std::size_t i : front_) chain.push_back(place_of(plot_.points[i]));
    for (const std::size_t k : bends(chain, (area_.right - area_.left) / 30))
      if (std::find(out.begin(), out.end(), front_[k]) == out.end()) out.push_back(front_[k]);
    return out;
  }

  /// How bad a name is in a box; infinity where it may not be.
  [[nodiscard]] double badness(const Box& box, const std::vector<Place>& line) const {
    if (box.left < area_.left + 2 || box.right > area_.right - 2 || box.top < area_.top + 2 ||
        box.bottom > area_.bottom - 2)
      return std::numeric_limits<double>::infinity();
    for (const Box& other : taken_)
      if (overlap(box, other)) return std::numeric_limits<double>::infinity();
    double bad = 0;
    for (const PlotPoint& p : plot_.points)
      if (overlap(box, round_about(place_of(p), 5))) bad += 12;
    for (std::size_t i = 1; i < line.size(); ++i)
      if (crosses(box, line[i - 1], line[i])) bad += 30;
    return bad;
  }

  void names(const std::vector<Place>& line) {
    for (const std::size_t i : front_) taken_.push_back(round_about(place_of(plot_.points[i]), 6));
    for (const PlotPoint& p : plot_.points)
      if (p.base) taken_.push_back(round_about(place_of(p), kBaseMark + 2));
    for (const std::size_t i : named()) put_name(plot_.points[i], line);
  }

  void put_name(const PlotPoint& point, const std::vector<Place>& line) {
    const double size = format_.text - 1;
    const double wide = width_of(point.name, size, point.base);
    const double own = point.base ? kBaseMark : 4;
    const Place at = place_of(point);
    double least = std::numeric_limits<double>::infinity();
    Box best;
    for (const double far : {7.0, 16.0, 28.0, 42.0, 60.0, 84.0})
      for (int turn = 0; turn < 16; ++turn) {
        const double angle = (turn + 0.5) * std::numbers::pi / 8;
        const double dx = std::cos(angle);
        const double dy = std::sin(angle);
        // The box's point that is nearest to the mark lies `far` from it.
        const double x = at.x + dx * (own + far) + (dx > 0.3 ? 0 : dx < -0.3 ? -wide : -wide / 2);
        const double y = at.y + dy * (own + far) - size / 2 + (dy > 0.3 ? size / 2 : dy < -0.3 ? -size / 2 : 0);
        const Box box{x - 2, y - 1, x + wide + 2, y + size + 2};
        const double bad = badness(box, line) + far;
        if (bad < least) {
          least = bad;
          best = box;
        }
      }
    if (!std::isfinite(least)) return;
    const Place near{std::clamp(at.x, best.left, best.right), std::clamp(at.y, best.top, best.bottom)};
    const double gap = std::hypot(near.x - at.x, near.y - at.y);
    if (gap > own + 8) {
      const double from = (own + 1) / gap;
      out_.shapes.emplace_back(
          Line{{{at.x + (near.x - at.x) * from, at.y + (near.y - at.y) * from}, near}, Ink::soft, 1});
    }
    out_.shapes.emplace_back(Text{.at = {best.left + 2, best.top + 1 + size * 0.86},
                                  .text = point.name,
                                  .size = size,
                                  .ink = point.base ? Ink::base : Ink::text,
                                  .bold = point.base,
                                  .halo = true});
    taken_.push_back(best);
  }

  void describe() {
    out_.description =
        fmt::format("{} against {}. The frontier, from the cheapest:", plot_.error.title, plot_.cost.title);
    for (const std::size_t i : front_) {
      const PlotPoint& p = plot_.points[i];
      out_.description += fmt::format(" {} ({}, {});", p.name, number_text(p.cost),
                                      p.error ? fmt::format("{:.4g}", *p.error) : plot_.error.none);
    }
    out_.description.back() = '.';
  }

  static constexpr double kEdge = 12;
  static constexpr double kBaseMark = 7;

  const ParetoPlot& plot_;
  PlotFormat format_;
  bool narrow_;
  Drawing out_;
  std::vector<std::size_t> front_;
  double top_ = 0;  // down to where something is written
  Box area_;
  Box main_;
  Box strip_;
  std::unique_ptr<Scale> cost_;
  std::unique_ptr<Scale> error_;
  std::vector<double> error_labels_;
  std::vector<Box> taken_;
};

}  // namespace

std::vector<std::size_t> frontier(const ParetoPlot& plot) {
  // How bad, from none.
  const auto bad = [&](std::size_t i) {
    const auto& error = plot.points[i].error;
    if (!error) return -std::numeric_limits<double>::infinity();
    return plot.error.more_is_better ? -*error : *error;
  };
  std::vector<std::size_t> order(plot.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double ca = plot.points[a].cost;
    const double cb = plot.points[b].cost;
    return ca != cb ? ca < cb : bad(a) < bad(b);
  });
  std::vector<std::size_t> out;
  for (const std::size_t i : order)
    if (out.empty() || bad(i) < bad(out.back())) out.push_back(i);
  return out;
}

std::vector<std::size_t> bends(const std::vector<Place>& chain, double far) {
  if (chain.empty()) return {};
  std::vector<std::size_t> out{0};
  if (chain.size() > 1) out.push_back(chain.size() - 1);
  std::vector<std::pair<double, std::size_t>> found;
  std::vector<std::pair<std::size_t, std::size_t>> open;
  if (chain.size() > 2) open.emplace_back(0, chain.size() - 1);
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double most = far;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i)
      if (const double d = from_line(chain[i], chain[first], chain[last]); d > most) {
        most = d;
        at = i;
      }
    if (at == first) continue;
    found.emplace_back(most, at);
    open.emplace_back(first, at);
    open.emplace_back(at, last);
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  for (const auto& [distance, at] : found) out.push_back(at);
  return out;
}

Drawing draw(const ParetoPlot& plot, const PlotFormat& format) { return Plotter(plot, format).draw(); }

}  // namespace kage::plot
