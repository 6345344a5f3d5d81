// SPDX-License-Identifier: Apache-2.0
#include "cosim/divergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "cosim/blame.hpp"
#include "cosim/expected_events.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

// Words given to both at a time: what the golden core is ahead is kept as events, some hundred bytes a pixel.
constexpr std::size_t kPiece = 512;
// Once something differs, what comes before it in a token's order may still be on its way.
constexpr std::uint64_t kFurther = 20000;

/// An event that is not what was expected, or that never came.
struct Mismatch {
  ExpectedEvent expected;
  std::optional<kage_rtl_event> actual;
  int value = -1;  ///< the first that differs; -1: missing
  std::uint64_t clock = 0;

  [[nodiscard]] auto order() const { return std::tuple(expected.token, expected.line, expected.step, expected.x); }
};

// The first value that matters and differs, or -1.
int first_difference(const ExpectedEvent& e, const kage_rtl_event& a) {
  for (int i = 0; i < KAGE_RTL_EVENT_VALUES; ++i) {
    if ((e.cares >> i & 1U) == 0) continue;
    const auto at = static_cast<std::size_t>(i);
    const bool unseen = e.stage == Stage::pixel && (i == 1 || i == 2) && a.value[i] == ~std::uint64_t{0};
    if (!unseen && ((e.value[at] ^ a.value[i]) & (i == e.masked ? e.mask : ~std::uint64_t{0})) != 0) return i;
  }
  if (e.stage == Stage::exit) return e.unit != a.unit ? 0 : -1;
  return e.stage != Stage::pixel && e.unit > 0 && e.unit != a.unit ? 0 : -1;
}

/// Told of each event and what was expected in its place.
using Watch = std::function<void(const ExpectedEvent&, const kage_rtl_event&)>;

/// Holds a frame's events against each other as they come.
class Search : public CoreObserver {
 public:
  /// With `watch`, nothing stops at a difference.
  explicit Search(const Config& config, Watch watch = {})
      : watch_(std::move(watch)), config_(config), expected_(config), golden_(config) {
    golden_.observe(this);
  }

  // What the golden core does.
  void header(std::span<const std::uint32_t> words, const LineView& line) override {
    height_ = words[1] >> 16;
    expected_.header(words, line);
  }
  void before(std::uint32_t index, const Token& token, std::span<const std::uint32_t> words,
              const LineView& line) override {
    texts_.push_back(to_string(config_, token));
    kinds_.push_back(token.kind);
    expected_.before(index, token, words, line);
  }
  void after(std::uint32_t index, const Token& token, const LineView& line) override {
    expected_.after(index, token, line);
  }
  void failed(const FrameStatus& status, std::span<const std::uint32_t> words, const LineView& line) override {
    if (!words.empty() && status.width != 0) kinds_.push_back(static_cast<Kind>(words[0] & 15U));
    expected_.failed(status, words, line);
  }

  void feed(std::span<const std::uint32_t> words) { golden_.feed(words, sink()); }
  void finish() {
    (void)golden_.finish(sink());
    expected_.ended();
    ended_ = true;
  }

  // What the RTL does.
  void take(std::span<const kage_rtl_event> events) {
    // Units and tree work on a line as soon as its segments are there; its TREE says what they should have made.
    const std::vector<kage_rtl_event> ahead = std::exchange(ahead_, {});
    for (const kage_rtl_event& a : ahead) take(a);
    for (const kage_rtl_event& a : events) take(a);
  }

  /// Nothing more will come: what is still expected is missing. What waits for the pixels to take it (`blocked`) would
  /// have come; it is they who differ.
  void end(std::uint64_t clock, bool blocked) {
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

  [[nodiscard]] const std::optional<Mismatch>& first() const { return first_; }
  [[nodiscard]] const std::optional<kage_rtl_event>& unexpected() const { return unexpected_; }
  /// Whether something differed more than so many clocks ago.
  [[nodiscard]] bool seen_before(std::uint64_t clock, std::uint64_t ago) const {
    return seen_ < clock && clock - seen_ > ago;
  }
  /// The first small module that broke its own contract.
  [[nodiscard]] const std::optional<kage_rtl_event>& part() const { return part_; }
  [[nodiscard]] Clue clue() const {
    Clue c;
    c.at_last = at_last_;
    if (first_) {
      c.expected = first_->expected;
      c.actual = first_->actual;
      c.value = first_->value;
    } else {
      c.actual = unexpected_;
      c.value = 0;
    }
    c.again = again_;
    c.of_token = of_token_;
    const std::uint32_t token = first_ ? first_->expected.token : 0;
    for (std::uint32_t i = 1; i < token && i <= kinds_.size(); ++i) c.lines += kinds_[i - 1] == Kind::EOL ? 1U : 0U;
    c.lines_done = c.lines == height_;
    if (token > 0 && token <= kinds_.size()) c.kind = kinds_[token - 1];
    return c;
  }
  [[nodiscard]] std::string token_text(std::uint32_t index) const {
    if (index == 0) return "header";
    return index <= texts_.size() ? texts_[index - 1] : "";
  }

 private:
  LineSink sink() {
    return [this](int y, std::span<const std::uint8_t> pixels) { expected_.line(y, pixels); };
  }

  void offer(const Mismatch& m) {
    seen_ = std::min(seen_, m.clock);
    if (!first_ || m.order() < first_->order()) first_ = m;
  }

  void take(const kage_rtl_event& a) {
    const auto stage = static_cast<Stage>(a.stage);
    if (stage == Stage::part) {
      if (!part_ || (a.clock == part_->clock && rank(a) < rank(*part_))) part_ = a;
      seen_ = std::min(seen_, a.clock);
      return;
    }
    if (stage == Stage::token) {
      ++tokens_;
      token_ = a;
      if (static_cast<Kind>(a.value[0] & 15U) == Kind::END) at_last_ = a.value[11] != 0;
    }
    if (stopped_[static_cast<std::size_t>(a.stage)]) return;
    std::deque<ExpectedEvent>& q = expected_.queue(stage, a.unit);
    if (stage == Stage::pixel && stopped_columns_.size() > static_cast<std::size_t>(a.unit) &&
        stopped_columns_[static_cast<std::size_t>(a.unit)])
      return;
    if (stage == Stage::error && !watch_) {
      take_error(q, a);
      return;
    }
    if (q.empty()) {
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
      seen_ = std::min(seen_, a.clock);
      if (!unexpected_) unexpected_ = a;
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

  // Of parts that are wrong in the same clock: wires come before what is given wrong by them, small modules before
  // those that have them within.
  static int rank(const kage_rtl_event& part) {
    if (part.value[0] == KAGE_PART_TOP || part.value[0] == KAGE_PART_PIXEL_CORE) return 0;
    return part.value[0] <= KAGE_PART_LANE_RAMP ? 1 : 2;
  }

  // Whether a segment is what frame_control's token has.
  [[nodiscard]] bool is_token(const kage_rtl_event& segment) const {
    const Layout layout(config_);
    std::vector<std::uint32_t> words(static_cast<std::size_t>(layout.words[static_cast<std::size_t>(Kind::SEG)]));
    for (std::size_t i = 0; i < words.size(); ++i)
      words[i] = static_cast<std::uint32_t>(token_.value[i / 2] >> i % 2 * 32);
    if (static_cast<Kind>(token_.value[0] & 15U) != Kind::SEG) return false;
    const SegmentToken s = decode(config_, layout, words).segment;
    const std::uint64_t all = (std::uint64_t{1} << (config_.z_bits + config_.z_frac + 2)) - 1;
    return segment.unit == s.unit && segment.value[0] == (static_cast<std::uint64_t>(s.z) & all) &&
           segment.value[1] == static_cast<std::uint64_t>(s.dx) &&
           segment.value[2] == static_cast<std::uint64_t>(s.face);
  }

  // An error belongs to its token, however early or late it comes.
  void take_error(std::deque<ExpectedEvent>& q, const kage_rtl_event& a) {
    const std::uint32_t token = tokens_ == 0 ? 0 : tokens_ - 1;
    if (q.empty() && !ended_ && static_cast<ErrorCode>(a.value[0]) == ErrorCode::LAST_LATE) {
      ahead_.push_back(a);  // the golden core says so with the frame's end
      return;
    }
    if (q.empty() || token < q.front().token) {
      again_ = expected_.failed() && q.empty();
      offer({ExpectedEvents::no_error(static_cast<int>(a.value[2]), token), a, 0, a.clock});
    } else if (token > q.front().token) {
      offer({q.front(), std::nullopt, -1, a.clock});
    } else {
      const int value = first_difference(q.front(), a);
      if (value >= 0) offer({q.front(), a, value, a.clock});
      q.pop_front();
      if (value < 0) return;
    }
    stop(Stage::error, 0);
  }

  // What comes behind a difference at its place says nothing more.
  void stop(Stage stage, int unit) {
    if (stage != Stage::pixel) {
      stopped_[static_cast<std::size_t>(stage)] = true;
      return;
    }
    stopped_columns_.resize(static_cast<std::size_t>(config_.max_width));
    if (static_cast<std::size_t>(unit) < stopped_columns_.size())
      stopped_columns_[static_cast<std::size_t>(unit)] = true;
  }

  Watch watch_;
  Config config_;
  ExpectedEvents expected_;
  GoldenCore golden_;
  std::vector<std::string> texts_;  // of each token but the header
  std::vector<Kind> kinds_;         // likewise, with that of the token that is wrong
  std::array<bool, kStages> stopped_{};
  std::vector<bool> stopped_columns_;
  std::optional<Mismatch> first_;
  std::optional<kage_rtl_event> unexpected_;
  std::optional<kage_rtl_event> part_;
  std::uint32_t tokens_ = 0;  // that the RTL's frame_control has taken
  std::uint32_t height_ = 0;
  bool ended_ = false;
  bool again_ = false;      // as in Clue
  bool of_token_ = false;   // likewise
  kage_rtl_event token_{};  // the last that came
  bool at_last_ = false;    // what token_reader said of END
  std::vector<kage_rtl_event> ahead_;
  std::uint64_t seen_ = std::numeric_limits<std::uint64_t>::max();
};

/// Thrown through a feed once enough has been seen.
struct Enough {};

struct Found {
  std::optional<Mismatch> mismatch;
  std::optional<kage_rtl_event> unexpected;
  std::optional<kage_rtl_event> part;
  Clue clue;
  std::string token_text;
  int frame = 0;
  std::uint64_t start = 0;  // clock of the frame's first word
  std::uint64_t clock = 0;
  std::string misconduct;
  std::uint32_t handshakes = 0;

  [[nodiscard]] bool any() const { return mismatch || unexpected || part; }
};

const LineSink kNowhere = [](int, std::span<const std::uint8_t>) {};

// Hands a frame on in pieces of a size that both sides can keep events for.
template <class Take>
void in_pieces(const Feed& feed, int frame, Take take) {
  feed(frame, [&](std::span<const std::uint32_t> words) {
    for (; !words.empty(); words = words.subspan(std::min(words.size(), kPiece)))
      take(words.first(std::min(words.size(), kPiece)));
  });
}

void run_through(RtlCore& rtl, int from, int to, const Feed& feed, const DivergenceOptions& options) {
  for (int i = from; i < to; i += options.steps.step) {
    if (options.wait) options.wait();
    feed(i, [&](std::span<const std::uint32_t> words) { rtl.feed(words, kNowhere); });
    (void)rtl.finish(kNowhere);
  }
}

// One frame on a core that has seen those before it.
Found search_frame(RtlCore& rtl, int frame, const Feed& feed, const Config& config, const DivergenceOptions& options,
                   const Watch& watch) {
  Search search(config, watch);
  Found found;
  found.frame = frame;
  found.start = rtl.clock();
  try {
    in_pieces(feed, frame, [&](std::span<const std::uint32_t> piece) {
      search.feed(piece);
      rtl.feed(piece, kNowhere);
      search.take(rtl.take_events());
      if (options.wait) options.wait();
      if (search.seen_before(rtl.clock(), kFurther)) throw Enough();
    });
    search.finish();
    found.misconduct = rtl.finish(kNowhere).misconduct;
    search.take(rtl.take_events());
    search.end(rtl.clock(), (rtl.handshakes() >> 4 & 3U) == 2);
  } catch (const Enough&) {
  }
  found.handshakes = rtl.handshakes();
  found.mismatch = search.first();
  found.unexpected = search.unexpected();
  found.part = search.part();
  if (found.mismatch || found.unexpected) found.clue = search.clue();
  found.clue.dropping = (found.handshakes >> 22 & 1U) != 0;
  if (found.mismatch) {
    found.clock = found.mismatch->clock;
    found.token_text = search.token_text(found.mismatch->expected.token);
  } else if (found.unexpected) {
    found.clock = found.unexpected->clock;
  }
  if (found.part) found.clock = found.part->clock;
  return found;
}

// The first of the frames from .. frame, on one core, in which something differs: a frame may leave the core in a state
// that only a later one shows. `watch` is told of `frame` alone.
Found search(int from, int frame, const Feed& feed, const Config& config, const DivergenceOptions& options,
             const Watch& watch = {}) {
  const auto rtl = make_rtl(options.library, config, options.rtl);
  if (!rtl->traced()) throw Error(fmt::format("{}: a model without monitors", options.library.string()));
  rtl->record(true);
  for (int i = from;; i += options.steps.step) {
    Found found = search_frame(*rtl, i, feed, config, options, i == frame ? watch : Watch());
    if (i == frame || found.any()) return found;
  }
}

// The scopes and nets that GTKWave opens with.
void write_save_file(const std::filesystem::path& path, const std::filesystem::path& wave, const Config& config,
                     std::uint64_t clock) {
  std::string text =
      fmt::format("[dumpfile] \"{}\"\n[timestart] {}\n*-4.0 {}\n", std::filesystem::absolute(wave).string(),
                  clock > 20 ? 2 * (clock - 20) : 0, 2 * clock + 1);
  const auto group = [&](const char* name, std::initializer_list<const char*> nets) {
    text += fmt::format("@200\n-{}\n@28\n", name);
    for (const char* net : nets) text += fmt::format("TOP.kage_top.{}\n", net);
  };
  group("clock", {"clk_i", "rst_ni"});
  group("token_reader to frame_control", {"token_valid", "token_ready", "token_header"});
  group("frame_control to pixels", {"cmd_valid", "cmd_ready", "cmd_kind", "cmd_xl", "cmd_xr", "cmd_z", "cmd_dz"});
  if (config.units > 0) group("tree", {"tree_valid", "tree_ready", "tree_z", "tree_last"});
  group("pixels to line_out", {"exit_valid", "exit_last", "exit_data"});
  group("lines", {"line_valid", "line_ready", "queue_valid", "queue_ready"});
  group("video", {"m_axis_tvalid_o", "m_axis_tready_i", "m_axis_tdata_o", "m_axis_tuser_o", "m_axis_tlast_o"});
  std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "w"), std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size())
    throw Error(fmt::format("{}: cannot be written", path.string()));
}

void write_wave(int from, int frame, const Feed& feed, const Config& config, const DivergenceOptions& options,
                std::uint64_t clock) {
  const auto rtl = make_rtl(options.library, config, options.rtl);
  rtl->wave(options.waveform, clock > options.before ? clock - options.before : 0, clock + options.after);
  run_through(*rtl, from, frame, feed, options);
  try {
    in_pieces(feed, frame, [&](std::span<const std::uint32_t> piece) {
      rtl->feed(piece, kNowhere);
      if (rtl->clock() > clock + options.after) throw Enough();
    });
    (void)rtl->finish(kNowhere);
  } catch (const Enough&) {
  }
}

void describe_mismatch(Divergence& d, const Found& found, const Config& config) {
  const Mismatch& m = *found.mismatch;
  const ExpectedEvent& e = m.expected;
  d.stage = e.stage;
  d.line = e.line;
  d.x = e.x;
  d.token = e.token;
  d.token_text = found.token_text;
  if (!m.actual) {
    d.field = "missing";
    d.expected =
        e.stage == Stage::command ? value_text(config, e.stage, 0, e.value[0]) : std::string(describe(e.stage));
    d.actual = "nothing";
    return;
  }
  d.field = value_name(e.stage, m.value);
  d.expected = value_text(config, e.stage, m.value, e.value[static_cast<std::size_t>(m.value)]);
  d.actual = value_text(config, e.stage, m.value, m.actual->value[m.value]);
}

void describe_unexpected(Divergence& d, const Found& found) {
  d.stage = static_cast<Stage>(found.unexpected->stage);
  d.line = -1;
  d.field = "unexpected";
  d.expected = "nothing";
  d.actual = describe(d.stage);
}

// What is wrong by its own inputs is wrong whatever came before it, so it stands for all that differs; what the stages
// say of place and token remains.
void describe_part(Divergence& d, const Config& config, const kage_rtl_event& part) {
  d.stage = Stage::part;
  d.module = part_name(config, part);
  d.field = "output";
  d.expected = fmt::format("{:#x}", part.value[1]);
  d.actual = fmt::format("{:#x}", part.value[2]);
}

}  // namespace

std::optional<Divergence> find_divergence(int frame, const Feed& feed, const Config& config,
                                          const DivergenceOptions& options) {
  int from = frame;
  Found found = search(from, frame, feed, config, options);
  if (!found.any() && frame > options.steps.first) {
    from = options.steps.first;
    found = search(from, frame, feed, config, options);
  }
  if (!found.any()) return std::nullopt;

  Divergence d;
  d.frame = found.frame;
  d.cycle = found.clock - std::min(found.clock, found.start);
  if (found.mismatch)
    describe_mismatch(d, found, config);
  else if (found.unexpected)
    describe_unexpected(d, found);
  if (found.mismatch || found.unexpected) d.module = blame(config, found.clue);
  // What has no handshake waits for nobody.
  const bool waits = d.stage != Stage::claim && d.stage != Stage::error && d.stage != Stage::face &&
                     d.stage != Stage::table && d.stage != Stage::state && d.stage != Stage::end;
  if (!found.misconduct.empty() && waits && (d.field == "missing" || !found.mismatch)) {
    const Waiting w = waiting(config, found.handshakes);
    d.waits = w.text;
    if (!w.module.empty()) d.module = w.module;
  }
  if (found.part) describe_part(d, config, *found.part);
  d.what = describe(d.stage);
  if (!options.waveform.empty()) {
    write_wave(from, found.frame, feed, config, options, found.clock);
    d.waveform = options.waveform.string();
    auto save = options.waveform;
    save.replace_extension(".gtkw");
    write_save_file(save, options.waveform, config, found.clock);
    d.save_file = save.string();
  }
  return d;
}

std::vector<RtlTouch> watch_pixel(int frame, const Feed& feed, const Config& config, const DivergenceOptions& options,
                                  int x, int y) {
  std::vector<RtlTouch> touches;
  const auto watch = [&](const ExpectedEvent& e, const kage_rtl_event& a) {
    const bool seen = e.stage == Stage::pixel || e.stage == Stage::exit || e.stage == Stage::out;
    if (!seen || e.x != x || e.line != y) return;
    RtlTouch t;
    t.token = e.token;
    t.stage = e.stage;
    t.load = e.load;
    t.cycle = a.clock;
    t.same = first_difference(e, a) < 0;
    // A pixel's state comes behind what was brought to it.
    for (int i = e.stage == Stage::pixel ? 3 : 0; i < KAGE_RTL_EVENT_VALUES; ++i)
      if ((e.cares >> i & 1U) != 0)
        t.text += fmt::format("{}{} {}", t.text.empty() ? "" : ", ", value_name(e.stage, i),
                              value_text(config, e.stage, i, a.value[i]));
    touches.push_back(std::move(t));
  };
  const Found found = search(frame, frame, feed, config, options, watch);
  for (RtlTouch& t : touches) t.cycle -= std::min(t.cycle, found.start);
  return touches;
}

std::string describe(const Divergence& d) {
  std::string text = fmt::format("frame {}", d.frame);
  if (d.line >= 0) text += fmt::format(", line {}", d.line);
  if (d.x >= 0) text += fmt::format(", x {}", d.x);
  text += fmt::format(", cycle {}: {} (rtl/{}.sv), {}: expected {}, got {}", d.cycle, d.what, d.module, d.field,
                      d.expected, d.actual);
  if (!d.token_text.empty()) text += fmt::format("; token {}: {}", d.token, d.token_text);
  if (!d.source.empty()) text += ", from " + d.source;
  if (!d.waits.empty()) text += "; " + d.waits;
  return text;
}

}  // namespace kage::cosim
