// SPDX-License-Identifier: Apache-2.0
// A drawing as pixels, and how wide text is, by Cairo.
#include <cairo.h>
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "explore/plot/plugin/table.hpp"
#include "kage/error.hpp"

namespace kage::plot::plugin {
namespace {

struct Destroy {
  void operator()(cairo_t* c) const { cairo_destroy(c); }
  void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
};

/// A surface, and what draws on it.
class Canvas {
 public:
  Canvas(int width, int height)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)), cairo_(cairo_create(surface_.get())) {
    check();
    // Letters at the places that they would have at any size, so that measured widths are those of any scale.
    cairo_font_options_t* const options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_set_font_options(cairo_.get(), options);
    cairo_font_options_destroy(options);
  }

  void check() const {
    for (const cairo_status_t status : {cairo_status(cairo_.get()), cairo_surface_status(surface_.get())})
      if (status != CAIRO_STATUS_SUCCESS) throw Error(fmt::format("a plot: {}", cairo_status_to_string(status)));
  }

  void font(double size, bool bold) const {
    cairo_select_font_face(get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(get(), size);
  }

  [[nodiscard]] double width(const std::string& text) const {
    cairo_text_extents_t extents;
    cairo_text_extents(get(), text.c_str(), &extents);
    return extents.x_advance;
  }

  void ink(Ink ink) const {
    const std::uint32_t color = colors_of(ink).light;
    const auto part = [color](int shift) { return (color >> shift & 0xFFU) / 255.0; };
    cairo_set_source_rgb(get(), part(16), part(8), part(0));
  }

  void draw(const Line& line) const {
    ink(line.ink);
    for (const Place& p : line.places) cairo_line_to(get(), p.x, p.y);
    cairo_set_line_width(get(), line.width);
    const double dash = 4;
    cairo_set_dash(get(), &dash, line.dashed ? 1 : 0, 0);
    cairo_stroke(get());
    cairo_set_dash(get(), &dash, 0, 0);
  }

  void draw(const Mark& mark) const {
    const auto [x, y] = mark.at;
    const double r = mark.radius;
    if (mark.diamond) {
      for (const Place& p : {Place{x, y - r}, Place{x + r, y}, Place{x, y + r}, Place{x - r, y}})
        cairo_line_to(get(), p.x, p.y);
    } else {
      cairo_arc(get(), x, y, r, 0, 2 * std::numbers::pi);
    }
    cairo_close_path(get());
    ink(mark.hollow ? Ink::back : mark.ink);
    cairo_fill_preserve(get());
    ink(mark.ink);
    cairo_set_line_width(get(), kMarkEdge);
    cairo_stroke(get());
  }

  void draw(const Text& text) const {
    font(text.size, text.bold);
    const double long_ = width(text.text);
    cairo_save(get());
    cairo_translate(get(), text.at.x, text.at.y);
    if (text.up) cairo_rotate(get(), -std::numbers::pi / 2);
    cairo_move_to(get(), text.anchor == Anchor::start ? 0 : text.anchor == Anchor::middle ? -long_ / 2 : -long_, 0);
    cairo_text_path(get(), text.text.c_str());
    if (text.halo) {
      ink(Ink::back);
      cairo_set_line_width(get(), kHalo);
      cairo_set_line_join(get(), CAIRO_LINE_JOIN_ROUND);
      cairo_stroke_preserve(get());
      cairo_set_line_join(get(), CAIRO_LINE_JOIN_MITER);
    }
    ink(text.ink);
    cairo_fill(get());
    cairo_restore(get());
  }

  [[nodiscard]] Image image() const {
    check();
    cairo_surface_flush(surface_.get());
    Image out(cairo_image_surface_get_width(surface_.get()), cairo_image_surface_get_height(surface_.get()), 3);
    const unsigned char* const data = cairo_image_surface_get_data(surface_.get());
    const int stride = cairo_image_surface_get_stride(surface_.get());
    for (int y = 0; y < out.height; ++y) {
      const auto* const line = reinterpret_cast<const std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
      for (int x = 0; x < out.width; ++x)
        for (std::size_t c = 0; c < 3; ++c)
          out.data[out.index(x, y) + c] = static_cast<std::uint8_t>(line[x] >> (16 - 8 * c) & 0xFFU);
    }
    return out;
  }

  [[nodiscard]] cairo_t* get() const { return cairo_.get(); }

 private:
  std::unique_ptr<cairo_surface_t, Destroy> surface_;
  std::unique_ptr<cairo_t, Destroy> cairo_;
};

}  // namespace

double width(std::string_view text, double size, bool bold) {
  Canvas canvas(1, 1);
  canvas.font(size, bold);
  const double out = canvas.width(std::string(text));
  canvas.check();
  return out;
}

Image image(const Drawing& drawing, double scale) {
  Canvas canvas(static_cast<int>(std::lround(drawing.width * scale)),
                static_cast<int>(std::lround(drawing.height * scale)));
  canvas.ink(Ink::back);
  cairo_paint(canvas.get());
  cairo_scale(canvas.get(), scale, scale);
  for (const auto& shape : drawing.shapes) std::visit([&](const auto& s) { canvas.draw(s); }, shape);
  return canvas.image();
}

}  // namespace kage::plot::plugin
