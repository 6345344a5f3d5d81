// SPDX-License-Identifier: Apache-2.0
//
// A drawing of lines, marks and text: one description, from which both the SVG and the PNG file of a plot are made.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kage/image.hpp"

namespace kage::plot {

/// Purpose of a drawn thing, which decides its colour, in a light and in a dark variant.
enum class Ink : std::uint8_t { back, text, soft, axis, grid, front, other, base };

/// 0xRRGGBB on a light background and on a dark one, and the name of its class in SVG.
struct InkColors {
  std::string_view name;
  std::uint32_t light;
  std::uint32_t dark;
};
inline constexpr std::array<InkColors, 8> kInks{{{"back", 0xffffff, 0x14171c},
                                                 {"text", 0x1b1f27, 0xe5e9f0},
                                                 {"soft", 0x545d6c, 0xa3adbd},
                                                 {"axis", 0x8b94a3, 0x6b7686},
                                                 {"grid", 0xe3e6eb, 0x2a313c},
                                                 {"front", 0x1f5fc4, 0x84b2ff},
                                                 {"other", 0x757e8c, 0x8d97a6},
                                                 {"base", 0xb34700, 0xffb067}}};
inline constexpr const InkColors& colors_of(Ink ink) { return kInks[static_cast<std::size_t>(ink)]; }

/// From the left and the top.
struct Place {
  double x = 0;
  double y = 0;
};

/// A chain of straight lines.
struct Line {
  std::vector<Place> places{};
  Ink ink = Ink::axis;
  double width = 1;
  bool dashed = false;
};

/// A disc, or a square on its corner.
struct Mark {
  Place at{};
  double radius = 4;
  Ink ink = Ink::other;
  bool hollow = false;
  bool diamond = false;
  int row = -1;  ///< of the list that is plotted, at least 0: a program that shows the drawing can tell which it is
  std::string name{};  ///< what it is, for who points at it
};

enum class Anchor : std::uint8_t { start, middle, end };

struct Text {
  Place at{};  ///< on the line that letters stand on
  std::string text{};
  double size = 13;
  Ink ink = Ink::text;
  Anchor anchor = Anchor::start;
  bool bold = false;
  bool up = false;    ///< it runs upwards
  bool halo = false;  ///< with an edge of the background, so that it reads on lines
};

struct Drawing {
  double width = 0;
  double height = 0;
  std::string title;        ///< for who cannot see it, and for tabs
  std::string description;  ///< likewise
  std::vector<std::variant<Line, Mark, Text>> shapes;
};

/// Opens the plugin of plots, which the functions below need. Throws Error if it cannot be opened.
void load();

/// How wide a text is. Throws Error if the plugin of plots cannot be opened.
double width_of(std::string_view text, double size, bool bold);

/// Well-formed XML, with text as text. Colours are attributes, those of a dark screen a style: where no style is known,
/// and on paper, it is light. Each text has its measured width, so that another font covers no other text.
std::string to_svg(const Drawing& drawing);

/// On the light background, `scale` pixels for a unit. Throws Error if the plugin of plots cannot be opened.
Image to_image(const Drawing& drawing, double scale);

}  // namespace kage::plot
