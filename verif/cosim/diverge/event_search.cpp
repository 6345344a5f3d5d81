// SPDX-License-Identifier: Apache-2.0
#include "cosim/diverge/event_search.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "contract/derived.hpp"

namespace kage::cosim {
namespace {

// At equal clocks the wiring is to blame first, then small modules, then those that have them within.
int rank(const kage_rtl_event& part) { return static_cast<int>(kParts.at(part.value[at::part::part]).blame); }

/// The kind of the token that the event is of.
Kind event_kind(const kage_rtl_event& token) {
  return kind_of(static_cast<std::uint32_t>(token.value[at::token::words]));
}

/// An error of the RTL where none is to be.
bool raised(const Mismatch& m) {
  return m.expected.stage == Stage::error && m.actual &&
         m.expected.value[at::error::code] == static_cast<std::uint64_t>(ErrorCode::NONE);
}

}  // namespace

EventSearch::EventSearch(const Config& config, std::uint32_t unwatched, Watch watch)
    : watch_(std::move(watch)),
      config_(config),
      expected_(config, unwatched),
      tokens_watched_((unwatched >> static_cast<int>(Stage::token) & 1U) == 0),
      golden_(config),
      seen_(std::numeric_limits<std::uint64_t>::max()) {
  golden_.observe(this);
}

void EventSearch::feed(std::span<const std::uint32_t> words) { golden_.feed(words, sink()); }

void EventSearch::finish() {
  (void)golden_.finish(sink());
  expected_.ended();
  ended_ = true;
}

LineSink EventSearch::sink() {
  return [this](int y, std::span<const std::uint8_t> pixels) { expected_.line(y, pixels); };
}

void EventSearch::header(std::span<const std::uint32_t> words, const LineView& line) {
  const FrameHeader header = FrameHeader::read(words);
  height_ = static_cast<std::uint32_t>(header.height);
  polygons_ = header.level() == Level::polygons;
  expected_.header(words, line);
}

void EventSearch::before(std::uint32_t index, const Token& token, std::span<const std::uint32_t> words,
                         const LineView& line) {
  if (!polygons_) kinds_.push_back(token.kind);
  expected_.before(index, token, words, line);
}

void EventSearch::came(std::uint32_t, const Token& token, std::span<const std::uint32_t>) {
  kinds_.push_back(token.kind);
}

void EventSearch::after(std::uint32_t index, const Token& token, const LineView& line) {
  expected_.after(index, token, line);
}

void EventSearch::failed(const FrameStatus& status, std::span<const std::uint32_t> words, const LineView& line) {
  // At the polygon level a token at fault has come, but for one whose kind the core lacks.
  if (!words.empty() && status.width != 0 && (!polygons_ || kinds_.size() < status.token))
    kinds_.push_back(kind_of(words[0]));
  expected_.failed(status, words, line);
}

void EventSearch::take(std::span<const kage_rtl_event> events) {
  // Units and tree work on a line as soon as its segments are there; its TREE says what they should have made.
  const std::vector<kage_rtl_event> ahead = std::exchange(ahead_, {});
  for (const kage_rtl_event& a : ahead) take(a);
  // Events of a clock have no order. The event of the token that frame_control takes goes first, because the others are
  // held against it.
  for (auto begin = events.begin(); begin != events.end();) {
    const auto end = std::find_if(begin, events.end(), [&](const auto& a) { return a.clock != begin->clock; });
    for (const bool token : {true, false})
      for (auto a = begin; a != end; ++a)
        if ((static_cast<Stage>(a->stage) == Stage::token) == token) take(*a);
    begin = end;
  }
}

void EventSearch::take(const kage_rtl_event& a) {
  const auto stage = static_cast<Stage>(a.stage);
  if (stage == Stage::part) {
    if (watch_) return;
    if (!part_ || (a.clock == part_->clock && rank(a) < rank(*part_))) part_ = a;
    seen_ = std::min(seen_, a.clock);
    return;
  }
  if (stage == Stage::token) {
    ++tokens_;
    token_ = a;
    if (event_kind(a) == Kind::END) at_last_ = a.value[at::token::at_last] != 0;
  }
  if (stopped(a)) return;
  std::deque<ExpectedEvent>& q = expected_.queue(stage, a.unit);
  if (stage == Stage::error && !watch_) {
    take_error(q, a);
    return;
  }
  if (q.empty()) {
    if (expected_.failed() && (stage == Stage::unit || stage == Stage::tree)) return;  // of a line that is dropped
    if (stage == Stage::unit || stage == Stage::tree || stage == Stage::error) {
      // If no TREE comes, the line is dropped with its frame. An END too early is known here before the frame's end.
      ahead_.push_back(a);
      return;
    }
    if (expected_.failed() && stage == Stage::token) return;
    if (stage == Stage::segment) {
      if (expected_.failed() && tokens_ > expected_.failed_at() + 1) return;
      of_token_ = is_token(a);
    }
    if (watch_) return;
    seen_ = std::min(seen_, a.clock);
    if (!unexpected_) {
      unexpected_ = a;
      unexpected_token_ = tokens_ == 0 ? 0 : tokens_ - 1;
    }
    stop(stage, a.unit);
    return;
  }
  if (watch_) watch_(q.front(), a);
  const int value = first_difference(q.front(), a);
  if (value >= 0 && !watch_) {
    if (stage == Stage::segment) of_token_ = is_token(a);
    offer({q.front(), a, value, a.clock});
    stop(stage, a.unit);
    return;
  }
  q.pop_front();
}

bool EventSearch::is_token(const kage_rtl_event& segment) const {
  if (event_kind(token_) != Kind::SEG) return false;
  const Layout layout(config_);
  std::vector<std::uint32_t> words(static_cast<std::size_t>(layout.words[static_cast<std::size_t>(Kind::SEG)]));
  for (std::size_t i = 0; i < words.size(); ++i)
    words[i] = static_cast<std::uint32_t>(token_.value[at::token::words + i / 2] >> i % 2 * 32);
  const SegmentToken s = decode(config_, layout, words).segment;
  const std::uint64_t all = (std::uint64_t{1} << derived::depth_bits(config_)) - 1;
  return segment.unit == s.unit && segment.value[at::segment::z] == (static_cast<std::uint64_t>(s.z) & all) &&
         segment.value[at::segment::dx] == static_cast<std::uint64_t>(s.dx) &&
         segment.value[at::segment::face] == static_cast<std::uint64_t>(s.face);
}

// An error belongs to its token, however early or late it comes.
void EventSearch::take_error(std::deque<ExpectedEvent>& q, const kage_rtl_event& a) {
  const std::uint32_t token = tokens_ == 0 ? 0 : tokens_ - 1;
  if (q.empty() && !ended_ && static_cast<ErrorCode>(a.value[at::error::code]) == ErrorCode::LAST_LATE) {
    ahead_.push_back(a);  // the golden core says so with the frame's end
    return;
  }
  if (q.empty() || token < q.front().nth) {
    again_ = expected_.failed() && q.empty();
    offer({ExpectedEvents::no_error(static_cast<int>(a.value[at::error::line]), token), a, at::error::code, a.clock});
  } else if (token > q.front().nth) {
    offer({q.front(), std::nullopt, -1, a.clock});
  } else {
    const int value = first_difference(q.front(), a);
    if (value >= 0) offer({q.front(), a, value, a.clock});
    q.pop_front();
    if (value < 0) return;
  }
  stop(Stage::error, 0);
}

void EventSearch::offer(const Mismatch& m) {
  seen_ = std::min(seen_, m.clock);
  // After an error that should not be, nothing more comes of its token.
  if (first_ && raised(*first_) && !m.actual && m.expected.nth == first_->expected.nth) return;
  if (first_ && raised(m) && !first_->actual && m.expected.nth == first_->expected.nth) {
    first_ = m;
    return;
  }
  if (!first_ || m.order() < first_->order()) first_ = m;
}

// An event belongs to the newest token or to one before it, so a mismatch of a later token comes behind it. Within one
// token, only the event of the token itself surely comes first.
bool EventSearch::unexpected_leads() const {
  if (!unexpected_ || !first_) return false;
  if (!tokens_watched_) return unexpected_->clock < first_->clock;  // of which token it comes is not known
  const std::uint32_t nth = first_->expected.nth;
  return nth > unexpected_token_ ||
         (nth == unexpected_token_ && static_cast<Stage>(unexpected_->stage) == Stage::token);
}

// Events behind a difference at the same place say nothing more.
void EventSearch::stop(Stage stage, int unit) {
  if (stage != Stage::pixel) {
    stopped_[static_cast<std::size_t>(stage)] = true;
    return;
  }
  stopped_columns_.resize(static_cast<std::size_t>(config_.max_width));
  const auto column = static_cast<std::size_t>(unit);
  if (column < stopped_columns_.size()) stopped_columns_[column] = true;
}

bool EventSearch::stopped(const kage_rtl_event& a) const {
  if (static_cast<Stage>(a.stage) != Stage::pixel) return stopped_[static_cast<std::size_t>(a.stage)];
  const auto column = static_cast<std::size_t>(a.unit);
  return column < stopped_columns_.size() && stopped_columns_[column];
}

void EventSearch::end(std::uint64_t clock, bool blocked) {
  for (const kage_rtl_event& a : ahead_)
    if (static_cast<Stage>(a.stage) == Stage::error && !unexpected_) unexpected_ = a;
  expected_.for_each([&](const std::deque<ExpectedEvent>& q) {
    if (q.front().cares == 0) return;
    const auto stage = static_cast<std::size_t>(q.front().stage);
    if (q.front().stage != Stage::pixel && stopped_[stage]) return;
    if (blocked && first_ && (q.front().stage == Stage::unit || q.front().stage == Stage::tree)) return;
    offer({q.front(), std::nullopt, -1, clock});
  });
}

std::size_t EventSearch::pending() {
  std::size_t sum = 0;
  expected_.for_each([&](const std::deque<ExpectedEvent>& q) {
    if (q.front().stage != Stage::out && q.front().cares != 0) sum += q.size();
  });
  return sum;
}

bool EventSearch::seen_before(std::uint64_t clock, std::uint64_t ago) const {
  return seen_ < clock && clock - seen_ > ago;
}

Clue EventSearch::clue() const {
  Clue c;
  c.at_last = at_last_;
  const auto mismatch = first();
  if (mismatch) {
    c.expected = mismatch->expected;
    c.actual = mismatch->actual;
    c.value = mismatch->value;
  } else {
    c.actual = unexpected_;
    c.value = 0;
  }
  c.again = again_;
  c.of_token = of_token_;
  c.polygons = polygons_;
  const std::uint32_t token = mismatch ? mismatch->expected.token : 0;
  for (std::uint32_t i = 1; i < token && i <= kinds_.size(); ++i) c.lines += kinds_[i - 1] == Kind::EOL ? 1U : 0U;
  c.lines_done = c.lines == height_;
  if (token > 0 && token <= kinds_.size()) c.kind = kinds_[token - 1];
  return c;
}

}  // namespace kage::cosim
