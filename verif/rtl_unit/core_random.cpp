// SPDX-License-Identifier: Apache-2.0
//
// The whole core against the golden core on random frames, sound and malformed: pixels, video framing, error registers
// and counts. Families 39 (stalls, back-to-back frames, one-pixel frames, empty lines, resets), 40 (damage at the port)
// and 41 (random initial state of every register and memory).
//
// usage: core_random MODEL.so... ; KAGE_SEED repeats a run, KAGE_ROUNDS sets its length. Exit 0: the same; 1: a
// difference, with the seed that repeats it; 2: trouble.
#include <dlfcn.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/registers.h"
#include "kage/stream.hpp"
#include "rtl_model/rtl_model.h"

namespace {

using namespace kage;
using Words = std::vector<std::uint32_t>;

/// Draws all that is random; small ranges come out the same on every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  bool one_in(int n) { return below(n) == 0; }
  std::int64_t field(int width) {  // signed, of any magnitude
    const int keep = between(1, width);
    return static_cast<std::int64_t>(engine_() << (64 - keep)) >> (64 - keep);
  }

 private:
  std::mt19937_64 engine_;
};

class FrameMaker {
 public:
  FrameMaker(const Config& config, Dice& dice) : c_(config), dice_(dice) {}

  /// A frame that obeys all rules.
  Words sound(std::uint32_t number) {
    Words words;
    TokenWriter out(c_, words);
    width_ = dice_.one_in(3) ? c_.max_width : dice_.between(1, std::min(c_.max_width, 70));
    const int height = dice_.between(1, dice_.one_in(8) ? 12 : 4);
    out.header({width_, height, static_cast<std::uint32_t>(dice_.bits()) & 0xFFFFFF, number});
    if (c_.dsf_bits > 0 && !dice_.one_in(4))
      out.shade(static_cast<std::uint32_t>(dice_.bits() % ((1U << c_.shade_frac) + 1)));
    for (int y = 0; y < height; ++y) line(out, y);
    out.end();
    return words;
  }

  /// Something wrong with it, or perhaps not: what the golden core says is right.
  Words malformed(std::uint32_t number) {
    Words words = sound(number);
    const auto at = [&] { return static_cast<std::size_t>(dice_.below(static_cast<int>(words.size()))); };
    switch (dice_.below(9)) {
      case 0:  // one flipped bit, anywhere
        words[at()] ^= 1U << dice_.below(32);
        break;
      case 1:  // one flipped bit among kinds
        words[at()] ^= 1U << dice_.below(4);
        break;
      case 2:  // cut
        words.resize(static_cast<std::size_t>(dice_.between(1, static_cast<int>(words.size()))));
        break;
      case 3:  // words beyond END
        for (int n = dice_.between(1, 40); n > 0; --n) words.push_back(static_cast<std::uint32_t>(dice_.bits()));
        break;
      case 4:  // a header that is not this core's
        words[static_cast<std::size_t>(dice_.below(3))] ^= 1U << dice_.below(32);
        break;
      case 5:  // a word too few
        words.erase(words.begin() + static_cast<std::ptrdiff_t>(at()));
        break;
      case 6: {  // a word twice
        const std::size_t i = at();
        words.insert(words.begin() + static_cast<std::ptrdiff_t>(i), words[i]);
        break;
      }
      case 7:  // a word of noise
        words[at()] = static_cast<std::uint32_t>(dice_.bits());
        break;
      default:  // short sizes: more or fewer lines than the header says
        words[1] = static_cast<std::uint32_t>(dice_.between(0, 6)) << 16 |
                   static_cast<std::uint32_t>(dice_.between(0, c_.max_width + 1));
        break;
    }
    return words;
  }

 private:
  void range(SpanToken& s) {
    s.xl = dice_.between(0, width_);
    s.xr = dice_.one_in(4) ? std::min(width_, s.xl + dice_.below(3)) : dice_.between(s.xl, width_);
    if (dice_.one_in(3)) {  // the same neighbourhood again and again: what forwarding is for
      s.xl = std::min(width_, home_ + dice_.below(3));
      s.xr = std::min(width_, s.xl + dice_.below(10));
    }
  }

  SpanToken span() {
    SpanToken s;
    range(s);
    const int bits = c_.z_bits + c_.z_frac + 2;
    if (dice_.one_in(5)) {
      s.z = dice_.field(bits);
      s.dz = dice_.field(bits);
    } else {  // near each other, so that both answers of the comparison happen
      s.z = ((std::int64_t{1} << (c_.z_bits - 1)) + dice_.between(-8, 8)) << c_.z_frac;
      s.dz = dice_.field(std::min(bits, c_.z_frac + 2));
    }
    s.w = static_cast<int>(dice_.field(c_.dsf_bits + 1));
    s.lit = !dice_.one_in(3);
    for (std::size_t ch = 0; ch < static_cast<std::size_t>(c_.channels); ++ch) {
      s.color[ch] = c_.smooth != 0 ? static_cast<std::int32_t>(dice_.field(10 + c_.color_frac)) : dice_.below(256);
      s.dcolor[ch] = c_.smooth != 0 ? static_cast<std::int32_t>(dice_.field(10 + c_.color_frac)) : 0;
    }
    return s;
  }

  void line(TokenWriter& out, int y) {
    home_ = dice_.below(width_);
    const int most = dice_.one_in(6) ? 60 : 12;
    for (int n = dice_.below(most); n > 0; --n) out.op(span());
    if (c_.dsf_bits > 0 && !dice_.one_in(4)) {
      bool open = false;
      for (int n = dice_.between(1, most); n > 0; --n) {
        const SpanToken s = span();
        const int pick = dice_.below(8);
        if (pick < 4) {
          out.sp(s);
        } else if (pick < 5) {
          out.nc(s.xl, s.xr, s.w);
        } else if (pick < 6) {
          out.inside(s.w);
        } else if (c_.fsf != 0 && open) {
          ev(out);
          open = false;
          continue;
        } else {
          continue;
        }
        open = true;
        volume_ = true;
      }
      if (!volume_) out.inside(1);
      if (c_.fsf != 0 && (open || !volume_)) ev(out);
      out.resolve();
      volume_ = false;
    }
    out.eol(y);
  }

  void ev(TokenWriter& out) {
    SpanToken s;
    range(s);
    if (dice_.one_in(2)) {
      s.xl = 0;
      s.xr = width_;
    }
    out.ev(s.xl, s.xr);
  }

  Config c_;
  Dice& dice_;
  int width_ = 1;
  int home_ = 0;
  bool volume_ = false;
};

/// Fill for the last beat: a core ignores it after END, so noise there must not matter; elsewhere zeros, as the golden
/// core reads.
void fill(Words& words, const Config& c, bool sound, Dice& dice) {
  while (words.size() % static_cast<std::size_t>(c.beat_words) != 0)
    words.push_back(sound ? static_cast<std::uint32_t>(dice.bits()) : 0U);
}

struct Trial {
  const kage_rtl_table& api;
  Config config;
  std::uint64_t seed;
  std::string text;  // what went wrong

  bool fails(const std::string& what) {
    text = what;
    return false;
  }

  std::uint32_t reg(kage_rtl* m, std::uint32_t address) const {
    std::uint32_t value = 0xDEAD;
    api.reg_read(m, address, &value);
    return value;
  }

  bool run() {
    Dice dice(seed);
    kage_rtl* m = api.create(seed);
    const bool good = frames(m, dice);
    api.destroy(m);
    return good;
  }

  /// A standstill is named: by the watchdog's interrupt, and in STATUS by what the core waits for.
  bool standstill(kage_rtl* m, FrameMaker& maker) {
    api.stalls(m, 65536, 65536, 1);
    api.reg_write(m, KAGE_REG_WATCHDOG, 300);
    api.reg_write(m, KAGE_REG_CONTROL, 4);
    api.reg_write(m, KAGE_REG_IRQ, 7);
    Words words = maker.sound(5);
    words.resize(words.size() - 1);  // no END, no TLAST
    api.submit(m, words.data(), words.size(), 0);
    api.run(m, UINT64_MAX, 50'000'000);
    if (config.beat_words == 1) {  // else the fill is an error, and the core waits for TLAST: the same standstill
      if ((reg(m, KAGE_REG_STATUS) & 15U) != 5U) return fails("STATUS does not say that a frame waits for input");
    } else if ((reg(m, KAGE_REG_STATUS) & 13U) != 5U) {
      return fails("STATUS does not say that the core waits for input");
    }
    if (api.irq(m) == 0 || (reg(m, KAGE_REG_IRQ) & 4U) == 0)
      return fails("the watchdog does not bite when input stops");
    api.reset(m, 1);
    api.clear_pixels(m);
    api.stalls(m, 65536, 0, 1);
    api.reg_write(m, KAGE_REG_WATCHDOG, 300);
    api.reg_write(m, KAGE_REG_CONTROL, 4);
    words = maker.sound(6);
    api.submit(m, words.data(), words.size(), 1);
    api.run(m, UINT64_MAX, 8ULL * static_cast<std::uint64_t>(config.max_width) + 20'000);
    if ((reg(m, KAGE_REG_STATUS) & 9U) != 9U) return fails("STATUS does not say that the core waits for output");
    if (api.irq(m) == 0) return fails("the watchdog does not bite when output stops");
    api.reset(m, 1);
    api.clear_pixels(m);
    return true;
  }

  bool frames(kage_rtl* m, Dice& dice) {
    FrameMaker maker(config, dice);
    GoldenCore golden(config);
    const auto stall = [&] {
      static constexpr std::uint32_t chances[] = {65536, 65536, 60000, 32768, 9000, 2500};
      api.stalls(m, chances[dice.below(6)], chances[dice.below(6)], dice.bits());
    };
    if (dice.one_in(5) && !standstill(m, maker)) return false;
    stall();
    if (reg(m, KAGE_REG_PARAM_HASH) != param_hash(config)) return fails("PARAM_HASH differs");
    std::uint32_t errors = 0;
    std::uint32_t ended = 0;
    for (int group = 0; group < 4; ++group) {
      if (dice.one_in(3)) {  // reset somewhere within a frame
        const Words words = maker.sound(99);
        api.submit(m, words.data(), words.size(), 1);
        api.run(m, UINT64_MAX, static_cast<std::uint64_t>(dice.below(2000)));
        api.reset(m, static_cast<std::uint32_t>(dice.between(1, 3)));
        api.clear_pixels(m);
        errors = ended = 0;
      }
      std::vector<std::uint8_t> expected;
      FrameStatus newest;
      const int count = dice.between(1, 3);
      std::string story;
      for (int i = 0; i < count; ++i) {
        const bool sound = dice.one_in(2);
        const auto number = static_cast<std::uint32_t>(dice.bits());
        Words words = sound ? maker.sound(number) : maker.malformed(number);
        while (words.size() > 1 && words[1] >> 16 < 32768 && words[1] >> 16 > 40)
          words = maker.malformed(number);  // too long a wait
        fill(words, config, sound, dice);
        const FrameStatus s = golden.frame(words, [&](int, std::span<const std::uint8_t> line) {
          expected.insert(expected.end(), line.begin(), line.end());
        });
        if (sound && s.error != ErrorCode::NONE) return fails("the golden core refuses a sound frame");
        story += std::string(" ") + std::string(kErrorNames[static_cast<std::size_t>(s.error)]);
        ++ended;
        if (s.error != ErrorCode::NONE) {
          ++errors;
          newest = s;
        }
        api.submit(m, words.data(), words.size(), 1);
        api.expect(m, static_cast<std::uint32_t>(s.width), static_cast<std::uint32_t>(s.height));
      }
      const int why = api.run(m, UINT64_MAX, 50'000'000);
      story += " reason " + std::to_string(why);
      if (why != KAGE_RTL_IDLE) return fails("did not come to rest:" + story);
      std::uint64_t got = 0;
      const std::uint8_t* pixels = api.pixels(m, &got);
      const std::uint64_t channels = static_cast<std::uint64_t>(config.channels);
      for (std::uint64_t i = 0; i < std::min<std::uint64_t>(got * channels, expected.size()); ++i)
        if (pixels[i] != expected[i])
          return fails("pixel " + std::to_string(i / channels) + " channel " + std::to_string(i % channels) + " is " +
                       std::to_string(pixels[i]) + ", not " + std::to_string(expected[i]) + ":" + story);
      if (got * channels != expected.size())
        return fails(std::to_string(got) + " pixels, not " + std::to_string(expected.size() / channels) + ":" + story);
      api.clear_pixels(m);
      if (reg(m, KAGE_REG_FRAMES) != ended)
        return fails("FRAMES is " + std::to_string(reg(m, KAGE_REG_FRAMES)) + ":" + story);
      if (reg(m, KAGE_REG_ERRORS) != errors)
        return fails("ERRORS is " + std::to_string(reg(m, KAGE_REG_ERRORS)) + ":" + story);
      if (newest.error != ErrorCode::NONE) {
        const std::uint32_t e = reg(m, KAGE_REG_ERROR);
        if ((e & 15U) != static_cast<std::uint32_t>(newest.error) || e >> 16 != newest.line ||
            reg(m, KAGE_REG_ERROR_FRAME) != newest.frame || reg(m, KAGE_REG_ERROR_TOKEN) != newest.token)
          return fails("error " + std::to_string(e & 15U) + " line " + std::to_string(e >> 16) + " token " +
                       std::to_string(reg(m, KAGE_REG_ERROR_TOKEN)) + ", not " +
                       std::to_string(static_cast<int>(newest.error)) + " line " + std::to_string(newest.line) +
                       " token " + std::to_string(newest.token) + ":" + story);
      }
      if ((reg(m, KAGE_REG_STATUS) & 3U) != 0) return fails("STATUS says that a frame is open:" + story);
      stall();
    }
    kage_rtl_stats stats;
    api.stats(m, &stats);
    if (stats.user_errors + stats.last_errors + stats.extra_pixels + stats.unstable != 0) {
      // Frames cut off by a reset come without an announcement; their pixels were extra ones.
      if (stats.user_errors + stats.last_errors + stats.unstable != 0) return fails("TUSER, TLAST or stability");
    }
    return true;
  }
};

Config config_of(const kage_rtl_table& api) {
  Config c;
  for (std::uint32_t i = 0; i < api.param_count; ++i)
    for (const ParamInfo& p : kParams)
      if (p.name == api.param_names[i]) c.*p.member = api.param_values[i];
  return c;
}

}  // namespace

int main(int argc, char** argv) {
  const char* fixed = std::getenv("KAGE_SEED");
  const char* length = std::getenv("KAGE_ROUNDS");
  const int rounds = length != nullptr ? std::atoi(length) : 60;
  std::random_device device;
  for (int i = 1; i < argc; ++i) {
    void* library = dlopen(argv[i], RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      std::fprintf(stderr, "core_random: %s\n", dlerror());
      return 2;
    }
    const auto function = reinterpret_cast<kage_rtl_api_function>(dlsym(library, KAGE_RTL_API_SYMBOL));
    if (function == nullptr || function()->abi != KAGE_RTL_ABI) {
      std::fprintf(stderr, "core_random: %s: no RTL model of this interface\n", argv[i]);
      return 2;
    }
    const kage_rtl_table& api = *function();
    const std::uint64_t base = fixed != nullptr ? std::strtoull(fixed, nullptr, 0) : device();
    for (int round = 0; round < (fixed != nullptr && length == nullptr ? 1 : rounds); ++round) {
      Trial trial{api, config_of(api), base + static_cast<std::uint64_t>(round), {}};
      if (!trial.run()) {
        std::printf("%s: %s\nrepeat with KAGE_SEED=%llu\n", argv[i], trial.text.c_str(),
                    static_cast<unsigned long long>(trial.seed));
        return 1;
      }
    }
    std::printf("%s: same, %d rounds from seed %llu\n", argv[i], rounds, static_cast<unsigned long long>(base));
  }
  return 0;
}
