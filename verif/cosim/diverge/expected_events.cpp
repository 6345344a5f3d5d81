// SPDX-License-Identifier: Apache-2.0
#include "cosim/diverge/expected_events.hpp"

#include <algorithm>
#include <optional>

#include "contract/derived.hpp"
#include "contract/kinds.hpp"
#include "kernels/span_value.hpp"
#include "number/packed_color.hpp"

namespace kage::cosim {

ExpectedEvents::ExpectedEvents(const Config& config, std::uint32_t unwatched)
    : config_(config),
      unwatched_(unwatched),
      depth_bits_(derived::depth_bits(config)),
      ramp_bits_(derived::ramp_bits(config)) {
  for (auto& q : queues_) q.resize(1);
  queues_[static_cast<std::size_t>(Stage::unit)].resize(static_cast<std::size_t>(std::max(config.units, 1)));
  queues_[static_cast<std::size_t>(Stage::pixel)].resize(static_cast<std::size_t>(config.max_width));
}

std::deque<ExpectedEvent>& ExpectedEvents::queue(Stage stage, int unit) {
  auto& queues = queues_[static_cast<std::size_t>(stage)];
  const auto i = static_cast<std::size_t>(unit);
  return queues[stage == Stage::unit || stage == Stage::pixel ? std::min(i, queues.size() - 1) : 0];
}

ExpectedEvent ExpectedEvents::event(Stage stage, int step) const {
  ExpectedEvent e;
  e.stage = stage;
  e.line = y_;
  e.token = token_;
  e.nth = nth_;
  e.step = step;
  return e;
}

ExpectedEvent ExpectedEvents::no_error(int line, std::uint32_t token) {
  ExpectedEvent e;
  e.stage = Stage::error;
  e.line = line;
  e.token = e.nth = token;
  e.step = of_control;
  e.look_at(at::error::code);
  return e;
}

void ExpectedEvents::put(ExpectedEvent e) {
  if (watched(e.stage)) queue(e.stage, e.unit).push_back(e);
}

ExpectedEvent& ExpectedEvents::newest(Stage stage, int unit) {
  return watched(stage) ? queue(stage, unit).back() : nowhere_;
}

// Two words a value, the first in the lower half.
void ExpectedEvents::token_words(std::span<const std::uint32_t> words, bool final) {
  ExpectedEvent e = event(Stage::token, of_token);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t place = at::token::words + i / 2;
    e.expect(static_cast<int>(place), e.value[place] | std::uint64_t{words[i]} << (i % 2 * 32));
  }
  if (words.size() % 2 != 0) {
    e.masked = at::token::words + static_cast<int>(words.size() / 2);
    e.mask = 0xFFFFFFFFU;
  }
  e.expect(at::token::flags, (token_ == 0 ? flag::header : 0) | (final ? flag::final_word : 0));
  put(e);
}

// A token that is refused: its words may not be there, but what token_reader says of them is known.
void ExpectedEvents::wrong_token(ErrorCode code, bool header, std::span<const std::uint32_t> words) {
  ExpectedEvent e = event(Stage::token, of_token);
  e.token = header ? 0 : token_ + 1;
  e.nth = header ? 0 : nth_ + 1;
  const bool cut = code == ErrorCode::LAST_EARLY;
  const bool end = !header && !words.empty() && kind_of(words[0]) == Kind::END;
  e.expect(at::token::flags, (header ? flag::header : 0) | (code == ErrorCode::KIND ? flag::lacking : 0) |
                                 (cut ? flag::cut : 0) | (cut || end ? flag::final_word : 0) |
                                 (code == ErrorCode::PLACE || code == ErrorCode::ACTIVE_FULL ? flag::fault : 0));
  put(e);
}

void ExpectedEvents::header(std::span<const std::uint32_t> words, const LineView& line) {
  for (auto& queues : queues_)
    for (auto& q : queues) q.clear();
  failed_ = false;
  width_ = line.width();
  const FrameHeader h = FrameHeader::read(words);
  height_ = h.height;
  y_ = 0;
  token_ = nth_ = 0;
  eol_token_.clear();
  background_ = low(h.background, derived::rgb_bits(config_));
  shade_ = 0;
  given_.assign(static_cast<std::size_t>(config_.units), 0);
  resolved_ = painted_ = false;
  pass_.reset();
  bias_ = 0;
  token_words(words, false);
}

// A colour as pixels hold it.
std::uint64_t ExpectedEvents::held(const std::array<std::uint16_t, 3>& color) const {
  return packed_levels(color, derived::pixel_level_bits(config_), config_.channels);
}

void ExpectedEvents::command(int kind, int xl, int xr, int step) {
  ExpectedEvent e = event(Stage::command, step);
  e.expect(at::command::kind, static_cast<std::uint64_t>(kind));
  e.expect(at::command::xl, static_cast<std::uint64_t>(xl));
  e.expect(at::command::xr, static_cast<std::uint64_t>(xr));
  put(e);
}

// None for an empty range.
void ExpectedEvents::span_command(const Token& t, const LineView& line) {
  const SpanToken& s = t.span;
  if (s.xl == s.xr) return;
  command(kind_of_command(t.kind), s.xl, s.xr, of_command);
  ExpectedEvent& e = newest(Stage::command, 0);
  using namespace at::command;
  switch (t.kind) {
    case Kind::OP:
      if (config_.linear_bits == 0)
        e.expect(count, config_.dsf_bits > 0 ? static_cast<std::uint64_t>(s.normal_class) : 0);
      else if (pass_)
        e.expect(count, *pass_);
      break;
    case Kind::SP:
    case Kind::NC:
      e.expect(count, low(s.w, derived::dsf_bus_bits(config_)));
      break;
    case Kind::EV:
      e.expect(count, line.bias());
      break;
    case Kind::ES:
      e.expect(count,
               (config_.lights > 1 ? static_cast<std::uint64_t>(t.table.light) << derived::light_at(config_) : 0) |
                   (config_.fsf != 0 ? 0 : line.bias()));
      break;
    default:
      e.expect(share, static_cast<std::uint64_t>(s.alpha));
      break;
  }
  // ES and, with several lights, nothing else of its count: FSF leaves the low bits open.
  if (info_of(t.kind).depth) {
    e.expect(z, low(s.z, depth_bits_));
    e.expect(dz, low(s.dz, depth_bits_));
  }
  if (!info_of(t.kind).color) return;
  for (int c = 0; c < config_.channels; ++c) {
    e.expect(color + c, low(s.color[static_cast<std::size_t>(c)], ramp_bits_));
    if (config_.smooth != 0) e.expect(dcolor + c, low(s.dcolor[static_cast<std::size_t>(c)], ramp_bits_));
  }
}

int ExpectedEvents::kind_of_command(Kind kind) const {
  return kind == Kind::OP && pass_ ? number(derived::kCommandLight) : number(kind);
}

void ExpectedEvents::touch(int kind, int x, const PixelState& after, int step) {
  ExpectedEvent e = event(Stage::pixel, step);
  e.unit = e.x = x;
  std::uint64_t counts = 0;
  for (int l = 0; l < config_.lights && config_.count_bits > 0; ++l)
    counts |= std::uint64_t{after.counts[static_cast<std::size_t>(l)]} << l * config_.count_bits;
  e.expect(at::pixel::kind, static_cast<std::uint64_t>(kind));
  e.expect(at::pixel::z, after.z);
  e.expect(at::pixel::color, held(after.color));
  e.expect(at::pixel::normal_class, config_.dsf_bits > 0 ? after.normal_class : 0);
  e.expect(at::pixel::counts, counts);
  if (config_.linear_bits > 0) e.expect(at::pixel::served, after.served);
  if (!painted_ || !derived::has_loads(config_)) {  // nobody asks for the flags of a line that has come back
    e.expect(at::pixel::dsf, after.dsf);
    e.expect(at::pixel::fsf, after.fsf);
  }
  // A pixel without surface has a colour from the line's RESOLVE on; before, nobody asks for it.
  if (clear(after) && !painted_) e.ignore(at::pixel::color);
  put(e);
}

void ExpectedEvents::table_event(const TableToken& t) {
  ExpectedEvent e = event(Stage::table, of_control);
  e.expect(at::table::normal_class, static_cast<std::uint64_t>(t.normal_class));
  e.expect(at::table::light, static_cast<std::uint64_t>(t.light));
  for (int c = 0; c < 3; ++c)  // channels that there are not are told as 0
    e.expect(at::table::share + c, c < config_.channels ? t.share[static_cast<std::size_t>(c)] : 0);
  put(e);
}

void ExpectedEvents::face_event(const SegmentToken& f) {
  ExpectedEvent e = event(Stage::face, of_control);
  e.unit = f.unit;
  e.expect(at::face::face, static_cast<std::uint64_t>(f.face));
  e.expect(at::face::index, static_cast<std::uint64_t>(f.index));
  e.expect(at::face::normal_class, config_.dsf_bits > 0 ? static_cast<std::uint64_t>(f.normal_class) : 0);
  e.expect(at::face::dz, low(f.dz, depth_bits_));
  e.expect(at::face::color, packed_levels(f.color, derived::pixel_level_bits(config_), config_.channels));
  put(e);
}

void ExpectedEvents::segment_event(const SegmentToken& s) {
  ExpectedEvent e = event(Stage::segment, of_control);
  e.unit = s.unit;
  if (s.face != derived::blank_face(config_)) e.expect(at::segment::z, low(s.z, derived::segment_depth_bits(config_)));
  e.expect(at::segment::dx, static_cast<std::uint64_t>(s.dx));
  e.expect(at::segment::face, static_cast<std::uint64_t>(s.face));
  int& given = given_[static_cast<std::size_t>(s.unit)];
  given += s.dx;
  e.expect(at::segment::completes, given == width_ ? 1 : 0);
  if (given == width_) given = 0;
  put(e);
}

void ExpectedEvents::before(std::uint32_t index, const Token& t, std::span<const std::uint32_t> words,
                            const LineView& line) {
  token_ = index;
  ++nth_;
  token_words(words, t.kind == Kind::END);
  switch (t.kind) {
    case Kind::SHADE:
      shade_ = t.shade;
      break;
    case Kind::TABLE:
      table_event(t.table);
      break;
    case Kind::FACE:
      face_event(t.segment);
      break;
    case Kind::SEG:
      if (line.segment_taken()) segment_event(t.segment);
      break;
    case Kind::TREE:
      put(event(Stage::claim, of_control));
      newest(Stage::claim, 0).look_at(0);  // it has no values: that it comes matters
      break;
    case Kind::RESOLVE:
      bias_ = line.bias();
      if (config_.linear_bits > 0)
        pass_ = (config_.count_bits > 0 ? static_cast<std::uint64_t>(t.samples) : bias_) << 1 |
                ((pass_.value_or(0) & 1U) ^ 1U);
      else
        before_resolve_ = all_leaving(line);
      resolved_ = true;
      break;
    case Kind::TP:
      if (!resolved_ || config_.linear_bits > 0) bias_ = line.bias();
      if (!painted_) paint(line);
      span_command(t, line);
      break;
    case Kind::EOL:
      if (!resolved_ || config_.linear_bits > 0) bias_ = line.bias();
      state(bias_, !painted_);
      end_line(&line);
      break;
    default:
      if (info_of(t.kind).weight) resolved_ = false;
      if (info_of(t.kind).ends) state(line.bias(), t.kind == Kind::EV || config_.fsf == 0);
      if (info_of(t.kind).range) span_command(t, line);
  }
}

// Adds the depth and colour that a pixel had to be compared with to its event that was put() last.
void ExpectedEvents::came_to_pixel(int x, std::optional<std::uint64_t> z, std::optional<std::uint64_t> color) {
  ExpectedEvent& e = newest(Stage::pixel, x);
  if (z) e.expect(at::pixel::z_came, *z);
  if (color) e.expect(at::pixel::color_came, *color);
}

// Expected events of the units and the tree for a line's pixels, each in turn, and the pixels' states after them.
void ExpectedEvents::tree_events(const LineView& line) {
  command(number(Kind::TREE), 0, width_, of_command);
  const std::uint64_t clear = derived::clear_depth(config_);
  for (int x = 0; x < width_; ++x) {
    for (int u = 0; u < config_.units; ++u) {
      const auto p = line.unit_pixel(u, x);
      ExpectedEvent e = event(Stage::unit, of_unit);
      e.unit = u;
      e.x = x;
      e.expect(at::unit::z, p.z);
      if (p.z != clear) {
        e.expect(at::unit::index, p.index);
        e.expect(at::unit::color, held(p.color));
        e.expect(at::unit::normal_class, config_.dsf_bits > 0 ? p.normal_class : 0);
      }
      put(e);
    }
    const auto p = line.tree_pixel(x);
    ExpectedEvent e = event(Stage::tree, of_tree);
    e.x = x;
    e.expect(at::tree::z, p.z);
    if (p.z != clear) {
      e.expect(at::tree::color, held(p.color));
      e.expect(at::tree::normal_class, config_.dsf_bits > 0 ? p.normal_class : 0);
    }
    put(e);
    touch(number(Kind::TREE), x, line.pixel(x), of_pixel);
    came_to_pixel(x, p.z, p.z == clear ? std::nullopt : std::optional(held(p.color)));
  }
}

void ExpectedEvents::after(std::uint32_t /*index*/, const Token& t, const LineView& line) {
  const SpanToken& s = t.span;
  switch (t.kind) {
    case Kind::TREE:
      tree_events(line);
      break;
    default: {
      const KindInfo& info = info_of(t.kind);
      if (!info.range) break;
      for (int x = s.xl; x < s.xr; ++x) {
        touch(kind_of_command(t.kind), x, line.pixel(x), of_pixel);
        came_to_pixel(x, info.depth ? std::optional<std::uint64_t>(span_depth(config_, s, x)) : std::nullopt,
                      info.color ? std::optional(held(span_color(config_, s, x, t.kind == Kind::TP))) : std::nullopt);
      }
    }
  }
}

void ExpectedEvents::failed(const FrameStatus& status, std::span<const std::uint32_t> words, const LineView& /*line*/) {
  failed_ = true;
  if (status.width == 0) {  // nothing of the frame before is left
    token_ = nth_ = 0;
    y_ = 0;
  }
  if (status.error != ErrorCode::LAST_LATE) wrong_token(status.error, status.width == 0, words);
  ExpectedEvent e = event(Stage::error, of_control);
  // Where it shows: the token that is to blame may have come before.
  const std::uint32_t on = status.width == 0 || status.error == ErrorCode::LAST_LATE ? 0 : 1;
  e.token = token_ + on;
  e.nth = failed_at_ = nth_ + on;
  e.expect(at::error::code, static_cast<std::uint64_t>(status.error));
  e.expect(at::error::frame, status.frame);
  e.expect(at::error::line, status.line);
  e.expect(at::error::token, status.token);
  e.expect(at::error::unit, status.unit);
  put(e);
  if (status.width == 0) return;
  token_ = e.token;
  nth_ = e.nth;
  // The line at hand and all others leave as background.
  while (y_ < height_) end_line(nullptr);
}

void ExpectedEvents::ended() {
  put(event(Stage::end, of_end));
  newest(Stage::end, 0).look_at(0);
}

}  // namespace kage::cosim
