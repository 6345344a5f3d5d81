// SPDX-License-Identifier: Apache-2.0
#include "gltf_animation.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "notes.hpp"
#include "number/counted.hpp"

namespace kage::scene {

// Whether a channel moves a node or a mesh's morph targets, which is all that is drawn of animations; others are
// counted.
bool GltfAnimation::is_drawn_path(const Json& target, const std::string& path, bool has_node,
                                  const std::string& place) {
  if (path == "pointer") {
    const Json& pointer = file_->extension(target, "KHR_animation_pointer", place);
    const bool visibility = file_->text(pointer, "pointer", place).find("/KHR_node_visibility/") != std::string::npos;
    ++(visibility ? counts_.blinking : counts_.pointed);
    return false;
  }
  if (has_node && (path == "weights" || path == "translation" || path == "rotation" || path == "scale")) return true;
  ++counts_.unknown;
  return false;
}

void GltfAnimation::read_channel(const Json& animation, const Json& channel, const NodeNumbers& node_of,
                                 const std::string& place) {
  const Json& target = file_->object(channel, "target", place);
  const auto node = file_->integer(target, "node", place);
  const std::string path = file_->text(target, "path", place);
  const auto sampler_index = file_->integer(channel, "sampler", place);
  const Json& samplers = file_->array(animation, "samplers", place);
  const std::size_t nodes = file_->count("nodes");
  if (node && *node >= nodes)
    file_->fail(place, "asks for number " + std::to_string(*node) + " of " + std::to_string(nodes) + " nodes");
  if (!is_drawn_path(target, path, node.has_value(), place)) return;
  if (const auto [at, fresh] = channel_of_.try_emplace({*node, path}, place); !fresh)
    file_->fail(place, "moves node " + std::to_string(*node) + " (" + path + "), as " + at->second + " does");
  const auto known = node_of.find(*node);
  if (known == node_of.end()) return;  // of another scene

  RawTrack track;
  track.node = known->second;
  track.path = path == "translation" ? RawPath::kTranslation
               : path == "rotation"  ? RawPath::kRotation
               : path == "scale"     ? RawPath::kScale
                                     : RawPath::kWeights;
  track.targets = static_cast<std::uint32_t>(scene_->nodes[track.node].weights.size());
  if (track.path == RawPath::kWeights && track.targets == 0) {
    ++counts_.morphs;
    return;
  }
  if (!sampler_index) file_->fail(place, "names no sampler");
  const Json& sampler = file_->item_of(samplers, *sampler_index, "samplers", place);
  const std::string interpolation = file_->text(sampler, "interpolation", place);
  if (!interpolation.empty() && interpolation != "LINEAR" && interpolation != "STEP" && interpolation != "CUBICSPLINE")
    file_->fail(place, "interpolation '" + one_line(interpolation, 40) + "' is unknown");
  if (interpolation == "STEP") track.interpolation = RawInterpolation::kStep;
  if (interpolation == "CUBICSPLINE") track.interpolation = RawInterpolation::kCubic;
  const auto input = file_->integer(sampler, "input", place);
  const auto output = file_->integer(sampler, "output", place);
  if (!input || !output) file_->fail(place, "its sampler has no input or output");
  const std::vector<float> times = file_->floats(*input, GltfUse::times, place).values;
  const GltfUse use = track.path == RawPath::kWeights    ? GltfUse::morph_weights
                      : track.path == RawPath::kRotation ? GltfUse::rotations
                                                         : GltfUse::vectors;
  const std::vector<float> values = file_->floats(*output, use, place).values;
  const std::size_t per_key = track.width() * (track.interpolation == RawInterpolation::kCubic ? 3 : 1);
  if (values.size() != times.size() * per_key) file_->fail(place, "has not one value for each time");
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      file_->fail(place, "key " + std::to_string(i) + " is not later than the one before");
  for (std::size_t i = 0; track.path == RawPath::kRotation && i < times.size(); ++i) {
    const std::size_t part = track.interpolation == RawInterpolation::kCubic ? 3 * i + 1 : i;
    if (std::all_of(values.begin() + static_cast<std::ptrdiff_t>(4 * part),
                    values.begin() + static_cast<std::ptrdiff_t>(4 * part + 4), [](float v) { return v == 0; }))
      file_->fail(place, "key " + std::to_string(i) + " is a quaternion of length 0");
  }
  track.times.assign(times.begin(), times.end());
  track.values.assign(values.begin(), values.end());
  if (times.empty()) return;
  // A matrix is not to be animated, says the format; a track then replaces it, as it does a translation or rotation.
  bool& fixed = scene_->nodes[track.node].fixed;
  counts_.matrices += track.path != RawPath::kWeights && fixed ? 1 : 0;
  if (track.path != RawPath::kWeights) fixed = false;
  scene_->tracks.push_back(std::move(track));
}

void GltfAnimation::read(const NodeNumbers& node_of) {
  const std::size_t animations = file_->count("animations");
  if (animations == 0) return;
  const Json& animation = file_->item("animations", 0, "JSON");
  const Json& channels = file_->array(animation, "channels", "animation 0");
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string place = "animation 0 channel " + std::to_string(i);
    if (!channels[i].is_object()) file_->fail(place, "not an object");
    read_channel(animation, channels[i], node_of, place);
  }
  if (animations > 1)
    scene_->notes.push_back(counted(animations - 1, "animation is", "animations are") +
                            " ignored: the first is played");
}

}  // namespace kage::scene
