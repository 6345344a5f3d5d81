// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/rtl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "cosim/model/driver/idle.hpp"
#include "cosim/model/misconduct.hpp"
#include "cosim/model/register_answer.hpp"
#include "cosim/model/rtl_library.hpp"
#include "cosim/model/video_lines.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "kage/registers.h"
#include "number/mixed.hpp"
#include "pipeline/stopwatch.hpp"
#include "plugin/foreign_code.hpp"

namespace kage::cosim {
namespace {

constexpr std::uint32_t kAlways = 65536;

std::uint64_t initial_seed(const RtlOptions& options) {
  return options.initial == 0 ? options.seed : mixed(options.seed, ~options.initial);
}

class Rtl : public RtlCore {
 public:
  Rtl(const std::filesystem::path& path, const Config& config, const RtlOptions& options)
      : config_(config), options_(options), library_(path, config), table_(library_.table()), marker_(config) {
    {
      const ForeignCode mark("RTL model: its construction");
      model_ = table_->create(initial_seed(options));
    }
    if (model_ == nullptr) throw Error(fmt::format("{}: out of memory", path.string()));
    table_->assertions(model_, options.assertions ? 1 : 0);
    if (options_.text) table_->on_text(model_, take_text, this);
    if (options.mutant != 0) {
      if (table_->select(model_, options.mutant) != 0)
        throw Error(fmt::format("{}: has no mutant {}", path.string(), options.mutant));
      table_->reset(model_, 3);
    }
    begin(0);
  }
  ~Rtl() override { table_->destroy(model_); }

  [[nodiscard]] int channels() const override { return config_.channels; }

  void begin(int number) override {
    number_ = number;
    hold_output(false);
  }

  void hold_output(bool on) override {
    const auto share = [](int stopped) { return kAlways - kAlways * static_cast<std::uint32_t>(stopped) / 100; };
    table_->stalls(model_, share(options_.idle_percent), on ? 0 : share(options_.backpressure_percent),
                   mixed(options_.seed, static_cast<std::uint64_t>(number_)));
  }

  void feed(std::span<const std::uint32_t> words, const LineSink& sink) override {
    Stopwatch watch(seconds_);
    open();
    if (stuck_) return;  // it takes nothing more
    held_.insert(held_.end(), words.begin(), words.end());
    marker_.mark(words, marks_);
    announce();
    if (!announced_ || held_.empty()) return;
    // The last beat waits here: TLAST may belong to it.
    const auto beat = static_cast<std::size_t>(config_.beat_words);
    const std::size_t n = (held_.size() - 1) / beat * beat;
    if (n == 0) return;
    submit(n, false);
    const LineSink outside = watch.outside(sink);
    const int why = in_slices([&] { return table_->run_dry(model_, slice()); }, outside);
    stuck_ = checked(why) == KAGE_RTL_STUCK;
  }

  void end_input() override {
    open();
    if (std::exchange(ended_, true)) return;
    // A frame may end within its header: cores read the rest of its last beat as zeros, and the header may be whole
    // then.
    if (!announced_) {
      const auto beat = static_cast<std::size_t>(config_.beat_words);
      held_.resize((held_.size() + beat - 1) / beat * beat, 0);
      marks_.resize(held_.size(), 0);
      announce();
    }
    if (!stuck_) submit(held_.size(), true);
  }

  [[nodiscard]] bool stuck() const override { return open_ && stuck_; }
  [[nodiscard]] bool monitored() const override { return table_->monitored != 0; }
  [[nodiscard]] std::string missing_monitors() const override { return table_->missing_monitors; }
  [[nodiscard]] std::uint32_t unwatched() const override { return table_->unwatched; }
  void record(bool on, std::function<void()> often) override {
    recording_ = on;
    table_->record(model_, on ? 1 : 0);
    often_ = std::move(often);
  }
  std::span<const kage_rtl_event> take_events() override {
    std::uint64_t count = 0;
    const kage_rtl_event* events = table_->events(model_, &count);
    events_.assign(events, events + count);
    table_->clear_events(model_);
    return events_;
  }
  Handshakes handshakes() override { return Handshakes(static_cast<std::uint32_t>(table_->handshakes(model_))); }
  std::uint64_t clock() override { return table_->clock(model_); }
  void wave(const std::filesystem::path& path, std::uint64_t first, std::uint64_t last) override {
    if (table_->wave(model_, path.c_str(), first, last) != 0) throw Error("a model that writes no waveforms");
  }
  int end_wave() override { return table_->end_wave(model_); }
  std::map<std::string, std::uint64_t> lines() override {
    std::map<std::string, std::uint64_t> counts;
    const auto point = [](void* user, const char* place, std::uint64_t count) {
      (*static_cast<std::map<std::string, std::uint64_t>*>(user))[place] = count;
    };
    if (table_->lines(model_, point, &counts) != 0) throw Error("a model that counts no lines");
    return counts;
  }

  void access(RegisterAccess* write, RegisterAccess* read) override {
    table_->reg_access(model_, write == nullptr ? nullptr : &write->bus, read == nullptr ? nullptr : &read->bus);
    for (const RegisterAccess* a : {write, read})
      if (a != nullptr) (void)answered(a->name, a->bus.address, a->bus.answer);
  }
  void access_at_once(RegisterAccess& access, bool write) override {
    kage_rtl_access& bus = access.bus;
    bus.answer =
        write ? table_->reg_write(model_, bus.address, bus.data) : table_->reg_read(model_, bus.address, &bus.data);
    (void)answered(access.name, bus.address, bus.answer);
  }
  void reset() override {
    table_->reset(model_, 2);
    errors_ = frames_ = 0;
  }
  [[nodiscard]] bool interrupt() const override { return table_->irq(model_) != 0; }
  void pass(std::uint64_t clocks) override { (void)checked(table_->run(model_, kForever, clocks)); }

  FrameEnd finish(const LineSink& sink) override {
    FrameEnd end;
    {
      Stopwatch watch(seconds_);
      end_input();
      finish(end, watch.outside(sink));
    }
    end.seconds = std::exchange(seconds_, 0);
    open_ = false;
    return end;
  }

 private:
  static constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();
  static constexpr std::uint64_t kMostClocks = 50'000'000;  // of a small frame
  // From the last beat of a frame to the first of the next: more than any configuration takes from the one to its last
  // pixel, where the frame is small and output is taken.
  static constexpr std::uint64_t kMostApart = 128;
  static constexpr std::uint64_t kFewApart = 16;

  [[nodiscard]] int checked(int why) const {
    const std::string failure = table_->failure(model_);
    if (!failure.empty()) throw AssertionError("rtl/" + failure);
    if (why == KAGE_RTL_ASSERT) throw FinishError();
    return why;
  }

  /// The response that an access of a register came to.
  [[nodiscard]] int answered(const char* name, std::uint32_t address, int answer) const {
    (void)checked(answer == KAGE_RTL_ENDED ? KAGE_RTL_ASSERT : KAGE_RTL_LIMIT);
    check_answer(name, address, answer);
    return answer;
  }

  /// Called by the driver.
  static void take_text(void* rtl, const char* piece) {
    const auto* self = static_cast<const Rtl*>(rtl);
    self->options_.text(self->number_, piece);
  }

  /// The first words of a frame are coming.
  void open() {
    if (open_) return;
    open_ = true;
    if (broken_) reset();
    broken_ = stuck_ = announced_ = ended_ = false;
    width_ = height_ = 0;
    lines_.start();
    held_.clear();
    marks_.clear();
    marker_.start();
    table_->clear_pixels(model_);
    if (options_.prelude) prelude();
    table_->clear_stats(model_);
  }

  /// Puts ahead of the frame at hand what RtlOptions::prelude describes.
  void prelude() {
    before_ = Before::nothing;
    ahead_ = 0;
    earlier_.clear();
    earlier_wrong_ = 0;
    earlier_errors_ = 0;
    const std::uint64_t chance = mixed(mixed(options_.seed, static_cast<std::uint64_t>(number_)));
    constexpr std::uint64_t kOf = 8;
    if (chance % kOf < 1)
      cut(chance / kOf);
    else if (chance % kOf < 4)
      follow(chance / kOf);
  }

  /// A frame comes whole, and is announced to the model where the golden core takes its header. Returns what the golden
  /// core says of it; its pixels are kept.
  FrameStatus submit_earlier(int number) {
    const std::vector<std::uint32_t> words = options_.prelude(number);
    const FrameStatus status = GoldenCore(config_).frame(words, [&](int, std::span<const std::uint8_t> line) {
      earlier_.insert(earlier_.end(), line.begin(), line.end());
    });
    if (status.width != 0)
      table_->expect(model_, static_cast<std::uint32_t>(status.width), static_cast<std::uint32_t>(status.height));
    table_->submit(model_, words.data(), words.size(), 1);
    return status;
  }

  /// A reset within a frame, or behind it.
  void cut(std::uint64_t chance) {
    before_ = Before::reset;
    table_->record(model_, 0);
    (void)submit_earlier(number_);
    earlier_.clear();
    (void)checked(table_->run(model_, kForever, chance % 2048));
    table_->reset(model_, 1 + static_cast<std::uint32_t>(chance / 2048 % 3));
    table_->clear_pixels(model_);
    table_->record(model_, recording_ ? 1 : 0);
    errors_ = frames_ = 0;
  }

  /// A frame ahead of the one at hand, which does not wait for its end: it comes right behind the last beat, or up to
  /// kMostApart clocks later, mostly few. Sometimes two frames, so that three are in the core.
  void follow(std::uint64_t chance) {
    before_ = Before::frame;
    if (recording_) table_->record(model_, 0);
    const int frames = chance % 4 == 0 ? 2 : 1;
    for (int i = frames - 1; i >= 0; --i) {
      const FrameStatus status = submit_earlier(i == 0 ? number_ : -1 - number_);
      if (status.error == ErrorCode::NONE) continue;
      ++earlier_errors_;
      earlier_error_ = status;
    }
    if (!recording_) {
      ahead_ = static_cast<std::uint32_t>(frames);
      const std::uint64_t apart = chance / 4 % 4;
      if (apart == 0) return;
      (void)checked(table_->run_dry(model_, kMostClocks));
      (void)checked(table_->run(model_, kForever, chance / 16 % (apart == 1 ? kMostApart : kFewApart)));
      look_at_earlier();
      return;
    }
    (void)checked(table_->run(model_, earlier_pixels(), kMostClocks));
    ahead_ = static_cast<std::uint32_t>(frames) - 1;
    (void)wait_for_end();
    errors_ += std::exchange(earlier_errors_, 0);
    table_->clear_pixels(model_);
    earlier_.clear();
    table_->record(model_, 1);
  }

  /// Notes misconduct of the model in the frame ahead so far, whose counts are forgotten now.
  void look_at_earlier() {
    kage_rtl_stats stats{};
    table_->stats(model_, &stats);
    if (!misconduct(stats, {}).empty()) ++earlier_wrong_;
  }

  /// The first of what is held.
  void submit(std::size_t words, bool last) {
    const auto n = static_cast<std::ptrdiff_t>(words);
    table_->mark(model_, marks_.data(), words);
    table_->submit(model_, held_.data(), words, last ? 1 : 0);
    held_.erase(held_.begin(), held_.begin() + n);
    marks_.erase(marks_.begin(), marks_.begin() + n);
  }

  /// Once the header is there whole, the model is told of the frame's size.
  void announce() {
    if (announced_ || held_.size() < kHeaderWords) return;
    announced_ = true;
    const FrameHeader h = FrameHeader::read(held_);
    width_ = static_cast<std::uint32_t>(h.width);
    height_ = static_cast<std::uint32_t>(h.height);
    lines_.expect(width_, height_, static_cast<std::size_t>(config_.channels));
    table_->expect(model_, width_, height_);
  }

  void finish(FrameEnd& end, const LineSink& sink) {
    const bool any = width_ != 0 && height_ != 0;
    int why = KAGE_RTL_STUCK;
    if (!stuck_)
      why = in_slices([&] { return table_->run(model_, any ? earlier_pixels() + lines_.left() : kForever, slice()); },
                      sink);
    (void)checked(why);
    std::string trouble;
    if (why == KAGE_RTL_STUCK)
      trouble = "the core hangs, with input waiting";
    else if (why == KAGE_RTL_PIXELS)
      trouble = wait_for_end();
    else if (any)
      trouble = "the core went idle";
    end.status = status();
    take_pixels(sink);
    (void)checked(why);  // the core works on while registers are read
    broken_ = why != KAGE_RTL_PIXELS || !trouble.empty();

    const bool header_error = end.status.error == ErrorCode::HEADER || end.status.error == ErrorCode::SIZE ||
                              end.status.error == ErrorCode::PARAMS ||
                              (end.status.error == ErrorCode::LAST_EARLY && end.status.token == 0);
    if (header_error && why != KAGE_RTL_STUCK) trouble.clear();
    lines_.end(sink);
    if (!header_error) {
      end.status.width = static_cast<int>(width_);
      end.status.height = static_cast<int>(height_);
    }

    kage_rtl_stats stats{};
    table_->stats(model_, &stats);
    end.before = before_;
    end.ahead_wrong = trouble.empty() && (earlier_wrong_ != 0 || !earlier_.empty());
    if (end.ahead_wrong) trouble = "the frame right ahead of this one has wrong pixels";
    end.misconduct = misconduct(stats, trouble);
    end.cycles = stats.cycles;
    static_assert(std::tuple_size_v<PhaseStalls> == KAGE_RTL_MARKS);
    end.stalls = {};
    for (std::size_t i = 0; i < KAGE_RTL_MARKS; ++i) {
      end.phase_stalls[i] = {stats.starved[i], stats.blocked[i]};
      end.stalls.starved += stats.starved[i];
      end.stalls.blocked += stats.blocked[i];
    }
  }

  std::uint32_t read(const char* name, std::uint32_t address) {
    std::uint32_t value = 0;
    const int response = answered(name, address, table_->reg_read(model_, address, &value));
    if (response != 0)
      throw RegisterError(fmt::format("register {} ({:#04x}): expected response 0, got {}", name, address, response));
    return value;
  }

  /// The last pixel leaves before END is read: wait until the core has counted the frame.
  std::string wait_for_end() {
    for (int tries = 0; tries < 10000; ++tries)
      if (read("FRAMES", KAGE_REG_FRAMES) == frames_ + 1 + ahead_) {
        frames_ += 1 + std::exchange(ahead_, 0);
        return {};
      }
    return "the frame does not end";
  }

  FrameStatus status() {
    const std::uint32_t known = errors_;
    const std::uint32_t expected = known + earlier_errors_;
    errors_ = read("ERRORS", KAGE_REG_ERRORS);
    const bool lost = known <= errors_ && errors_ < expected;
    if (errors_ != expected && !lost) return newest_error();
    // None is of the frame at hand: the newest is that of the frames ahead, if they have any.
    if (lost || (earlier_errors_ > 0 && !same_error(newest_error(), earlier_error_))) ++earlier_wrong_;
    return {};
  }

  static bool same_error(const FrameStatus& a, const FrameStatus& b) {
    return a.error == b.error && a.line == b.line && a.frame == b.frame && a.token == b.token &&
           (!is_of_unit(a.error) || a.unit == b.unit);
  }

  FrameStatus newest_error() {
    FrameStatus s;
    const std::uint32_t error = read("ERROR", KAGE_REG_ERROR);
    s.error = static_cast<ErrorCode>(KAGE_FIELD(error, KAGE_ERROR_CODE));
    s.line = KAGE_FIELD(error, KAGE_ERROR_LINE);
    s.frame = read("ERROR_FRAME", KAGE_REG_ERROR_FRAME);
    s.token = read("ERROR_TOKEN", KAGE_REG_ERROR_TOKEN);
    s.unit = read("ERROR_UNIT", KAGE_REG_ERROR_UNIT);
    return s;
  }

  /// Clocks after which events are handed over. The model sees that a core has come to rest after idle_clocks() with
  /// output ready: the slice has twice as many.
  [[nodiscard]] std::uint64_t slice() const {
    const auto number = [](int parameter) { return static_cast<std::uint64_t>(parameter); };
    const auto rest = idle_clocks(number(config_.max_width), number(config_.lanes), number(config_.active));
    return often_ ? 2 * rest * 100 / (100 - static_cast<unsigned>(options_.backpressure_percent)) : kForever;
  }

  template <class Run>
  int in_slices(Run run, const LineSink& sink) {
    while (true) {
      const int why = run();
      take_pixels(sink);
      if (why != KAGE_RTL_LIMIT) return why;
      if (often_) often_();
    }
  }

  /// Pixels to come of the frame ahead.
  [[nodiscard]] std::uint64_t earlier_pixels() const {
    return earlier_.size() / static_cast<std::size_t>(config_.channels);
  }

  /// Takes pixels; those of a frame ahead are compared here. Pixels past the frame's size are counted by the model.
  void take_pixels(const LineSink& sink) {
    std::uint64_t count = 0;
    const std::uint8_t* pixels = table_->pixels(model_, &count);
    const auto channels = static_cast<std::size_t>(config_.channels);
    const auto earlier = static_cast<std::size_t>(std::min(count, earlier_pixels())) * channels;
    if (!std::equal(pixels, pixels + earlier, earlier_.begin())) ++earlier_wrong_;
    earlier_.erase(earlier_.begin(), earlier_.begin() + static_cast<std::ptrdiff_t>(earlier));
    lines_.take(pixels + earlier, count - earlier / channels, sink);
    table_->clear_pixels(model_);
  }

  Config config_;
  RtlOptions options_;
  RtlLibrary library_;
  const kage_rtl_table* table_;
  kage_rtl* model_ = nullptr;
  std::uint32_t frames_ = 0;
  std::uint32_t errors_ = 0;
  bool broken_ = false;
  bool recording_ = false;
  int number_ = 0;
  std::vector<kage_rtl_event> events_;  // the last ones taken
  std::function<void()> often_;

  // State of the frames right before the one at hand:
  Before before_ = Before::nothing;
  std::uint32_t ahead_ = 0;            // frames ahead whose end was not seen yet
  std::uint32_t earlier_errors_ = 0;   // errors that were not seen yet, as the golden core has them
  FrameStatus earlier_error_;          // the last of them
  std::vector<std::uint8_t> earlier_;  // its pixels to come, as the golden core has them
  int earlier_wrong_ = 0;              // pieces of them that came otherwise

  // State of the frame at hand:
  bool open_ = false;
  bool announced_ = false;
  bool ended_ = false;  // its last beat is queued
  bool stuck_ = false;
  std::uint32_t width_ = 0;
  std::uint32_t height_ = 0;
  VideoLines lines_;
  std::vector<std::uint32_t> held_;  // not yet submitted
  std::vector<std::uint8_t> marks_;  // of those words
  PhaseMarker marker_;
  double seconds_ = 0;
};

}  // namespace

std::unique_ptr<RtlCore> make_rtl(const std::filesystem::path& library, const Config& config,
                                  const RtlOptions& options) {
  return std::make_unique<Rtl>(library, config, options);
}

}  // namespace kage::cosim
