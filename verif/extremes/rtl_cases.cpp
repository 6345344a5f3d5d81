// SPDX-License-Identifier: Apache-2.0
#include "extremes/rtl_cases.hpp"

#include <fmt/format.h>

#include "extremes/core_trial.hpp"
#include "kage/core.hpp"
#include "kage/stream.hpp"
#include "stimulus/frames.hpp"

namespace kage::verif {
namespace {

constexpr std::array kModels{"lanes1", "flat4", "systolic64", "tree3", "glass1", "glass4", "soft4", "lights4"};
/// Groups of models: within a group, all parameters that affect pixels are the same.
constexpr std::array<std::array<const char*, 3>, 2> kGroups{
    {{"lanes1", "flat4", "systolic64"}, {"glass1", "glass4", nullptr}}};
/// Clocks of any case at most.
constexpr std::uint64_t kClocks = 50'000'000;

const CoreModel& model_of(const Context& context, const char* name) {
  if (context.models == nullptr) throw std::runtime_error("a case of the RTL without models");
  return context.models->named(name);
}

}  // namespace

const std::vector<const char*>& model_names() {
  static const std::vector<const char*> names(kModels.begin(), kModels.end());
  return names;
}

std::vector<std::uint8_t> rtl_pixels(const CoreModel& model, const std::vector<std::uint32_t>& words,
                                     std::uint64_t seed, std::string& wrong) {
  const kage_rtl_table& api = *model.api;
  kage_rtl* m = api.create(seed);
  Random random(seed);
  api.stalls(m, static_cast<std::uint32_t>(random.in(8000, 65536)), static_cast<std::uint32_t>(random.in(8000, 65536)),
             seed);
  const FrameHeader h = FrameHeader::read(words);
  api.expect(m, static_cast<std::uint32_t>(h.width), static_cast<std::uint32_t>(h.height));
  api.submit(m, words.data(), words.size(), 1);
  std::vector<std::uint8_t> pixels;
  if (api.run(m, UINT64_MAX, kClocks) != KAGE_RTL_IDLE) {
    wrong = "did not come to rest";
  } else {
    std::uint64_t count = 0;
    const std::uint8_t* data = api.pixels(m, &count);
    pixels.assign(data, data + count * static_cast<std::uint64_t>(model.config.channels));
  }
  api.destroy(m);
  return pixels;
}

std::string light_line_wrong(const CoreModel& model, std::uint64_t seed, int width,
                             const std::vector<LightSample>& samples, const std::vector<std::uint32_t>& shares,
                             const Context& context) {
  constexpr int kFrames = 2;
  const kage_rtl_table& api = *model.api;
  const Config& c = model.config;
  const auto words = light_frame(c, width, samples, shares);
  kage_rtl* m = api.create(seed);
  api.stalls(m, seed % 2 == 0 ? 65536 : 30000, seed % 3 == 0 ? 30000 : 65536, seed);
  for (int i = 0; i < kFrames; ++i) {
    api.expect(m, static_cast<std::uint32_t>(width), 1);
    api.submit(m, words.data(), words.size(), 1);
  }
  const int why = api.run(m, UINT64_MAX, kClocks);
  std::uint64_t count = 0;
  const std::uint8_t* const made = api.pixels(m, &count);
  std::vector<std::uint8_t> pixels(made, made + count * static_cast<std::uint64_t>(c.channels));
  context.spoil(pixels);
  std::string wrong;
  if (why != KAGE_RTL_IDLE || count != static_cast<std::uint64_t>(kFrames) * static_cast<std::uint64_t>(width))
    wrong = "did not come to rest, or lost pixels";
  for (int i = 0; wrong.empty() && i < kFrames * width * c.channels; ++i) {
    const int expected = light_pixel(c, i / c.channels % width, samples, shares);
    const int got = pixels[static_cast<std::size_t>(i)];
    if (got != expected)
      wrong = fmt::format("pixel {} channel {} is {}, not {}", i / c.channels, i % c.channels, got, expected);
  }
  api.destroy(m);
  return wrong;
}

// ---- 12

void SamePixelsCase::fields(Fields& f) {
  f.choice("group", group, std::array{"spans", "glass"});
  f.number("width", width, 1, 64, 8);
  f.number("height", height, 1, 6, 1);
  f.number("words", words, 0, 1'000'000);
  f.number("stalls", stalls, 0, 1'000'000);
}

Outcome SamePixelsCase::check(const Context& context) const {
  Outcome o;
  std::vector<std::uint32_t> frame;
  std::vector<std::uint8_t> expected;
  for (const char* name : kGroups[static_cast<std::size_t>(group)]) {
    if (name == nullptr) continue;
    const CoreModel& model = model_of(context, name);
    if (frame.empty()) {
      Random random(static_cast<std::uint64_t>(words));
      random_frame(random, model.config, width, height, frame);
      GoldenCore(model.config).frame(frame, [&](int, std::span<const std::uint8_t> line) {
        expected.insert(expected.end(), line.begin(), line.end());
      });
    }
    std::string wrong;
    auto pixels = rtl_pixels(model, frame, static_cast<std::uint64_t>(stalls), wrong);
    context.spoil(pixels);
    if (!wrong.empty()) o.fail(fmt::format("{} {}", name, wrong));
    if (pixels != expected) o.fail(fmt::format("{} and the golden core differ", name));
    o.pixels += static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  }
  return o;
}

// ---- 29

void RtlSamplesCase::fields(Fields& f) {
  f.flag("several", several);
  f.number("stalls", stalls, 0, 1'000'000);
  line.fields(f);
}

Outcome RtlSamplesCase::check(const Context& context) const {
  const CoreModel& model = model_of(context, several ? "lights4" : "soft4");
  SamplesCase fit = line;
  fit.lights = model.config.lights;
  constexpr int kWidth = 40;
  Outcome o;
  o.fail(light_line_wrong(model, static_cast<std::uint64_t>(stalls), kWidth, fit.all(), fit.shares(model.config),
                          context));
  o.pixels = std::uint64_t{2} * kWidth;
  return o;
}

// ---- 39 - 41

void TrialCase::fields(Fields& f) {
  f.choice("model", model, kModels);
  f.number("groups", groups, 1, 4, 1);
  f.number("frames", frames, 0, 1'000'000'000);
  f.number("initial", initial, 0, 1'000'000'000);
}

Outcome TrialCase::run(const Context& context, double sound, double reset, double standstill) const {
  CoreTrial trial(model_of(context, kModels[static_cast<std::size_t>(model)]), static_cast<std::uint64_t>(frames),
                  static_cast<std::uint64_t>(initial),
                  {groups, sound, reset, standstill, context.injected(Injection::lost_word)});
  Outcome o;
  if (!trial.run()) o.fail(trial.text());
  o.pixels = trial.pixels();
  o.items = 1;
  return o;
}

Outcome InitialStateCase::check(const Context& context) const {
  Outcome o;
  InitialStateCase again = *this;
  for (int i = 0; i < 3; ++i) {
    o.add(again.run(context, 0.7, 0.2, 0));
    ++again.initial;
  }
  return o;
}

void add_rtl_families(Families& to) {
  const auto rtl = [](int number, const char* name, const char* what) {
    return FamilyInfo(number, name, what, {}, 0, 1, true);
  };
  add_family<SamePixelsCase>(to, rtl(12, "12", "the same words in any arrangement"));
  add_family<RtlSamplesCase>(to, rtl(29, "29 core", "samples of lights, as many as a counter holds, and more"));
  add_family<StallsCase>(to, rtl(39, "39", "stalls, resets, frames back to back or of one pixel"));
  add_family<DamageCase>(to, rtl(40, "40", "flipped, cut, lost, doubled words at the port"));
  add_family<InitialStateCase>(to, rtl(41, "41", "any initial state of registers and memories"));
}

}  // namespace kage::verif
