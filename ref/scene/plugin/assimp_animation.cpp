// SPDX-License-Identifier: Apache-2.0
#include "scene/plugin/assimp_animation.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

#include "number/counted.hpp"
#include "scene/notes.hpp"
#include "scene/plugin/assimp_values.hpp"

namespace kage::scene::mesh_plugin {
namespace {

void read_channel(const aiNodeAnim& channel, const NodeNames& node_of, const std::vector<const aiNode*>& nodes,
                  RawScene& scene) {
  const auto found = node_of.find(text(channel.mNodeName));
  if (found == node_of.end()) return;
  RawNode& node = scene.nodes[found->second];
  // Keys replace the node's map. Scale, rotation or position without keys keep their part of it.
  aiVector3D scale;
  aiQuaternion rotation;
  aiVector3D position;
  nodes[found->second]->mTransformation.Decompose(scale, rotation, position);
  const auto start = [&](RawPath path) {
    RawTrack t;
    t.node = found->second;
    t.path = path;
    return t;
  };
  const auto push = [](RawTrack& t, double time, std::initializer_list<double> value) {
    if (!std::isfinite(time) || (!t.times.empty() && time <= t.times.back()))
      return;  // a key that goes back is skipped
    t.times.push_back(time);
    t.values.insert(t.values.end(), value);
  };
  RawTrack translation = start(RawPath::kTranslation);
  RawTrack turn = start(RawPath::kRotation);
  RawTrack size = start(RawPath::kScale);
  for (unsigned i = 0; i < channel.mNumPositionKeys; ++i) {
    const aiVectorKey& k = channel.mPositionKeys[i];
    push(translation, k.mTime, {k.mValue.x, k.mValue.y, k.mValue.z});
  }
  for (unsigned i = 0; i < channel.mNumRotationKeys; ++i) {
    const aiQuatKey& k = channel.mRotationKeys[i];
    push(turn, k.mTime, {k.mValue.x, k.mValue.y, k.mValue.z, k.mValue.w});
  }
  for (unsigned i = 0; i < channel.mNumScalingKeys; ++i) {
    const aiVectorKey& k = channel.mScalingKeys[i];
    push(size, k.mTime, {k.mValue.x, k.mValue.y, k.mValue.z});
  }
  if (translation.times.empty() && turn.times.empty() && size.times.empty()) return;
  node.fixed = false;
  node.translation = vec3(position);
  node.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
  node.scale = vec3(scale);
  for (RawTrack* t : {&translation, &turn, &size})
    if (!t->times.empty()) scene.tracks.push_back(std::move(*t));
}

}  // namespace

void read_animation(const aiScene& in, const NodeNames& node_of, const std::vector<const aiNode*>& nodes,
                    RawScene& scene) {
  if (in.mNumAnimations == 0 || in.mAnimations[0] == nullptr) return;
  const aiAnimation& animation = *in.mAnimations[0];
  for (unsigned i = 0; i < animation.mNumChannels; ++i)
    if (animation.mChannels[i] != nullptr) read_channel(*animation.mChannels[i], node_of, nodes, scene);
  if (!scene.tracks.empty()) {
    scene.start_time = scene.tracks[0].times[0];
    for (const RawTrack& t : scene.tracks) scene.start_time = std::min(scene.start_time, t.times[0]);
  }
  if (in.mNumAnimations > 1)
    scene.notes.push_back(counted(in.mNumAnimations - 1, "animation is", "animations are") +
                          " ignored: the first is played");
}

}  // namespace kage::scene::mesh_plugin
