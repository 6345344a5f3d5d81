// SPDX-License-Identifier: Apache-2.0
#include "simd/targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "kage/error.hpp"

namespace kage::simd {

std::atomic<std::size_t> chosen_index{kNotChosen};

namespace {

std::atomic<std::int64_t> chosen_bit{0};

std::string name_of(std::int64_t bit) {
  std::string name = hwy::TargetName(bit);
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return name;
}

/// Best first: the lower bit is the better target.
std::vector<Target> targets_of(std::int64_t bits) {
  std::vector<Target> targets;
  for (; bits != 0; bits &= bits - 1) targets.push_back({bits & -bits, name_of(bits & -bits)});
  return targets;
}

/// HWY_EXPORT's tables begin with an entry of Highway's own, then have one for each target that dispatch knows, and the
/// fallback; with one target alone they have no more than that.
std::size_t index_of(std::int64_t bit) {
#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0
  (void)bit;
  return 0;
#else
  hwy::ChosenTarget one;
  one.Update(bit);
  return one.GetIndex();
#endif
}

const Target* find(const std::vector<Target>& targets, const std::string& name) {
  const auto at = std::find_if(targets.begin(), targets.end(), [&](const Target& t) { return t.name == name; });
  return at != targets.end() ? &*at : nullptr;
}

std::string names(const std::vector<Target>& targets) {
  std::string text;
  for (const Target& t : targets) text += (text.empty() ? "" : ", ") + t.name;
  return text;
}

/// The target that KAGE_SIMD names, or the best.
Target asked_for() {
  const std::vector<Target> here = available();
  const char* const name = std::getenv("KAGE_SIMD");
  if (name == nullptr || *name == '\0') return here.front();
  if (const Target* const found = find(here, name)) return *found;
  if (find(targets_of(HWY_TARGETS), name) != nullptr)
    throw Error(
        fmt::format("KAGE_SIMD={}: this CPU does not have that instruction set; it can run {}", name, names(here)));
  throw Error(fmt::format("KAGE_SIMD={}: this build of kage has no such instruction set; it can run {} here", name,
                          names(here)));
}

}  // namespace

std::vector<Target> available() { return targets_of(hwy::SupportedTargets() & HWY_TARGETS); }

void use(const Target& target) {
  chosen_bit = target.bit;
  chosen_index = index_of(target.bit);
}

std::size_t choose() {
  use(asked_for());
  return chosen_index;
}

Target in_use() {
  (void)index();
  return {chosen_bit, name_of(chosen_bit)};
}

}  // namespace kage::simd
