// SPDX-License-Identifier: Apache-2.0
#include "explore/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "contract/derived.hpp"
#include "kage/core.hpp"
#include "kage/frontend.hpp"

namespace kage::explore {
namespace {

/// Takes the state of every pixel right before its line ends.
class StateTaker : public CoreObserver {
 public:
  /// `lit`: of each polygon of the scene, whether it takes shadow, where pixels do not say so.
  StateTaker(const Config& config, const std::vector<bool>& lit, DrawnFrame& out)
      : config_(config), lit_(&lit), out_(&out) {}

  void before(std::uint32_t /*index*/, const Token& token, std::span<const std::uint32_t> /*words*/,
              const LineView& line) override {
    // RESOLVE uses up a single flag or count; a line without it ends with what it has.
    const bool resolves = token.kind == Kind::RESOLVE;
    if (!resolves && token.kind != Kind::EOL) return;
    const auto from = static_cast<std::size_t>(y_) * static_cast<std::size_t>(out_->width);
    for (int x = 0; x < out_->width; ++x) {
      const PixelState p = line.pixel(x);
      const std::size_t at = from + static_cast<std::size_t>(x);
      out_->z[at] = p.z;
      if (resolves && config_.linear_bits > 0)
        take_light(p, line.bias(), at);
      else if (resolves)
        out_->counts[at] = counts_of(p, line.bias());
    }
    pass_ = resolves ? pass_ + 1 : 0;
    if (!resolves) ++y_;
  }

 private:
  // Light after light has one counter, and a RESOLVE for each light.
  void take_light(const PixelState& p, std::uint32_t bias, std::size_t at) {
    if (pass_ >= out_->counts[at].size() || p.z == derived::clear_depth(config_) || !(*lit_)[out_->face[at]]) return;
    out_->counts[at][pass_] = config_.count_bits > 0 ? static_cast<std::uint8_t>(p.counts[0]) : in_shadow(p, bias);
  }

  [[nodiscard]] std::uint8_t in_shadow(const PixelState& p, std::uint32_t bias) const {
    return (config_.fsf > 0 ? p.fsf != 0 : ((p.dsf + bias) & derived::most_dsf(config_)) != 0) ? 1 : 0;
  }

  [[nodiscard]] std::array<std::uint8_t, 8> counts_of(const PixelState& p, std::uint32_t bias) const {
    std::array<std::uint8_t, 8> counts{};
    if (p.normal_class == 0 || p.z == derived::clear_depth(config_)) return counts;
    if (config_.count_bits > 0) {
      for (std::size_t l = 0; l < counts.size(); ++l) counts[l] = static_cast<std::uint8_t>(p.counts[l]);
    } else {
      counts[0] = in_shadow(p, bias);
    }
    return counts;
  }

  Config config_;
  const std::vector<bool>* lit_;
  DrawnFrame* out_;
  int y_ = 0;  // the line at hand
  std::size_t pass_ = 0;
};

/// Takes which translucent faces come to each pixel; their colours are their numbers.
class LayerTaker : public CoreObserver {
 public:
  LayerTaker(int width, std::vector<std::vector<std::uint32_t>>& out) : width_(width), out_(&out) {}

  void before(std::uint32_t /*index*/, const Token& token, std::span<const std::uint32_t> /*words*/,
              const LineView& /*line*/) override {
    if (token.kind == Kind::EOL) ++y_;
    if (token.kind != Kind::TP) return;
    const auto& c = token.span.color;
    const auto face = static_cast<std::uint32_t>(c[0] | c[1] << 8 | c[2] << 16);
    for (int x = token.span.xl; x < token.span.xr; ++x)
      (*out_)[static_cast<std::size_t>(y_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)].push_back(
          face);
  }

 private:
  int width_;
  std::vector<std::vector<std::uint32_t>>* out_;
  int y_ = 0;  // the line at hand
};

/// The words of a geometry with all spans, so that shadows are counted where none is seen, too; and the golden core's
/// picture of them.
void run(const FrameGeometry& g, const Config& config, int threads, CoreObserver* observer, const LineSink& sink) {
  GoldenCore core(config);
  core.observe(observer);
  make_frame(g, config, 0, [&](std::span<const std::uint32_t> words) { core.feed(words, sink); },
             {.threads = threads, .all_spans = true});
  if (core.finish(sink).error != ErrorCode::NONE)
    throw std::logic_error("the golden core refuses what the front end made");
}

/// A geometry without shadows, whose faces have their numbers as colours. All else is the configuration's own, the
/// order of drawing too, which decides between equal depths.
FrameGeometry numbered_faces(const SceneFrame& frame, const Config& plain, const DrawOptions& options) {
  TranslucentOrder order(options.order);
  FrameGeometry g = make_geometry(frame, plain, options.width, options.height, {.look = options.look, .order = &order});
  g.background = 0xFFFFFF;
  g.volumes.clear();
  g.volume_faces.clear();
  g.near_edges.clear();
  g.shares.clear();
  for (ScreenPolygon& p : g.polygons) {
    p.lit = false;
    p.normal_class = 0;
    p.color_planes = p.light_planes = -1;
    p.shade_cut = -1;
    for (unsigned c = 0; c < 3; ++c) p.color[c] = static_cast<std::uint8_t>(p.source >> (8 * c));
  }
  return g;
}

/// Which face each pixel shows: drawn again without shadows and layers, which do not change what is in front.
void take_faces(const SceneFrame& frame, const Config& config, const DrawOptions& options, DrawnFrame& out) {
  Config plain = config;
  plain.channels = 3;
  plain.linear_bits = 0;
  FrameGeometry g = numbered_faces(frame, plain, options);
  g.fragments.clear();
  std::size_t at = 0;
  run(g, plain, options.threads, nullptr, [&](int, std::span<const std::uint8_t> p) {
    for (std::size_t i = 0; i + 2 < p.size(); i += 3, ++at) {
      const std::uint32_t face =
          p[i] | static_cast<std::uint32_t>(p[i + 1]) << 8 | static_cast<std::uint32_t>(p[i + 2]) << 16;
      out.face[at] = face == 0xFFFFFF ? kNothing : face;
    }
  });
}

}  // namespace

double depth_steps(const Config& config) { return static_cast<double>(derived::most_depth(config)) - 1; }

DrawnFrame draw(const SceneFrame& frame, const Config& config, const DrawOptions& options) {
  DrawnFrame out;
  out.width = options.width;
  out.height = options.height;
  const std::size_t pixels = static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
  out.face.resize(pixels, kNothing);
  out.z.resize(pixels);
  out.counts.resize(pixels);
  out.color.resize(pixels);
  take_faces(frame, config, options, out);
  TranslucentOrder order(options.order);
  const FrameGeometry g =
      make_geometry(frame, config, options.width, options.height, {.look = options.look, .order = &order});
  std::vector<bool> lit(frame.polygons.size(), false);
  for (std::uint32_t i = 0; i < g.drawn; ++i) lit[g.polygons[i].source] = g.polygons[i].lit;
  StateTaker taker(config, lit, out);
  const auto channels = static_cast<std::size_t>(config.channels);
  std::size_t at = 0;
  run(g, config, options.threads, &taker, [&](int, std::span<const std::uint8_t> p) {
    for (std::size_t i = 0; i + channels <= p.size(); i += channels, ++at)
      for (std::size_t c = 0; c < 3; ++c) out.color[at][c] = p[i + (channels == 3 ? c : 0)];
  });
  return out;
}

std::vector<std::vector<std::uint32_t>> draw_layers(const SceneFrame& frame, const Config& config,
                                                    const DrawOptions& options) {
  std::vector<std::vector<std::uint32_t>> out(static_cast<std::size_t>(options.width) *
                                              static_cast<std::size_t>(options.height));
  if (config.translucency == 0) return out;
  Config plain = config;
  plain.channels = 3;
  plain.smooth = plain.color_frac = plain.linear_bits = 0;
  LayerTaker taker(options.width, out);
  run(numbered_faces(frame, plain, options), plain, options.threads, &taker, [](int, std::span<const std::uint8_t>) {});
  return out;
}

Accuracy& Accuracy::operator+=(const Accuracy& o) {
  pixels += o.pixels;
  visible_wrong += o.visible_wrong;
  shadow_wrong += o.shadow_wrong;
  z_max = std::max(z_max, o.z_max);
  color_max = std::max(color_max, o.color_max);
  return *this;
}

double Accuracy::wrong_ppm(std::uint64_t of) const {
  return of == 0 ? 0 : 1e6 * static_cast<double>(visible_wrong + shadow_wrong) / static_cast<double>(of);
}

PixelFault fault_of(const TruePixel& truth, const DrawnFrame& drawn, std::size_t pixel) {
  if (drawn.face[pixel] != truth.face) return PixelFault::face;
  return truth.lit && drawn.counts[pixel] != truth.counts ? PixelFault::shadow : PixelFault::none;
}

double depth_error(const ScreenTruth& truth, const DrawnFrame& drawn, const Config& config) {
  const double range = depth_steps(config);
  double most = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const TruePixel& t = truth.pixels[i];
    if (t.face == kNothing || drawn.face[i] != t.face) continue;
    most = std::max(most, std::abs((static_cast<double>(drawn.z[i]) - 1) / range - t.depth));
  }
  return most;
}

Accuracy compare(const ScreenTruth& truth, const DrawnFrame& finest, const DrawnFrame& drawn, const Config& config) {
  Accuracy out;
  out.z_max = depth_error(truth, drawn, config);
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const TruePixel& t = truth.pixels[i];
    ++out.pixels;
    const PixelFault fault = fault_of(t, drawn, i);
    if (fault == PixelFault::face) ++out.visible_wrong;
    if (fault == PixelFault::shadow) ++out.shadow_wrong;
    if (fault != PixelFault::none || finest.face[i] != t.face || finest.counts[i] != drawn.counts[i]) continue;
    for (std::size_t c = 0; c < 3; ++c)
      out.color_max = std::max(out.color_max, std::abs(int{drawn.color[i][c]} - int{finest.color[i][c]}));
  }
  return out;
}

}  // namespace kage::explore
