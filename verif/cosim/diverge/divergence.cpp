// SPDX-License-Identifier: Apache-2.0
#include "cosim/diverge/divergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "cosim/diverge/blame.hpp"
#include "cosim/diverge/event_search.hpp"
#include "cosim/diverge/replay.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

// Once something differs, what comes before it in a token's order may still be on its way.
constexpr std::uint64_t kFurther = 20000;

// The golden core goes on where the RTL has lost its thread; what it expects is kept up to 256 MiB.
constexpr std::size_t kMostPending = (std::size_t{256} << 20) / sizeof(ExpectedEvent);

// A divergence that was found is looked for again with this many other initial states.
constexpr std::uint64_t kOtherStates = 2;

struct Found {
  std::optional<Mismatch> mismatch;
  std::optional<kage_rtl_event> unexpected;
  std::optional<kage_rtl_event> part;
  Clue clue;
  int frame = 0;
  std::uint64_t start = 0;  // clock of the frame's first word
  std::uint64_t clock = 0;
  std::string misconduct;
  Handshakes handshakes;
  bool handshakes_known = false;  // their monitor fits the RTL
  bool ports_alone = false;       // nothing within the core is watched, as of a netlist
  bool given_up = false;          // the frame has not ended

  [[nodiscard]] bool any() const { return mismatch || unexpected || part; }
};

// Whether what leaves the core is all that the monitors tell of.
bool only_ports(std::uint32_t unwatched) {
  constexpr std::uint32_t kAll = (1U << (kHandshakeStage + 1)) - 1;
  constexpr std::uint32_t kOut = 1U << static_cast<unsigned>(Stage::out) | 1U << static_cast<unsigned>(Stage::part);
  return (unwatched | kOut) == kAll && (unwatched >> static_cast<unsigned>(Stage::out) & 1U) == 0;
}

// One frame on a core that has seen those before it.
Found search_frame(RtlCore& rtl, int frame, const Feed& feed, const Config& config, const ReplayOptions& options,
                   const Watch& watch) {
  EventSearch search(config, rtl.unwatched(), watch);
  Found found;
  found.frame = frame;
  found.start = rtl.clock();
  const auto take = [&] {
    search.take(rtl.take_events());
    if (options.wait) options.wait();
    if (search.seen_before(rtl.clock(), kFurther)) throw Enough();
  };
  rtl.begin(frame);
  rtl.record(true, take);
  found.handshakes_known = (rtl.unwatched() >> kHandshakeStage & 1U) == 0;
  found.ports_alone = only_ports(rtl.unwatched());
  const auto end = [&] { search.end(rtl.clock(), !found.handshakes_known || rtl.handshakes().waits(Port::tree)); };
  try {
    in_pieces(feed, frame, [&](std::span<const std::uint32_t> piece) {
      search.feed(piece);
      rtl.feed(piece, kNowhere);
      take();
      // A core that stands still with nothing owed is behind what is still to be fed.
      const std::size_t pending = search.pending();
      found.given_up = pending > (rtl.stuck() ? 0 : kMostPending);
      if (found.given_up) throw Enough();
    });
    search.finish();
    found.misconduct = rtl.finish(kNowhere).misconduct;
    search.take(rtl.take_events());
    end();
  } catch (const Enough&) {
    // If the core hangs, ignore what the rest of the frame would have produced.
    if (rtl.stuck()) found.misconduct = rtl.finish(kNowhere).misconduct;
    if (found.given_up) end();
  }
  rtl.record(true);
  found.handshakes = rtl.handshakes();
  found.mismatch = search.first();
  found.unexpected = search.unexpected();
  found.part = search.part();
  if (found.mismatch || found.unexpected) found.clue = search.clue();
  found.clue.dropping = found.handshakes.dropping();
  if (found.mismatch) {
    found.clock = found.mismatch->clock;
  } else if (found.unexpected) {
    found.clock = found.unexpected->clock;
  }
  if (found.part) found.clock = found.part->clock;
  return found;
}

// Whether two searches have seen the same thing at the same time. Values of an event that are not compared may be
// anything.
bool alike(const Found& a, const Found& b) {
  const auto place = [](const std::optional<kage_rtl_event>& e, bool which) {
    return e ? std::tuple(e->stage, e->unit, which ? e->value[at::part::part] : 0, e->clock)
             : std::tuple(-1, 0, std::uint64_t{0}, std::uint64_t{0});
  };
  if (a.frame != b.frame || a.misconduct != b.misconduct || place(a.unexpected, false) != place(b.unexpected, false) ||
      place(a.part, true) != place(b.part, true) || a.mismatch.has_value() != b.mismatch.has_value())
    return false;
  if (!a.mismatch) return true;
  if (a.mismatch->order() != b.mismatch->order() || a.mismatch->value != b.mismatch->value ||
      a.mismatch->clock != b.mismatch->clock || a.mismatch->actual.has_value() != b.mismatch->actual.has_value())
    return false;
  // The values that matter are the same if each is what the other one's would be held against.
  return !a.mismatch->actual || a.mismatch->value < 0 || a.mismatch->value == kUnitValue ||
         a.mismatch->actual->value[a.mismatch->value] == b.mismatch->actual->value[b.mismatch->value];
}

// The first of the frames from .. frame, on one core, in which something differs: a frame may leave the core in a state
// that only a later one shows. `watch` is told of `frame` alone; with it no frame stops at a difference, lest the next
// one go on within it.
Found search(int from, int frame, const Feed& feed, const Config& config, const ReplayOptions& options,
             const Watch& watch = {}) {
  const auto rtl = make_rtl(options.library, config, options.rtl);
  if (!rtl->monitored()) throw Error(fmt::format("{}: a model without monitors", options.library.string()));
  const Watch nothing = watch ? [](const ExpectedEvent&, const kage_rtl_event&) {} : Watch();
  for (int i = from;; i += options.steps.step) {
    Found found = search_frame(*rtl, i, feed, config, options, i == frame ? watch : nothing);
    if (i == frame || found.given_up || (!watch && found.any())) return found;
  }
}

/// The text of a frame's token behind the front end: the golden core hands it out again, so that a search need not keep
/// them all.
class TokenText : private CoreObserver {
 public:
  TokenText(const Config& config, int frame, const Feed& feed, std::uint32_t nth) : config_(config), left_(nth) {
    if (nth == 0) {
      text_ = "header";
      return;
    }
    GoldenCore golden(config);
    golden.observe(this);
    try {
      feed(frame, [&](std::span<const std::uint32_t> words) { golden.feed(words, kNowhere); });
    } catch (const Enough&) {
    }
  }

  /// Empty for a token that the golden core refuses.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void came(std::uint32_t /*index*/, const Token& /*token*/, std::span<const std::uint32_t> words) override {
    came_ = words;
  }

  void before(std::uint32_t /*index*/, const Token& token, std::span<const std::uint32_t> words,
              const LineView& /*line*/) override {
    if (--left_ > 0) return;
    text_ = to_string(config_, token);
    if (!came_.empty() && words.data() != came_.data()) text_ += ", made by the front end";
    throw Enough();
  }

  const Config& config_;
  std::uint32_t left_;                   // tokens up to the one that is told
  std::span<const std::uint32_t> came_;  // at the polygon level: what the front end makes it of
  std::string text_;
};

void describe_mismatch(Divergence& d, const Found& found, const Config& config) {
  const Mismatch& m = *found.mismatch;
  const ExpectedEvent& e = m.expected;
  d.stage = e.stage;
  d.line = e.line;
  d.x = e.x;
  d.token = e.token;
  d.nth = e.nth;
  MismatchText text = describe(config, m);
  d.field = std::move(text.field);
  d.expected = std::move(text.expected);
  d.actual = std::move(text.actual);
}

void describe_unexpected(Divergence& d, const Found& found) {
  d.stage = static_cast<Stage>(found.unexpected->stage);
  d.line = -1;
  d.field = "unexpected";
  d.expected = "nothing";
  d.actual = describe(d.stage);
}

// A module that is wrong by its own inputs is wrong whatever came before it, so its output stands for all that differs.
// Place and token stay as the stages tell them.
void describe_part(Divergence& d, const Config& config, const kage_rtl_event& part) {
  d.stage = Stage::part;
  d.module = part_name(config, part);
  d.field = "output";
  d.expected = fmt::format("{:#x}", part.value[at::part::expected]);
  d.actual = fmt::format("{:#x}", part.value[at::part::actual]);
}

// The divergence of the frame that RtlOptions::prelude puts ahead of this one.
std::optional<Divergence> ahead_of(int frame, const Config& config, const ReplayOptions& options) {
  const Replay alone = replay_ahead(frame, options);
  auto d = find_divergence(frame, alone.feed, config, alone.options);
  if (d) d->ahead = true;
  return d;
}

}  // namespace

std::optional<Divergence> find_divergence(int frame, const Feed& feed, const Config& config,
                                          const ReplayOptions& options) {
  // The state that earlier frames leave in the core comes mostly from the very last one. So the search goes one
  // frame back, then each time twice as many.
  const FrameSteps& steps = options.steps;
  const int before = (frame - steps.first) / steps.step;
  int from = frame;
  Found found = search(from, frame, feed, config, options);
  for (int back = 1; !found.any() && from > steps.first; back *= 2) {
    from = back < before ? frame - back * steps.step : steps.first;
    found = search(from, frame, feed, config, options);
  }
  if (!found.any()) return options.rtl.prelude ? ahead_of(frame, config, options) : std::nullopt;

  Divergence d;
  d.initial_state = options.rtl.initial != 0;  // the run's own has nothing of the kind
  for (std::uint64_t other = 1; other <= kOtherStates && !d.initial_state; ++other) {
    ReplayOptions with_other = options;
    with_other.rtl.initial += other;
    d.initial_state = !alike(found, search(from, found.frame, feed, config, with_other));
  }
  d.frame = found.frame;
  d.from = from;
  d.clock = found.clock;
  d.cycle = found.clock - std::min(found.clock, found.start);
  if (found.mismatch) {
    describe_mismatch(d, found, config);
    d.token_text = TokenText(config, found.frame, feed, d.nth).text();
  } else if (found.unexpected) {
    describe_unexpected(d, found);
  }
  if (found.mismatch || found.unexpected) d.module = found.ports_alone ? "kage_top" : blame(config, found.clue);
  // A stage without a handshake waits for nobody. Where the handshakes' monitor does not fit, it is not known who
  // waits.
  const bool waits = found.handshakes_known && d.stage != Stage::claim && d.stage != Stage::error &&
                     d.stage != Stage::face && d.stage != Stage::table && d.stage != Stage::state &&
                     d.stage != Stage::end;
  if (!found.misconduct.empty() && waits && (d.field == "missing" || !found.mismatch)) {
    const Waiting w = waiting(config, found.handshakes);
    d.waits = w.text;
    // Pixels that have no place to go to wait within.
    const bool exit_free = found.handshakes.ready(Port::exit);
    if (w.module.empty() && d.stage == Stage::exit && !exit_free) d.module = "line_out";
    if (!w.module.empty() && !(w.lacks_line && d.stage == Stage::line)) d.module = w.module;
  }
  if (found.part) describe_part(d, config, *found.part);
  d.what = describe(d.stage);
  return d;
}

std::string RtlTouch::text() const {
  std::string text;
  for (const Value& v : values)
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", v.text,
                        v.golden.empty() ? "" : fmt::format(" (golden {})", v.golden));
  return text;
}

std::vector<RtlTouch> watch_pixel(int from, int frame, const Feed& feed, const Config& config,
                                  const ReplayOptions& options, int x, int y) {
  std::vector<RtlTouch> touches;
  const auto watch = [&](const ExpectedEvent& e, const kage_rtl_event& a) {
    const bool seen = e.stage == Stage::pixel || e.stage == Stage::exit || e.stage == Stage::out;
    if (!seen || e.x != x || e.line != y) return;
    RtlTouch t;
    t.token = e.token;
    t.nth = e.nth;
    t.stage = e.stage;
    t.load = e.load;
    t.cycle = a.clock;
    t.same = first_difference(e, a) < 0;
    // A pixel's state comes behind what was brought to it.
    for (int i = e.stage == Stage::pixel ? at::pixel::z : 0; i < KAGE_RTL_EVENT_VALUES; ++i)
      if ((e.cares >> i & 1U) != 0)
        t.values.push_back(
            {fmt::format("{} {}", value_name(e.stage, i), value_text(config, e.stage, i, a.value[i])),
             differs(e, a, i) ? value_text(config, e.stage, i, e.value[static_cast<std::size_t>(i)]) : std::string()});
    touches.push_back(std::move(t));
    if (e.stage == Stage::out) throw Enough();  // it has left
  };
  const Found found = search(from, frame, feed, config, options, watch);
  for (RtlTouch& t : touches) t.cycle -= std::min(t.cycle, found.start);
  return touches;
}

std::string describe(const Divergence& d) {
  std::string text = fmt::format("{}frame {}", d.ahead ? "the frame right ahead of " : "", d.frame);
  if (d.line >= 0) text += fmt::format(", line {}", d.line);
  if (d.x >= 0) text += fmt::format(", x {}", d.x);
  text += fmt::format(", cycle {}: {} (rtl/{}.sv), {}: expected {}, got {}", d.cycle, d.what, d.module, d.field,
                      d.expected, d.actual);
  if (!d.token_text.empty()) text += fmt::format("; token {}: {}", d.token, d.token_text);
  if (!d.source.empty()) text += ", from " + d.source;
  if (!d.waits.empty()) text += "; " + d.waits;
  if (d.initial_state) text += "; depends on the initial state of registers and memories";
  return text;
}

std::string describe_none(const Difference& difference) {
  if (difference.before == Before::frame)
    return "no stage differs where the frame ahead has ended before: it takes both in the core at the same time";
  return difference.assertion.empty() ? "no stage differs: look at the registers and the video port"
                                      : "no stage differs: look at what the assertion guards";
}

}  // namespace kage::cosim
