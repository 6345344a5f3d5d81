// SPDX-License-Identifier: Apache-2.0
#include "extremes/family.hpp"

#include <fmt/format.h>

#include <exception>

namespace kage::verif {
namespace {

constexpr std::array kInjections{"none",        "wide_span",    "steep_step",    "lost_layer",   "lost_face",
                                 "near_cap",    "swapped_pair", "moved_corner",  "tilted_plane", "wrong_pixel",
                                 "large_share", "finite_value", "lost_fragment", "lost_word"};

}  // namespace

void Outcome::measure(double error, double at_most) {
  if (!(error <= at_most)) fail(fmt::format("the error is {}, the bound {}", error, at_most));
  if (at_most > 0 && error / at_most >= share()) worst = error, bound = at_most;
}

void Outcome::add(const Outcome& o) {
  pixels += o.pixels;
  items += o.items;
  if (o.bound > 0 && (bound == 0 || o.share() > share())) worst = o.worst, bound = o.bound;
  if (!o.wrong.empty()) fail(o.wrong);
}

const std::vector<std::string>& injection_names() {
  static const std::vector<std::string> names(kInjections.begin() + 1, kInjections.end());
  return names;
}

std::optional<Injection> injection_of(const std::string& name) {
  for (std::size_t i = 1; i < kInjections.size(); ++i)
    if (name == kInjections[i]) return static_cast<Injection>(i);
  return std::nullopt;
}

std::uint64_t start_state(const std::string& family, std::uint64_t seed, std::uint64_t index) {
  std::uint64_t h = seed;
  const auto mix = [&h](std::uint64_t v) {  // splitmix64
    h += v + 0x9E3779B97F4A7C15U;
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9U;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBU;
    h ^= h >> 31;
  };
  for (const char c : family) mix(static_cast<unsigned char>(c));
  mix(index);
  return h;
}

Outcome guarded(const std::function<Outcome()>& check) {
  try {
    return check();
  } catch (const std::exception& e) {
    Outcome o;
    o.fail(fmt::format("an error: {}", e.what()));
    return o;
  }
}

}  // namespace kage::verif
