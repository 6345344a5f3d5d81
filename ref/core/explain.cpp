// SPDX-License-Identifier: Apache-2.0
#include "kage/explain.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "contract/derived.hpp"
#include "contract/display_curve.hpp"
#include "contract/kinds.hpp"
#include "kage/error.hpp"
#include "kernels/span_value.hpp"
#include "number/counted.hpp"
#include "number/packed_color.hpp"

namespace kage {

std::string color_text(const Config& c, const std::array<std::uint16_t, 3>& color) {
  return c.channels == 1 ? fmt::format("{}", color[0]) : fmt::format("{},{},{}", color[0], color[1], color[2]);
}

namespace {

class History : public CoreObserver {
 public:
  History(const Config& config, int x, int y, PixelHistory& history)
      : config_(config), clear_(derived::clear_depth(config)), x_(x), y_(y), history_(&history) {}

  void came(std::uint32_t /*index*/, const Token& /*token*/, std::span<const std::uint32_t> words) override {
    came_ = words;
  }

  void before(std::uint32_t index, const Token& t, std::span<const std::uint32_t> words,
              const LineView& line) override {
    ++nth_;
    if (t.kind == Kind::SHADE) shade_ = t.shade;
    if (t.kind == Kind::EOL) lit_ = false;
    if (t.kind == Kind::RESOLVE && config_.linear_bits > 0) {
      lit_ = true;
      samples_ = t.samples;
    }
    // An EOL that was accepted counts as a line that has ended.
    here_ = (t.kind == Kind::EOL ? t.y : line.y()) == y_ && x_ < line.width() && touches(t);
    if (!here_) return;
    touch_ = {};
    touch_.token = index;
    touch_.nth = nth_;
    touch_.what = t;
    touch_.made = !came_.empty() && words.data() != came_.data();
    touch_.text = to_string(config_, t);
    if (touch_.made) touch_.text += ", made by the front end";
    touch_.before = line.pixel(x_);
    touch_.bias_before = line.bias();
    if (t.kind == Kind::RESOLVE) lit_bias_ = touch_.bias_before;
    shadowed_ =
        config_.fsf != 0 ? touch_.before.fsf != 0 : ((touch_.before.dsf + lit_bias_) & derived::most_dsf(config_)) != 0;
    background_ = line.background();
    painted_ = line.painted();
    if (t.kind == Kind::EOL) leave();
  }

  void after(std::uint32_t /*index*/, const Token& t, const LineView& line) override {
    if (!here_ || t.kind == Kind::EOL) return;
    touch_.after = line.pixel(x_);
    touch_.bias = line.bias();
    if (t.kind == Kind::TREE) path(line);
    touch_.effect = effect(t, line);
    history_->touches.push_back(touch_);
  }

  void failed(const FrameStatus& status, std::span<const std::uint32_t> /*words*/, const LineView& /*line*/) override {
    if (static_cast<int>(status.line) <= y_)
      history_->color_text = "background: the frame has an error on this line or before";
  }

 private:
  [[nodiscard]] bool touches(const Token& t) const {
    const KindInfo& info = info_of(t.kind);
    return info.whole_line || (info.range && t.span.xl <= x_ && x_ < t.span.xr);
  }

  [[nodiscard]] std::string depth(std::uint32_t z) const { return z == clear_ ? "clear" : fmt::format("{}", z); }

  // "Z 812 is nearer than 4031".
  [[nodiscard]] std::string order(std::uint32_t z) const {
    const std::uint32_t old = touch_.before.z;
    if (z < old) return fmt::format("Z {} is nearer than {}", z, depth(old));
    return z == old ? fmt::format("Z {} is no nearer: equal, and the first stays", z)
                    : fmt::format("Z {} is behind {}", z, depth(old));
  }

  std::string effect(const Token& t, const LineView& line) {
    const PixelState& from = touch_.before;
    const PixelState& to = touch_.after;
    switch (t.kind) {
      case Kind::OP: {
        touch_.z = span_depth(config_, t.span, x_);
        if (lit_) return light();
        if (*touch_.z >= from.z) return "hidden: " + order(*touch_.z);
        return fmt::format("drawn: {}; colour {}", order(*touch_.z), color_text(config_, to.color));
      }
      case Kind::TREE: {
        const auto p = line.tree_pixel(x_);
        if (p.z == clear_) return "no polyhedron is here";
        touch_.z = p.z;
        touch_.polyhedron = p.index;
        if (p.z >= from.z) return "hidden: " + order(p.z);
        return fmt::format("drawn: {}, of the polyhedron with draw index {}; colour {}", order(p.z), p.index,
                           color_text(config_, to.color));
      }
      case Kind::SP:
        touch_.z = span_depth(config_, t.span, x_);
        if (*touch_.z >= from.z) return "not counted: " + order(*touch_.z);
        return fmt::format("counted: {}; DSF {} {:+} = {}", order(*touch_.z), from.dsf, t.span.w, to.dsf);
      case Kind::NC:
        return fmt::format("counted, whatever its depth: DSF {} {:+} = {}", from.dsf, t.span.w, to.dsf);
      case Kind::IF:
        return fmt::format("the eye is in the volume for all the line: bias {}", line.bias());
      case Kind::EV: {
        const bool in = to.fsf != from.fsf || (from.fsf == 1 && sum(from) != 0);
        return fmt::format("end of a volume: DSF + bias = {}, so the pixel is {} it{}", sum(from), in ? "in" : "not in",
                           to.fsf != 0 ? "; FSF is 1" : "");
      }
      case Kind::ES: {
        const auto light = static_cast<std::size_t>(t.table.light);
        const bool in = config_.fsf != 0 ? from.fsf != 0 : sum(from) != 0;
        return fmt::format("end of a sample of light {}: {}; count {}", light, in ? "in shadow" : "not in shadow",
                           to.counts[light]);
      }
      case Kind::RESOLVE:
        if (config_.linear_bits > 0) return "a light follows";
        return resolve();
      case Kind::TP:
        touch_.z = span_depth(config_, t.span, x_);
        if (*touch_.z >= from.z) return "hidden: " + order(*touch_.z);
        return fmt::format("blended over: {}; {} of 255 of {} on {} gives {}", order(*touch_.z), t.span.alpha,
                           color_text(config_, span_color(config_, t.span, x_, true)), color_text(config_, shown(from)),
                           color_text(config_, to.color));
      default:
        return {};
    }
  }

  [[nodiscard]] std::uint32_t sum(const PixelState& s) const {
    return (s.dsf + touch_.bias_before) & derived::most_dsf(config_);
  }

  [[nodiscard]] std::string resolve() const {
    const PixelState& from = touch_.before;
    if (from.z == clear_) return "nothing is drawn here";
    if (from.normal_class == 0) return "unlit: no light is lost";
    const std::string change =
        fmt::format("colour {} becomes {}", color_text(config_, from.color), color_text(config_, touch_.after.color));
    if (config_.count_bits == 0) {
      const bool shadow = config_.fsf != 0 ? from.fsf != 0 : sum(from) != 0;
      if (!shadow) return "not in shadow";
      const std::uint32_t whole = derived::whole_share(config_);
      return fmt::format("in shadow: {}, {} of {} kept", change, whole - shade_, whole);
    }
    std::string counts;
    for (std::size_t l = 0; l < static_cast<std::size_t>(config_.lights); ++l)
      if (from.counts[l] != 0)
        counts += fmt::format("{}light {} lost {}", counts.empty() ? "" : ", ", l, counted(from.counts[l], "sample"));
    return counts.empty() ? "not in shadow"
                          : fmt::format("in shadow: {}, class {}; {}", counts, from.normal_class, change);
  }

  // An OP behind a RESOLVE of linear light.
  [[nodiscard]] std::string light() const {
    const PixelState& from = touch_.before;
    if (from.z == clear_) return "nothing is drawn here";
    if (*touch_.z > from.z) return "hidden: " + order(*touch_.z);
    if (from.served == touch_.after.served) return "a span before it has brought this light";
    const std::string change = fmt::format("light {} becomes {} of {}", color_text(config_, from.color),
                                           color_text(config_, touch_.after.color), 1 << config_.linear_bits);
    if (config_.count_bits == 0) return (shadowed_ ? "in shadow: " : "lit: ") + change;
    const int left = std::max(0, samples_ - static_cast<int>(from.counts[0]));
    return fmt::format("lit by {} of {}: {}", left, counted(static_cast<std::uint32_t>(samples_), "sample"), change);
  }

  [[nodiscard]] std::array<std::uint16_t, 3> background() const { return unpacked_levels(background_, 8); }

  // A pixel's colour as it is displayed.
  [[nodiscard]] std::array<std::uint16_t, 3> shown(const PixelState& s) const {
    if (!painted_ && s.z == clear_) return background();
    std::array<std::uint16_t, 3> color = s.color;
    for (int c = 0; c < config_.channels && config_.linear_bits > 0 && !painted_; ++c)
      color[static_cast<std::size_t>(c)] = displayed(color[static_cast<std::size_t>(c)], config_.linear_bits);
    return color;
  }

  void leave() {
    const bool drawn = touch_.before.z != clear_ || painted_;
    const auto color = shown(touch_.before);
    for (std::size_t c = 0; c < 3; ++c) history_->color[c] = static_cast<std::uint8_t>(color[c]);
    history_->color_text = drawn ? fmt::format("the pixel leaves with colour {}", color_text(config_, color))
                                 : fmt::format("nothing was drawn: background {}", color_text(config_, color));
  }

  // Neighbours meet level by level; one without a neighbour goes on alone (docs/tree.md).
  void path(const LineView& line) {
    history_->units.clear();
    history_->tree.clear();
    for (int u = 0; u < config_.units; ++u) history_->units.push_back(line.unit_pixel(u, x_));
    std::vector<LineView::UnitPixel> now = history_->units;
    for (int level = 1; now.size() > 1; ++level) {
      std::vector<TreeMatch> matches;
      std::vector<LineView::UnitPixel> next;
      for (std::size_t i = 0; i + 1 < now.size(); i += 2) {
        TreeMatch m;
        m.level = level;
        m.left = now[i];
        m.right = now[i + 1];
        m.right_wins = m.right.z < m.left.z || (m.right.z == m.left.z && m.right.index < m.left.index);
        matches.push_back(m);
        next.push_back(m.right_wins ? m.right : m.left);
      }
      if (now.size() % 2 != 0) next.push_back(now.back());
      history_->tree.push_back(std::move(matches));
      now = std::move(next);
    }
  }

  Config config_;
  std::uint32_t clear_;
  int x_;
  int y_;
  PixelHistory* history_;
  std::uint32_t nth_ = 0;
  std::uint32_t shade_ = 0;
  bool lit_ = false;  // the line is behind a RESOLVE of linear light
  int samples_ = 0;   // that this tells
  std::uint32_t lit_bias_ = 0;
  bool shadowed_ = false;  // without counters: its light does not come
  bool here_ = false;
  std::span<const std::uint32_t> came_;  // at the polygon level the words of the stream's token
  PixelTouch touch_;
  std::uint32_t background_ = 0;
  bool painted_ = false;
};

}  // namespace

PixelHistory explain_pixel(const Config& config, std::span<const std::uint32_t> words, int x, int y) {
  PixelHistory history;
  history.x = x;
  history.y = y;
  GoldenCore core(config);
  History observer(config, x, y, history);
  core.observe(&observer);
  const auto channels = static_cast<std::size_t>(config.channels);
  history.status = core.frame(words, [&](int line, std::span<const std::uint8_t> pixels) {
    if (line != y || static_cast<std::size_t>(x) * channels >= pixels.size()) return;
    for (std::size_t c = 0; c < channels; ++c) history.color[c] = pixels[static_cast<std::size_t>(x) * channels + c];
  });
  if (x < 0 || y < 0 || x >= history.status.width || y >= history.status.height)
    throw Error(fmt::format("pixel {},{}: the frame is {}x{}", x, y, history.status.width, history.status.height));
  return history;
}

std::string describe(const Config& config, const PixelState& s) {
  std::string text;
  if (s.z == derived::clear_depth(config))
    text = s.color == decltype(s.color){} ? "clear" : fmt::format("clear, colour {}", color_text(config, s.color));
  else
    text = fmt::format("Z {}, colour {}", s.z, color_text(config, s.color));
  if (config.dsf_bits == 0) return text;
  if (s.z != derived::clear_depth(config))
    text += config.linear_bits > 0       ? ""
            : derived::has_table(config) ? fmt::format(", class {}", s.normal_class)
            : s.normal_class != 0        ? ", lit"
                                         : ", unlit";
  text += fmt::format(", DSF {}", s.dsf);
  if (config.fsf != 0) text += fmt::format(", FSF {}", s.fsf);
  if (config.count_bits > 0)
    for (std::size_t l = 0; l < static_cast<std::size_t>(config.lights); ++l)
      text += fmt::format("{}{}", l == 0 ? ", counts " : " ", s.counts[l]);
  return text;
}

std::vector<std::string> describe_tree(const Config& config, const PixelHistory& h) {
  const std::uint32_t clear = derived::clear_depth(config);
  const auto text = [&](const LineView::UnitPixel& p) {
    return p.z == clear ? "nothing" : fmt::format("Z {} of index {}", p.z, p.index);
  };
  std::vector<std::string> lines;
  for (std::size_t u = 0; u < h.units.size(); ++u)
    if (h.units[u].z != clear) lines.push_back(fmt::format("unit {}: {}", u, text(h.units[u])));
  for (const auto& level : h.tree)
    for (const TreeMatch& m : level)
      if (m.left.z != clear || m.right.z != clear)
        lines.push_back(fmt::format("level {}: {} against {}: the {} wins", m.level, text(m.left), text(m.right),
                                    m.right_wins ? "second" : "first"));
  return lines;
}

}  // namespace kage
