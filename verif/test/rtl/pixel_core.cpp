// SPDX-License-Identifier: Apache-2.0
// pixel_core in both arrangements against an array of pixels: random commands, buffers that are not free, back-to-back
// work on the same pixels, and the clocks that commands take.
#include <algorithm>
#include <array>
#include <deque>

#include "Vpixel_banked1.h"
#include "Vpixel_banked4.h"
#include "Vpixel_glass4.h"
#include "Vpixel_glass_lights4.h"
#include "Vpixel_glass_systolic.h"
#include "Vpixel_lights_systolic.h"
#include "Vpixel_soft_systolic.h"
#include "Vpixel_systolic.h"
#include "bench.hpp"
#include "contract/derived.hpp"

using namespace kage::rtl;
using kage::Kind;

namespace {

using kage::derived::kCommandLoad;
using kage::derived::kCommandOut;

struct Shape : kage::Config {
  [[nodiscard]] int exit_lanes() const { return arrangement == 0 ? 1 : lanes; }
  [[nodiscard]] int light_at() const { return fsf != 0 ? 0 : dsf_bits; }  // of ES's light in the count
  [[nodiscard]] int exit_bits() const {
    if (dsf_bits == 0) return 8 * channels + 1;
    if (count_bits == 0) return 8 * channels + 2;
    return 8 * channels + 1 + (class_bits > 1 ? class_bits : 0) + lights * count_bits;
  }
};

struct Command {
  Kind kind;
  int xl, xr;
  std::uint64_t count, z, dz;
  std::uint64_t color[3], dcolor[3];
  std::uint64_t share;  // alpha of TP, shade of RESOLVE
};

struct Pixel {
  std::uint64_t z, color[3];
  unsigned normal_class, dsf, fsf;
  std::array<std::uint64_t, 8> counts;
};

std::int64_t wrap(std::uint64_t v, int bits) { return static_cast<std::int64_t>(v << (64 - bits)) >> (64 - bits); }

/// The pixels, and the pixels that leave as {dark, covered, colour}, with counters {counts, class, covered, colour}.
class Reference {
 public:
  explicit Reference(const Shape& s) : s_(s), line_(static_cast<std::size_t>(s.max_width)) { clear(); }

  void apply(const Command& c, std::deque<std::uint64_t>& out) {
    const unsigned mask = (1U << s_.dsf_bits) - 1;
    for (int x = c.xl; x < c.xr; ++x) {
      Pixel& p = line_[static_cast<std::size_t>(x)];
      const auto dx = static_cast<std::uint64_t>(x - c.xl);
      const std::int64_t sum = wrap(c.z + dx * c.dz, s_.z_bits + s_.z_frac + 2);
      const auto z = static_cast<std::uint64_t>(std::clamp<std::int64_t>(sum >> s_.z_frac, 1, (1 << s_.z_bits) - 2));
      switch (c.kind) {
        case Kind::OP:
          if (z >= p.z) break;
          p.z = z;
          p.normal_class = static_cast<unsigned>(c.count & ((1U << s_.class_bits) - 1));
          for (int ch = 0; ch < s_.channels; ++ch) p.color[ch] = color(c, ch, dx);
          break;
        case Kind::TP:  // (under (255 - alpha) + over alpha) / 255, to the nearest
          for (int ch = 0; z < p.z && ch < s_.channels; ++ch)
            p.color[ch] = (2 * (p.color[ch] * (255 - c.share) + color(c, ch, dx) * c.share) + 255) / 510;
          break;
        case Kind::RESOLVE: {
          const std::uint64_t one = std::uint64_t{1} << s_.shade_frac;
          for (int ch = 0; ch < s_.channels; ++ch) {
            if (!covered(p))
              p.color[ch] = color(c, ch, dx);
            else if (s_.count_bits == 0 && shadow(p, c.count) && p.normal_class != 0)
              p.color[ch] = (2 * p.color[ch] * (one - c.share) + one) / (2 * one);
          }
          p.dsf = p.fsf = 0;
          break;
        }
        case Kind::SP:
          if (z < p.z) p.dsf = (p.dsf + static_cast<unsigned>(c.count)) & mask;
          break;
        case Kind::NC:
          p.dsf = (p.dsf + static_cast<unsigned>(c.count)) & mask;
          break;
        case Kind::EV:
          if (((p.dsf + c.count) & mask) != 0) p.fsf = 1;
          p.dsf = 0;
          break;
        case Kind::ES: {
          const std::uint64_t light = s_.lights > 1 ? c.count >> s_.light_at() : 0;
          std::uint64_t& count = p.counts[light];
          if (shadow(p, c.count)) count = std::min<std::uint64_t>(count + 1, (1U << s_.count_bits) - 1);
          if (s_.fsf == 0) p.dsf = 0;
          p.fsf = 0;
          break;
        }
        case kCommandLoad:
          for (int ch = 0; ch < s_.channels; ++ch) p.color[ch] = color(c, ch, 0);
          break;
        default:  // EOL and kCommandOut, after which DSF and FSF are of no use
          out.push_back(leaving(p, c.count));
          p.counts = {};
      }
    }
    if (c.kind == Kind::EOL) clear();
  }

 private:
  [[nodiscard]] std::uint64_t leaving(const Pixel& p, std::uint64_t bias) const {
    int at = 8 * s_.channels;
    std::uint64_t value = static_cast<std::uint64_t>(covered(p)) << at++;
    for (int ch = 0; ch < s_.channels; ++ch) value |= p.color[ch] << (8 * ch);
    if (s_.count_bits == 0) {
      if (s_.dsf_bits > 0) value |= static_cast<std::uint64_t>(shadow(p, bias) && p.normal_class != 0) << at;
      return value;
    }
    if (s_.class_bits > 1) value |= static_cast<std::uint64_t>(p.normal_class) << at;
    if (s_.class_bits > 1) at += s_.class_bits;
    for (int light = 0; light < s_.lights && p.normal_class != 0; ++light)
      value |= p.counts[static_cast<std::size_t>(light)] << (at + light * s_.count_bits);
    return value;
  }
  [[nodiscard]] bool covered(const Pixel& p) const { return p.z != (1U << s_.z_bits) - 1; }
  [[nodiscard]] bool shadow(const Pixel& p, std::uint64_t bias) const {
    return s_.fsf != 0 ? p.fsf != 0 : ((p.dsf + bias) & ((1U << s_.dsf_bits) - 1)) != 0;
  }
  [[nodiscard]] std::uint64_t color(const Command& c, int ch, std::uint64_t dx) const {
    if (s_.smooth == 0) return c.color[ch];
    return static_cast<std::uint64_t>(
        std::clamp<std::int64_t>(wrap(c.color[ch] + dx * c.dcolor[ch], 10 + s_.color_frac) >> s_.color_frac, 0, 255));
  }

  void clear() {
    for (Pixel& p : line_) p = {(1U << s_.z_bits) - 1, {}, 0, 0, 0, {}};
  }
  Shape s_;
  std::vector<Pixel> line_;
};

Command random_command(Dice& dice, const Shape& s, int width, int home) {
  static constexpr Kind kKinds[] = {Kind::OP, Kind::OP, Kind::OP, Kind::SP, Kind::SP, Kind::NC, Kind::EV};
  Command c{};
  c.kind = s.dsf_bits == 0 ? Kind::OP : kKinds[dice.below(s.fsf != 0 ? 7 : 6)];
  if (s.count_bits > 0 && dice.percent(20)) c.kind = Kind::ES;
  c.xl = dice.below(width);
  if (dice.percent(60)) c.xl = std::min(width - 1, home + dice.below(3));
  c.xr = dice.percent(60) ? std::min(width, c.xl + dice.between(1, 9)) : dice.between(c.xl + 1, width);
  const int bits = s.z_bits + s.z_frac + 2;
  const std::uint64_t mask = (1ULL << bits) - 1;
  c.z = (((1ULL << (s.z_bits - 1)) + dice.bits(3)) << s.z_frac) & mask;
  c.dz = dice.bits(s.z_frac + 2);
  if (dice.percent(50)) c.dz = (0 - c.dz) & mask;
  if (dice.percent(20)) c.z = dice.bits(bits);
  if (dice.percent(20)) c.dz = dice.bits(bits);
  c.count = dice.bits(std::max(s.dsf_bits, 1));
  if (c.kind == Kind::OP) c.count = dice.percent(20) ? 0 : dice.bits(s.class_bits);
  if (c.kind == Kind::ES && s.fsf != 0) c.count = 0;
  if (c.kind == Kind::ES && s.lights > 1) c.count |= static_cast<std::uint64_t>(dice.below(s.lights)) << s.light_at();
  for (int ch = 0; ch < s.channels; ++ch) {
    c.color[ch] = dice.bits(s.smooth != 0 ? 10 + s.color_frac : 8);
    c.dcolor[ch] = s.smooth != 0 ? dice.bits(10 + s.color_frac) : 0;
  }
  return c;
}

/// RESOLVE before a line's first TP, TP or any other command after it. With counters also kCommandOut, and then a
/// kCommandLoad for each pixel from `loads` on.
Command translucent(Dice& dice, const Shape& s, Command c, int width, bool& painted, int& loads) {
  if (painted && dice.percent(30)) return c;
  if (painted) {
    c.kind = Kind::TP;
    c.share = dice.percent(30) ? 255 * dice.bits(1) : dice.bits(8);
    return c;
  }
  if (loads >= 0) {
    c.kind = kCommandLoad;
    c.xl = loads++;
    c.xr = loads;
    painted = loads == width;
  } else {
    const bool out = s.count_bits > 0 && dice.percent(70);
    c.kind = out ? kCommandOut : Kind::RESOLVE;
    c.xl = 0;
    c.xr = width;
    loads = out ? 0 : -1;
    painted = !out;
  }
  c.share = dice.percent(20) ? 1ULL << s.shade_frac : dice.bits(s.shade_frac);
  for (int ch = 0; ch < s.channels; ++ch) {
    c.color[ch] = dice.bits(8) << s.color_frac;
    c.dcolor[ch] = 0;
  }
  return c;
}

template <class Model>
void set_command(Model& top, const Shape& s, const Command& c) {
  const CommandBus bus(s);
  const int ramp = s.smooth != 0 ? 10 + s.color_frac : 8;
  put(top.cmd_i, bus.kind, static_cast<std::uint64_t>(c.kind));
  put(top.cmd_i, bus.xl, static_cast<std::uint64_t>(c.xl));
  put(top.cmd_i, bus.xr, static_cast<std::uint64_t>(c.xr));
  put(top.cmd_i, bus.count, c.count);
  put(top.cmd_i, bus.z, c.z);
  put(top.cmd_i, bus.dz, c.dz);
  put(top.cmd_i, bus.share, c.share);
  for (int ch = 0; ch < s.channels; ++ch) {
    put(top.cmd_i, bus.color.lsb + ch * ramp, ramp, c.color[ch]);
    if (s.smooth != 0) put(top.cmd_i, bus.dcolor.lsb + ch * ramp, ramp, c.dcolor[ch]);
  }
}

/// Random commands go in; the pixels of each line leave as the reference says.
template <class Model>
class Lines {
 public:
  explicit Lines(Dice& dice)
      : dice_(dice),
        top_(dice),
        offer_(stall_percent(dice)),
        free_percent_(100 - stall_percent(dice)),
        width_(dice.between(1, kOf.max_width)) {}

  void run() {
    for (int clock = 0; lines_ < kMost || !widths_.empty(); ++clock) {
      REQUIRE(clock < 200000);
      if (!have_ && lines_ < kMost) next_command();
      top_->cmd_valid_i = offer_(dice_, have_) ? 1 : 0;
      set_command(*top_, kOf, command_);
      top_->exit_free_i = dice_.percent(free_percent_) ? 1 : 0;
      top_.settle();
      const bool taken = top_->cmd_valid_i && top_->cmd_ready_o;
      if (top_->exit_take_o) REQUIRE(top_->exit_free_i);
      if (top_->exit_valid_o) look();
      top_.edge();
      if (taken) take();
    }
    REQUIRE(expected_.empty());
  }

 private:
  static constexpr Shape kOf{config_of<Model>()};
  static constexpr int kMost = 12;  // lines

  void next_command() {
    const bool loading = loads_ >= 0 && !painted_;
    if (left_-- > 0 || loading) {
      command_ = random_command(dice_, kOf, width_, home_);
      if (kOf.translucency != 0 && (painted_ || loading || dice_.percent(10)))
        command_ = translucent(dice_, kOf, command_, width_, painted_, loads_);
    } else {
      command_ = Command{};
      command_.kind = Kind::EOL;
      command_.xr = width_;
      command_.count = kOf.fsf == 0 ? dice_.bits(std::max(kOf.dsf_bits, 1)) : 0;
    }
    have_ = true;
  }

  /// A group of pixels leaves.
  void look() {
    REQUIRE(!widths_.empty());
    const int width = widths_.front();
    const int bits = kOf.exit_bits();
    for (int lane = 0; lane < kOf.exit_lanes() && x_ < width; ++lane, ++x_) {
      CAPTURE(x_, lane, width);
      const std::uint64_t got = get(top_->exit_data_o, lane * bits, bits);
      const std::uint64_t want = expected_.front();
      expected_.pop_front();
      const std::uint64_t covered = want >> (8 * kOf.channels) & 1;
      REQUIRE((got >> (8 * kOf.channels) & 1) == covered);
      if (covered != 0 || colored_.front()) REQUIRE(got == want);  // else an uncovered pixel has any colour
    }
    REQUIRE(static_cast<bool>(top_->exit_last_o) == (x_ == width));
    if (x_ < width) return;
    x_ = 0;
    widths_.pop_front();
    colored_.pop_front();
  }

  /// The command was taken.
  void take() {
    offer_.taken();
    have_ = false;
    reference_.apply(command_, expected_);
    if (command_.kind == kCommandOut) {
      widths_.push_back(width_);
      colored_.push_back(false);
    }
    if (command_.kind != Kind::EOL) return;
    loads_ = -1;
    widths_.push_back(width_);
    colored_.push_back(painted_);
    painted_ = false;
    width_ = dice_.percent(30) ? kOf.max_width : dice_.between(1, kOf.max_width);
    home_ = dice_.below(width_);
    left_ = dice_.percent(30) ? 0 : dice_.below(40);
    ++lines_;
  }

  Dice& dice_;
  Bench<Model> top_;
  Offer offer_;
  int free_percent_;
  Reference reference_{kOf};
  std::deque<std::uint64_t> expected_;
  std::deque<int> widths_;    // of lines that have not left
  std::deque<bool> colored_;  // whether their uncovered pixels have a colour too
  int width_, home_ = 0, left_ = 0, lines_ = 0, loads_ = -1;
  int x_ = 0;  // of the line that leaves
  Command command_{};
  bool have_ = false, painted_ = false;
};

template <class Model>
void pixel_test() {
  each_seed(15, [](Dice& dice) { Lines<Model>(dice).run(); });
}

/// Clocks from the first to the last of `n` equal commands, which come without a pause.
template <class Model>
int clocks_of(Dice& dice, int xl, int xr, int n) {
  Bench<Model> top(dice);
  top->exit_free_i = 1;
  Command c{};
  c.kind = Kind::OP;
  c.xl = xl;
  c.xr = xr;
  set_command(*top, Shape{config_of<Model>()}, c);
  top->cmd_valid_i = 1;
  int first = 0, taken = 0, clock = 0;
  for (; taken < n + 64; ++clock) {  // the first 64 fill the stages before the walker, and outlast the sweep
    top.settle();
    if (top->cmd_ready_o && ++taken == 64) first = clock;
    top.edge();
  }
  return clock - 1 - first;
}

}  // namespace

TEST_CASE("Banked, one lane, smooth, counting", "[pixel_core]") { pixel_test<Vpixel_banked1>(); }
TEST_CASE("Banked, four lanes, flat, parity", "[pixel_core]") { pixel_test<Vpixel_banked4>(); }
TEST_CASE("Systolic, smooth, counting, no FSF", "[pixel_core]") { pixel_test<Vpixel_systolic>(); }

TEST_CASE("Banked, four lanes, translucent", "[pixel_core]") { pixel_test<Vpixel_glass4>(); }
TEST_CASE("Systolic, smooth, translucent, no FSF", "[pixel_core]") { pixel_test<Vpixel_glass_systolic>(); }

TEST_CASE("Banked, four lanes, counters of three lights, loads", "[pixel_core]") { pixel_test<Vpixel_glass_lights4>(); }
TEST_CASE("Systolic, no FSF, counters of eight lights, loads", "[pixel_core]") { pixel_test<Vpixel_lights_systolic>(); }
TEST_CASE("Systolic, one counter, no table", "[pixel_core]") { pixel_test<Vpixel_soft_systolic>(); }

TEST_CASE("Clocks per command: groups touched, or one", "[pixel_core]") {
  each_seed(1, [](Dice& dice) {
    CHECK(clocks_of<Vpixel_banked4>(dice, 4, 8, 40) == 40);        // one group, again and again: no hazard stalls
    CHECK(clocks_of<Vpixel_banked4>(dice, 7, 9, 40) == 2 * 40);    // two pixels in two groups
    CHECK(clocks_of<Vpixel_banked4>(dice, 0, 37, 20) == 10 * 20);  // the line
    CHECK(clocks_of<Vpixel_banked1>(dice, 3, 9, 20) == 6 * 20);
    CHECK(clocks_of<Vpixel_systolic>(dice, 0, 21, 40) == 40);  // whatever the length
  });
}
