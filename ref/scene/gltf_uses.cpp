// SPDX-License-Identifier: Apache-2.0
#include "gltf_uses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace kage::scene {
namespace {

// More numbers than these tell a person no more.
constexpr std::size_t kMostNumbers = 8;

enum Type : int {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
};

bool is_whole(int type) { return type != kFloat; }
bool is_small_unsigned(int type) { return type == kUnsignedByte || type == kUnsignedShort; }
bool is_small_signed(int type) { return type == kByte || type == kShort; }

/// Whether a use may have numbers of a type. `quantized`: they take KHR_mesh_quantization.
bool is_allowed(GltfUse use, int type, bool& quantized) {
  quantized = false;
  switch (use) {
    case GltfUse::position:
      quantized = is_small_signed(type) || is_small_unsigned(type);
      return type == kFloat || quantized;
    case GltfUse::normal:
      quantized = is_small_signed(type);
      return type == kFloat || quantized;
    case GltfUse::color:
    case GltfUse::weights:
      return type == kFloat || is_small_unsigned(type);
    case GltfUse::joints:  // unsigned int is told, and no other reading of it is possible
    case GltfUse::indices:
      return is_small_unsigned(type) || type == kUnsignedInt;
    case GltfUse::rotations:
    case GltfUse::morph_weights:
      return type == kFloat || is_small_signed(type) || is_small_unsigned(type);
    default:
      return type == kFloat;
  }
}

/// Uses whose whole numbers stand for values up to 1, so that there is no other way to understand them.
bool is_always_normalized(GltfUse use) {
  return use == GltfUse::normal || use == GltfUse::color || use == GltfUse::weights || use == GltfUse::rotations ||
         use == GltfUse::morph_weights;
}

}  // namespace

const GltfUseFacts& facts_of(GltfUse use) {
  static constexpr std::array<GltfUseFacts, 11> kFacts{{{"POSITION", 3, 3, true},
                                                        {"NORMAL", 3, 3, true},
                                                        {"COLOR_0", 3, 4, true},
                                                        {"JOINTS", 4, 4, true},
                                                        {"WEIGHTS", 4, 4, true},
                                                        {"indices", 1, 1, false},
                                                        {"an animation's times", 1, 1, false},
                                                        {"an animation's vectors", 3, 3, false},
                                                        {"an animation's rotations", 4, 4, false},
                                                        {"an animation's morph weights", 1, 1, false},
                                                        {"a skin's matrices", 16, 16, false}}};
  return kFacts[static_cast<std::size_t>(use)];
}

std::string type_name(int type) {
  static constexpr std::array<const char*, 7> kNames{"byte", "unsigned byte", "short", "unsigned short",
                                                     "",     "unsigned int",  "float"};
  return std::to_string(type) + " (" + kNames[static_cast<std::size_t>(type - kByte)] + ")";
}

GltfReading GltfRemarks::reading(std::uint64_t index, GltfUse use, int type, bool normalized, bool quantized) {
  bool takes_extension = false;
  if (!is_allowed(use, type, takes_extension)) return {false, false};
  const char* const name = facts_of(use).name;
  const auto tell = [&](const char* remark) { add("accessor", index, name, remark); };
  if (takes_extension && !quantized)
    tell("whole numbers without KHR_mesh_quantization, which are taken as if the file named it");
  if (use == GltfUse::joints || use == GltfUse::indices) {
    if (normalized) tell("'normalized', which is ignored: they are numbers of things");
    if (use == GltfUse::joints && type == kUnsignedInt)
      tell("numbers of type unsigned int, which are read all the same");
    return {true, false};
  }
  if (!is_whole(type)) {
    if (normalized) tell("'normalized', which is ignored: its numbers are floats");
    return {true, false};
  }
  if (!normalized && is_always_normalized(use)) {
    tell("whole numbers without 'normalized', which are taken as normalized");
    return {true, true};
  }
  return {true, normalized};
}

void GltfRemarks::note(std::vector<std::string>& notes) const {
  for (const auto& [key, numbers] : found_) {
    const auto& [what, of, remark] = key;
    std::string text = what + (numbers.size() == 1 ? "" : "s");
    std::size_t told = 0;
    for (const std::uint64_t number : numbers) {
      if (told == kMostNumbers) break;
      text += told++ == 0 ? " " : ", ";
      text += std::to_string(number);
    }
    if (numbers.size() > told) text += fmt::format(" and {} more", numbers.size() - told);
    if (!of.empty()) text += fmt::format(" ({})", of);
    notes.push_back(fmt::format("{} {} {}", text, numbers.size() == 1 ? "has" : "have", remark));
  }
  notes.insert(notes.end(), sentences_.begin(), sentences_.end());
}

}  // namespace kage::scene
