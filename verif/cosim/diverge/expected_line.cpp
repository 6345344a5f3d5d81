// SPDX-License-Identifier: Apache-2.0
//
// The events of a line as a whole: it is painted, and it leaves.
#include <tuple>

#include "contract/derived.hpp"
#include "contract/display_curve.hpp"
#include "cosim/diverge/expected_events.hpp"
#include "number/packed_color.hpp"

namespace kage::cosim {

ExpectedEvents::Leaving ExpectedEvents::leaving(const PixelState& s, bool resolved) const {
  Leaving l;
  l.color = held(s.color);
  l.covered = !clear(s);
  if (config_.linear_bits > 0) return l;
  if (config_.count_bits > 0) {
    l.normal_class = s.normal_class;
    for (int i = 0; i < config_.lights && s.normal_class != 0; ++i)
      l.counts |= std::uint64_t{s.counts[static_cast<std::size_t>(i)]} << i * config_.count_bits;
  } else if (config_.dsf_bits > 0 && !resolved) {
    const bool shadow =
        config_.fsf != 0 ? s.fsf != 0 : low(static_cast<std::int64_t>(s.dsf + bias_), config_.dsf_bits) != 0;
    l.dark = shadow && s.normal_class != 0;
  }
  return l;
}

std::vector<ExpectedEvents::Leaving> ExpectedEvents::all_leaving(const LineView& line) const {
  std::vector<Leaving> all;
  all.reserve(static_cast<std::size_t>(width_));
  for (int x = 0; x < width_; ++x) all.push_back(leaving(line.pixel(x), painted_));
  return all;
}

void ExpectedEvents::line_event(bool blank, bool load, int step) {
  ExpectedEvent e = event(Stage::line, step);
  e.expect(at::line::first, y_ == 0 ? 1 : 0);
  e.expect(at::line::blank, blank ? 1 : 0);
  e.expect(at::line::load, load ? 1 : 0);
  e.expect(at::line::width, static_cast<std::uint64_t>(width_));
  e.expect(at::line::background, background_);
  if (!blank) {
    e.expect(at::line::painted, painted_ ? 1 : 0);
    e.expect(at::line::shade, shade_);
  }
  put(e);
}

// If banked, the pixels past the width in the last group leave too. The colour of
// a pixel without surface is nobody's until the line is painted, as in touch(): the way out takes the background.
void ExpectedEvents::leave(const std::vector<Leaving>& pixels, bool blank) {
  const int lanes = config_.arrangement == 1 ? config_.lanes : 1;
  const int end = (width_ + lanes - 1) / lanes * lanes;
  for (int x = 0; x < end; ++x) {
    ExpectedEvent e = event(Stage::exit, of_exit);
    if (x < width_) e.x = x;
    e.unit = x == end - 1 ? 1 : 0;
    if (x < width_ && !blank) {
      const Leaving& l = pixels[static_cast<std::size_t>(x)];
      if (l.covered || painted_) e.expect(at::exit::color, l.color);
      e.expect(at::exit::covered, l.covered ? 1 : 0);
      e.expect(at::exit::dark, l.dark ? 1 : 0);
      e.expect(at::exit::normal_class, derived::has_table(config_) ? l.normal_class : 0);
      e.expect(at::exit::counts, l.counts);
    }
    put(e);
  }
}

// Event of line_phase's outputs, where they are used.
void ExpectedEvents::state(std::uint64_t bias, bool matters) {
  ExpectedEvent e = event(Stage::state, of_token);
  e.expect(at::state::bias, bias);
  e.expect(at::state::resolved, resolved_ ? 1 : 0);
  e.ignore(at::state::resolved);
  if (!matters || config_.dsf_bits == 0) e.ignore(at::state::bias);
  put(e);
}

// State of a pixel once its line is painted. Its RESOLVE, if there was one, has darkened it.
PixelState ExpectedEvents::painted(const PixelState& before) const {
  PixelState s = before;
  if (clear(s)) {
    s.color = unpacked_levels(background_, 8);
  } else if (config_.linear_bits > 0) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(config_.channels); ++c)
      s.color[c] = displayed(s.color[c], config_.linear_bits);
  }
  s.dsf = s.fsf = 0;  // as a RESOLVE leaves them
  s.counts = {};
  return s;
}

// A pixel's colour comes back from the way out.
void ExpectedEvents::load_back(int x, const PixelState& s) {
  ExpectedEvent e = event(Stage::load, of_load);
  e.x = x;
  e.expect(at::load::x, static_cast<std::uint64_t>(x));
  e.expect(at::load::color, packed_color(s.color, config_.channels));
  put(e);
  command(number(derived::kCommandLoad), x, x + 1, of_load_command);
  ExpectedEvent& c = newest(Stage::command, 0);
  c.load = true;
  c.x = x;
  for (int i = 0; i < config_.channels; ++i)
    c.expect(at::command::color + i, std::uint64_t{s.color[static_cast<std::size_t>(i)]} << config_.color_frac);
  touch(number(derived::kCommandLoad), x, s, of_loaded);
  newest(Stage::pixel, x).load = true;
}

// Events of frame_control before a line's first TP.
void ExpectedEvents::paint(const LineView& line) {
  const bool linear = config_.linear_bits > 0;
  state(bias_, !derived::has_loads(config_));
  if (derived::has_loads(config_) && !linear) newest(Stage::state, 0).look_at(at::state::resolved);
  if (linear || (config_.count_bits > 0 && resolved_)) {
    command(number(derived::kCommandOut), 0, width_, of_command);
    line_event(false, true, of_command);
    leave(linear ? all_leaving(line) : before_resolve_, false);
    painted_ = true;
    for (int x = 0; x < width_; ++x) load_back(x, painted(line.pixel(x)));
    return;
  }
  command(number(Kind::RESOLVE), 0, width_, of_command);
  ExpectedEvent& e = newest(Stage::command, 0);
  if (config_.dsf_bits > 0) e.expect(at::command::count, bias_);
  if (config_.count_bits == 0 && config_.dsf_bits > 0) e.expect(at::command::share, shade_);
  const auto background = unpacked_color(background_);
  for (int c = 0; c < config_.channels; ++c)
    e.expect(at::command::color + c, std::uint64_t{background[static_cast<std::size_t>(c)]} << config_.color_frac);
  painted_ = true;
  for (int x = 0; x < width_; ++x) touch(number(Kind::RESOLVE), x, painted(line.pixel(x)), of_pixel);
}

// `line`: nullptr where it is blank.
void ExpectedEvents::end_line(const LineView* line) {
  command(number(Kind::EOL), 0, width_, of_command);
  if (line != nullptr && config_.dsf_bits > 0) {
    ExpectedEvent& e = newest(Stage::command, 0);
    e.expect(at::command::count, painted_ ? 0 : bias_);
  }
  line_event(line == nullptr, false, of_command);
  if (line == nullptr)
    leave({}, true);
  else
    leave(resolved_ && !painted_ && config_.linear_bits == 0 ? before_resolve_ : all_leaving(*line), false);
  eol_token_.emplace_back(token_, nth_);
  ++y_;
  resolved_ = painted_ = false;
  pass_.reset();
  bias_ = 0;
}

void ExpectedEvents::line(int y, std::span<const std::uint8_t> pixels) {
  const std::ptrdiff_t channels = config_.channels;
  for (int x = 0; x < width_; ++x) {
    ExpectedEvent e = event(Stage::out, of_out);
    e.line = y;
    std::tie(e.token, e.nth) = eol_token_[static_cast<std::size_t>(y)];
    e.x = x;
    std::array<std::uint8_t, 3> color{};
    std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(x) * channels, channels, color.begin());
    e.expect(at::out::color, packed_color(color, config_.channels));
    e.expect(at::out::tuser, x == 0 && y == 0 ? 1 : 0);
    e.expect(at::out::tlast, x + 1 == width_ ? 1 : 0);
    put(e);
  }
}

}  // namespace kage::cosim
