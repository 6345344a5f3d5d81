// SPDX-License-Identifier: Apache-2.0
#include "explore/plot/drawing.hpp"

#include <fmt/format.h>

#include "cosim/report/html.hpp"
#include "explore/plot/plugin/table.hpp"
#include "plugin/foreign_code.hpp"

namespace kage::plot {
namespace {

using report::escaped;

std::string hex(std::uint32_t color) { return fmt::format("#{:06x}", color); }

/// A length, to a hundredth, without noughts at its end.
std::string length(double value) {
  std::string text = fmt::format("{:.2f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string fill(Ink ink) { return fmt::format("fill=\"{}\"", hex(colors_of(ink).light)); }

std::string stroke(Ink ink, double width) {
  return fmt::format("stroke=\"{}\" stroke-width=\"{}\"", hex(colors_of(ink).light), length(width));
}

/// The dark variants, by class: f- fills, s- strokes.
std::string dark_style() {
  std::string rules;
  for (const InkColors& ink : kInks)
    rules += fmt::format(".f-{0}{{fill:{1}}}.s-{0}{{stroke:{1}}}", ink.name, hex(ink.dark));
  return "@media screen and (prefers-color-scheme:dark){" + rules + "}";
}

std::string svg_of(const Line& line) {
  std::string places;
  for (const Place& p : line.places)
    places += fmt::format("{}{},{}", places.empty() ? "" : " ", length(p.x), length(p.y));
  return fmt::format("<polyline class=\"s-{}\" fill=\"none\" {}{} points=\"{}\"/>\n", colors_of(line.ink).name,
                     stroke(line.ink, line.width), line.dashed ? " stroke-dasharray=\"4 4\"" : "", places);
}

std::string svg_of(const Mark& mark) {
  const std::string paint =
      fmt::format("class=\"f-{} s-{}\" {} {}", colors_of(mark.hollow ? Ink::back : mark.ink).name,
                  colors_of(mark.ink).name, fill(mark.hollow ? Ink::back : mark.ink), stroke(mark.ink, kMarkEdge));
  const auto [x, y] = mark.at;
  const double r = mark.radius;
  const std::string shape =
      mark.diamond ? fmt::format("<path {} d=\"M{} {}L{} {}L{} {}L{} {}Z\"", paint, length(x), length(y - r),
                                 length(x + r), length(y), length(x), length(y + r), length(x - r), length(y))
                   : fmt::format("<circle {} cx=\"{}\" cy=\"{}\" r=\"{}\"", paint, length(x), length(y), length(r));
  if (mark.row < 0) return shape + "/>\n";
  return fmt::format("<g data-row=\"{}\" data-x=\"{}\" data-y=\"{}\">{}><title>{}</title></{}></g>\n", mark.row,
                     length(x), length(y), shape, escaped(mark.name), mark.diamond ? "path" : "circle");
}

std::string svg_of(const Text& text) {
  constexpr std::array kAnchors{"start", "middle", "end"};
  std::string attributes =
      fmt::format("x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\" textLength=\"{}\"", length(text.at.x),
                  length(text.at.y), length(text.size), kAnchors[static_cast<std::size_t>(text.anchor)],
                  length(width_of(text.text, text.size, text.bold)));
  if (text.bold) attributes += " font-weight=\"bold\"";
  if (text.up) attributes += fmt::format(" transform=\"rotate(-90 {} {})\"", length(text.at.x), length(text.at.y));
  const std::string letters = escaped(text.text);
  std::string out;
  if (text.halo)  // as text of its own below: not every program knows paint-order
    out = fmt::format("<text class=\"f-back s-back\" aria-hidden=\"true\" {} {} stroke-linejoin=\"round\" {}>{}</text>",
                      fill(Ink::back), stroke(Ink::back, kHalo), attributes, letters);
  return out + fmt::format("<text class=\"f-{}\" {} {}>{}</text>\n", colors_of(text.ink).name, fill(text.ink),
                           attributes, letters);
}

}  // namespace

void load() { plugin_table<PlotPlugin>(); }

double width_of(std::string_view text, double size, bool bold) {
  const PlotPlugin& plugin = plugin_table<PlotPlugin>();
  const ForeignCode mark("the plots: Cairo and fontconfig");
  return plugin.width(text, size, bold);
}

std::string to_svg(const Drawing& drawing) {
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
      "font-family=\"'DejaVu Sans',Verdana,sans-serif\">\n<title>{2}</title>\n<desc>{3}</desc>\n<style>{4}</style>\n"
      "<rect class=\"f-back\" {5} width=\"{0}\" height=\"{1}\"/>\n",
      length(drawing.width), length(drawing.height), escaped(drawing.title), escaped(drawing.description), dark_style(),
      fill(Ink::back));
  for (const auto& shape : drawing.shapes) out += std::visit([](const auto& s) { return svg_of(s); }, shape);
  return out + "</svg>\n";
}

Image to_image(const Drawing& drawing, double scale) {
  const PlotPlugin& plugin = plugin_table<PlotPlugin>();
  const ForeignCode mark("the plots: Cairo and fontconfig");
  return plugin.image(drawing, scale);
}

}  // namespace kage::plot
