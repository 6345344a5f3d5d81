// SPDX-License-Identifier: Apache-2.0
#include "extremes/core_trial.hpp"

#include <algorithm>

#include "kage/config.hpp"
#include "kage/registers.h"
#include "kage/stream.hpp"
#include "stimulus/random_frames.hpp"

namespace kage::verif {
namespace {

/// Fill for the last beat: a core ignores it after END, so noise there must not matter; elsewhere zeros, as the golden
/// core reads.
void fill(std::vector<std::uint32_t>& words, const Config& c, bool sound, Random& random) {
  while (words.size() % static_cast<std::size_t>(c.beat_words) != 0)
    words.push_back(sound ? static_cast<std::uint32_t>(random.integer(0, UINT32_MAX)) : 0U);
}

}  // namespace

std::uint32_t CoreTrial::reg(kage_rtl* m, std::uint32_t address) const {
  std::uint32_t value = 0xDEAD;
  api_.reg_read(m, address, &value);
  return value;
}

/// The model's driver counts every pixel that no announced frame has room for.
void CoreTrial::announce(kage_rtl* m, const Words& words) const {
  const FrameHeader h = FrameHeader::read(words);
  api_.expect(m, static_cast<std::uint32_t>(h.width), static_cast<std::uint32_t>(h.height));
}

bool CoreTrial::run() {
  Random random(seed_);
  kage_rtl* m = api_.create(initial_);
  kage_rtl* other = api_.create(~initial_);  // models do not know of each other, in whatever order they come and go
  const bool good = frames(m, random);
  if (random.chance(0.5)) std::swap(m, other);
  api_.destroy(other);
  api_.destroy(m);
  return good;
}

/// A standstill is named: by the watchdog's interrupt, and in STATUS by what the core waits for.
bool CoreTrial::standstill(kage_rtl* m, Random& random) {
  api_.stalls(m, 65536, 65536, 1);
  api_.reg_write(m, KAGE_REG_WATCHDOG, 300);
  api_.reg_write(m, KAGE_REG_CONTROL, KAGE_CONTROL_WATCHDOG_MASK);
  api_.reg_write(m, KAGE_REG_IRQ, ~0U);
  Words words = sound_frame(random, config_, 5);
  announce(m, words);
  words.resize(words.size() - 1);  // no END, no TLAST
  api_.submit(m, words.data(), words.size(), 0);
  if (api_.run(m, UINT64_MAX, 50'000'000) == KAGE_RTL_ASSERT) return fails("did not come to rest: standstill reason 4");
  if (config_.beat_words == 1) {  // else the fill is an error, and the core waits for TLAST: the same standstill
    if (reg(m, KAGE_REG_STATUS) != (KAGE_STATUS_OPEN_MASK | KAGE_STATUS_WAITING_INPUT_MASK))
      return fails("STATUS does not say that a frame waits for input");
  } else if ((reg(m, KAGE_REG_STATUS) & ~KAGE_STATUS_DRAINING_MASK) !=
             (KAGE_STATUS_OPEN_MASK | KAGE_STATUS_WAITING_INPUT_MASK)) {
    return fails("STATUS does not say that the core waits for input");
  }
  if (api_.irq(m) == 0 || (reg(m, KAGE_REG_IRQ) & KAGE_IRQ_WATCHDOG_MASK) == 0)
    return fails("the watchdog does not bite when input stops");
  api_.reset(m, 1);
  api_.clear_pixels(m);
  api_.stalls(m, 65536, 0, 1);
  api_.reg_write(m, KAGE_REG_WATCHDOG, 300);
  api_.reg_write(m, KAGE_REG_CONTROL, KAGE_CONTROL_WATCHDOG_MASK);
  words = sound_frame(random, config_, 6);
  announce(m, words);
  api_.submit(m, words.data(), words.size(), 1);
  api_.run(m, UINT64_MAX, 8ULL * static_cast<std::uint64_t>(config_.max_width) + 20'000);
  constexpr std::uint32_t kWaits = KAGE_STATUS_OPEN_MASK | KAGE_STATUS_WAITING_OUTPUT_MASK;
  if ((reg(m, KAGE_REG_STATUS) & kWaits) != kWaits) return fails("STATUS does not say that the core waits for output");
  if (api_.irq(m) == 0) return fails("the watchdog does not bite when output stops");
  api_.reset(m, 1);
  api_.clear_pixels(m);
  return true;
}

void CoreTrial::stall(kage_rtl* m, Random& random) const {
  static constexpr std::uint32_t chances[] = {65536, 65536, 60000, 32768, 9000, 2500};
  const std::uint32_t input = chances[random.in(0, 5)];
  const std::uint32_t output = chances[random.in(0, 5)];
  api_.stalls(m, input, output, static_cast<std::uint64_t>(random.integer(0, INT64_MAX - 1)));
}

/// A reset somewhere within a frame.
void CoreTrial::reset(kage_rtl* m, Random& random) const {
  const Words words = sound_frame(random, config_, 99);
  announce(m, words);
  api_.submit(m, words.data(), words.size(), 1);
  api_.run(m, UINT64_MAX, static_cast<std::uint64_t>(random.in(0, 1999)));
  api_.reset(m, static_cast<std::uint32_t>(random.in(1, 3)));
  api_.clear_pixels(m);
}

bool CoreTrial::frames(kage_rtl* m, Random& random) {
  GoldenCore golden(config_);
  if (random.chance(plan_.standstill) && !standstill(m, random)) return false;
  stall(m, random);
  if (reg(m, KAGE_REG_PARAM_HASH) != param_hash(config_)) return fails("PARAM_HASH differs");
  Counts counts;
  for (int number = 0; number < plan_.groups; ++number) {
    if (random.chance(plan_.reset)) {
      reset(m, random);
      counts = {};
    }
    Group group;
    if (!submit(m, random, golden, group, counts) || !same_pixels(m, group) || !same_registers(m, group, counts))
      return false;
    stall(m, random);
  }
  kage_rtl_stats stats;
  api_.stats(m, &stats);
  if (stats.user_errors + stats.last_errors + stats.unstable != 0) return fails("TUSER, TLAST or stability");
  if (stats.extra_pixels != 0) return fails(std::to_string(stats.extra_pixels) + " pixels past the frames' sizes");
  return true;
}

/// Frames, sound and damaged, go in and come to rest.
bool CoreTrial::submit(kage_rtl* m, Random& random, GoldenCore& golden, Group& group, Counts& counts) {
  for (int left = random.in(1, 3); left > 0; --left) {
    const bool is_sound = random.chance(plan_.sound);
    const auto number = static_cast<std::uint32_t>(random.integer(0, UINT32_MAX));
    Words words = is_sound ? sound_frame(random, config_, number) : damaged_frame(random, config_, number);
    fill(words, config_, is_sound, random);
    const FrameStatus s = golden.frame(words, [&](int, std::span<const std::uint8_t> line) {
      group.expected.insert(group.expected.end(), line.begin(), line.end());
    });
    if (is_sound && s.error != ErrorCode::NONE) return fails("the golden core refuses a sound frame");
    group.story += std::string(" ") + std::string(kErrorNames[static_cast<std::size_t>(s.error)]);
    ++counts.ended;
    if (s.error != ErrorCode::NONE) {
      ++counts.errors;
      group.newest = s;
    }
    if (plan_.lost_word) {
      words.erase(words.begin() + std::ssize(words) / 2);
      words.push_back(0);
    }
    api_.submit(m, words.data(), words.size(), 1);
    api_.expect(m, static_cast<std::uint32_t>(s.width), static_cast<std::uint32_t>(s.height));
  }
  const int why = api_.run(m, UINT64_MAX, 50'000'000);
  group.story += " reason " + std::to_string(why);
  return why == KAGE_RTL_IDLE || fails("did not come to rest:" + group.story);
}

bool CoreTrial::same_pixels(kage_rtl* m, const Group& group) {
  std::uint64_t got = 0;
  const std::uint8_t* pixels = api_.pixels(m, &got);
  const std::vector<std::uint8_t>& expected = group.expected;
  const std::uint64_t channels = static_cast<std::uint64_t>(config_.channels);
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(got * channels, expected.size()); ++i)
    if (pixels[i] != expected[i])
      return fails("pixel " + std::to_string(i / channels) + " channel " + std::to_string(i % channels) + " is " +
                   std::to_string(pixels[i]) + ", not " + std::to_string(expected[i]) + ":" + group.story);
  if (got * channels != expected.size())
    return fails(std::to_string(got) + " pixels, not " + std::to_string(expected.size() / channels) + ":" +
                 group.story);
  pixels_ += got;
  api_.clear_pixels(m);
  return true;
}

bool CoreTrial::same_registers(kage_rtl* m, const Group& group, const Counts& counts) {
  if (reg(m, KAGE_REG_FRAMES) != counts.ended)
    return fails("FRAMES is " + std::to_string(reg(m, KAGE_REG_FRAMES)) + ":" + group.story);
  if (reg(m, KAGE_REG_ERRORS) != counts.errors)
    return fails("ERRORS is " + std::to_string(reg(m, KAGE_REG_ERRORS)) + ":" + group.story);
  const FrameStatus& newest = group.newest;
  if (newest.error != ErrorCode::NONE) {
    const std::uint32_t e = reg(m, KAGE_REG_ERROR);
    if (KAGE_FIELD(e, KAGE_ERROR_CODE) != static_cast<std::uint32_t>(newest.error) ||
        KAGE_FIELD(e, KAGE_ERROR_LINE) != newest.line || reg(m, KAGE_REG_ERROR_FRAME) != newest.frame ||
        reg(m, KAGE_REG_ERROR_TOKEN) != newest.token || reg(m, KAGE_REG_ERROR_UNIT) != newest.unit)
      return fails("error " + std::to_string(KAGE_FIELD(e, KAGE_ERROR_CODE)) + " line " +
                   std::to_string(KAGE_FIELD(e, KAGE_ERROR_LINE)) + " token " +
                   std::to_string(reg(m, KAGE_REG_ERROR_TOKEN)) + " unit " +
                   std::to_string(reg(m, KAGE_REG_ERROR_UNIT)) + ", not " +
                   std::to_string(static_cast<int>(newest.error)) + " line " + std::to_string(newest.line) + " token " +
                   std::to_string(newest.token) + " unit " + std::to_string(newest.unit) + ":" + group.story);
  }
  if ((reg(m, KAGE_REG_STATUS) & (KAGE_STATUS_OPEN_MASK | KAGE_STATUS_DRAINING_MASK)) != 0)
    return fails("STATUS says that a frame is open:" + group.story);
  return true;
}

}  // namespace kage::verif
