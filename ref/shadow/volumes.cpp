// SPDX-License-Identifier: Apache-2.0
#include "shadow/volumes.hpp"

#include <algorithm>
#include <utility>

#include "shadow/patches.hpp"

namespace kage {
namespace {

// Caps that bound_count() may look at in a frame's sample while parts are put together. Beyond it parts share a volume
// only where rectangles tell that they may.
constexpr std::uint64_t kTrials = 2'000'000;

}  // namespace

VolumeCaster::VolumeCaster(const SceneFrame& frame, std::span<const SpaceBox> boxes, int dsf_bits, VolumeWay way,
                           ShadowCacheInside::Data& kept)
    : frame_(&frame), boxes_(boxes), kept_(&kept), limit_((1 << dsf_bits) - 1), way_(way) {
  kept.take(frame, limit_, way);
}

void VolumeCaster::make(std::size_t sample, const ShadowCaster& caster, const VolumeSink& sink) {
  sample_ = &kept_->sample(sample, caster);
  if (!sample_->volumes) {
    made_.clear();
    if (limit_ == 1 || way_ == VolumeWay::per_face)
      make_parity(caster);
    else
      make_counting(caster);
    sample_->volumes = std::move(made_);  // whole, or not at all
  }
  for (const KeptSample::Volume& v : *sample_->volumes) sink(v.volume, v.component);
}

void VolumeCaster::add(std::span<const CapFace> caps, std::uint32_t component) {
  KeptSample::Volume& v = made_.emplace_back();
  v.volume.caps.assign(caps.begin(), caps.end());
  kept_->edges().sides(*frame_, caps, v.volume.sides);
  v.component = component;
}

const std::vector<std::vector<CapFace>>& VolumeCaster::patches(const LightSpace& space, const ShadowCaster& caster,
                                                               std::uint32_t component,
                                                               const std::vector<CapFace>& caps) {
  auto& kept = sample_->patches[component];
  if (!kept) kept = make_patches(*frame_, caster.light(), kept_->edges(), space, caps);
  return *kept;
}

// Whether no ray of light meets two caps of the component, which is convex.
bool VolumeCaster::once(const ShadowCaster& caster, std::uint32_t component) const {
  return frame_->components[component].convex && caster.light_outside(boxes_[component]);
}

void VolumeCaster::make_parity(const ShadowCaster& caster) {
  std::vector<CapFace> caps;
  for (std::uint32_t c = 0; c < frame_->components.size(); ++c) {
    const Component& part = frame_->components[c];
    if (part.translucent) continue;
    caster.caps(part, boxes_[c], caps);
    if (caps.empty()) continue;
    if (once(caster, c)) {
      add(caps, c);
    } else if (way_ == VolumeWay::per_face) {
      for (const CapFace& cap : caps) add(std::span(&cap, 1), c);
    } else {
      const LightSpace space(*frame_, caster.light(), caps);
      for (const auto& patch : patches(space, caster, c, caps)) add(patch, c);
    }
  }
}

int VolumeCaster::most(const LightSpace& space, std::span<const CapFace> caps) {
  kept_->edges().sides(*frame_, caps, sides_);
  return space.count(caps, sides_, limit_).high;
}

void VolumeCaster::make_counting(const ShadowCaster& caster) {
  std::vector<std::vector<CapFace>> of_component(frame_->components.size());
  std::vector<CapFace> all;
  std::uint32_t first = ~0U;
  for (std::uint32_t c = 0; c < frame_->components.size(); ++c) {
    if (frame_->components[c].translucent) continue;
    caster.caps(frame_->components[c], boxes_[c], of_component[c]);
    if (of_component[c].empty()) continue;
    first = std::min(first, c);
    all.insert(all.end(), of_component[c].begin(), of_component[c].end());
  }
  if (all.empty()) return;
  const LightSpace space(*frame_, caster.light(), all);
  if (most(space, all) <= limit_) {
    add(all, first);
    return;
  }
  std::vector<Part> parts;
  for (std::uint32_t c = 0; c < frame_->components.size(); ++c)
    if (!of_component[c].empty()) add_parts(space, caster, c, of_component[c], parts);
  std::vector<Group> groups;
  std::uint64_t budget = kTrials;
  for (const Part& part : parts) {
    auto it = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return fits(space, g, part, budget); });
    if (it == groups.end()) it = groups.emplace(groups.end());
    it->parts.push_back(&part);
    it->caps.insert(it->caps.end(), part.caps.begin(), part.caps.end());
  }
  for (const Group& g : groups) add(g.caps, g.parts.front()->component);
}

// A component, or, where too many of its caps may lie behind one another, its patches.
void VolumeCaster::add_parts(const LightSpace& space, const ShadowCaster& caster, std::uint32_t component,
                             const std::vector<CapFace>& caps, std::vector<Part>& parts) {
  const auto add_part = [&](const std::vector<CapFace>& of_part, int count) {
    Part p;
    p.caps = of_part;
    p.component = component;
    p.most = count;
    p.box = space.box(frame_->polygons[p.caps.front().polygon]);
    for (const CapFace& cap : p.caps) p.box.add(space.box(frame_->polygons[cap.polygon]));
    parts.push_back(std::move(p));
  };
  const int count = once(caster, component) ? 1 : most(space, caps);
  if (count <= limit_) {
    add_part(caps, count);
    return;
  }
  for (const auto& patch : patches(space, caster, component, caps)) add_part(patch, 1);
}

// On a ray of light in the part's rectangle lie at most its own caps and those of the parts whose rectangles overlap
// it; on any other as many as before. Where that is too many to tell, the edges of those parts are asked.
bool VolumeCaster::fits(const LightSpace& space, const Group& group, const Part& part, std::uint64_t& budget) {
  int sum = part.most;
  std::vector<CapFace> caps = part.caps;
  for (const Part* p : group.parts)
    if (p->box.overlaps(part.box)) {
      sum += p->most;
      caps.insert(caps.end(), p->caps.begin(), p->caps.end());
    }
  if (sum <= limit_) return true;
  if (caps.size() > budget) return false;
  budget -= caps.size();
  return most(space, caps) <= limit_;
}

}  // namespace kage
