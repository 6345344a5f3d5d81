// SPDX-License-Identifier: Apache-2.0
//
// The shadow volumes of a frame, for one point of a light after the other.
#pragma once

#include <functional>
#include <vector>

#include "kage/shadow.hpp"
#include "shadow/kept.hpp"
#include "shadow/light_space.hpp"
#include "shadow/shadow_caster.hpp"
#include "shadow/world_volume.hpp"

namespace kage {

/// Takes a volume and the component of its first caster.
using VolumeSink = std::function<void(const WorldVolume&, std::uint32_t component)>;

class VolumeCaster {
 public:
  /// Refers to `frame`, `boxes`, which are those of its components, and `kept`, which is that of frames before.
  /// `dsf_bits`: bits that the core counts with, >= 1.
  VolumeCaster(const SceneFrame& frame, std::span<const SpaceBox> boxes, int dsf_bits, VolumeWay way,
               ShadowCacheInside::Data& kept);

  /// Call `sink` with every volume of a light sample, in order of their first casters. No ray of light meets more than
  /// 2^dsf_bits - 1 caps of a volume. `sample`: its number.
  /// With one bit a convex component with the light outside is a volume, and so is each patch (make_patches()) of
  /// another. With more bits all casters are one volume if bound_count() allows it. Else components are put together,
  /// each in the first volume that it fits in. A component that does not fit in a volume by itself is first parted into
  /// patches.
  void make(std::size_t sample, const ShadowCaster& caster, const VolumeSink& sink);

 private:
  /// Caps that go into a volume as a whole: those of a component or a patch.
  struct Part {
    std::vector<CapFace> caps;
    std::uint32_t component = 0;
    int most = 1;  // caps on a ray of light, at most
    LightBox box;
  };
  struct Group {
    std::vector<const Part*> parts;
    std::vector<CapFace> caps;
  };

  void make_parity(const ShadowCaster& caster);
  void make_counting(const ShadowCaster& caster);
  void add(std::span<const CapFace> caps, std::uint32_t component);
  [[nodiscard]] const std::vector<std::vector<CapFace>>& patches(const LightSpace& space, const ShadowCaster& caster,
                                                                 std::uint32_t component,
                                                                 const std::vector<CapFace>& caps);
  [[nodiscard]] bool once(const ShadowCaster& caster, std::uint32_t component) const;
  [[nodiscard]] int most(const LightSpace& space, std::span<const CapFace> caps);
  void add_parts(const LightSpace& space, const ShadowCaster& caster, std::uint32_t component,
                 const std::vector<CapFace>& caps, std::vector<Part>& parts);
  [[nodiscard]] bool fits(const LightSpace& space, const Group& group, const Part& part, std::uint64_t& budget);

  const SceneFrame* frame_;
  std::span<const SpaceBox> boxes_;
  ShadowCacheInside::Data* kept_;
  KeptSample* sample_ = nullptr;  // the one being made
  std::vector<KeptSample::Volume> made_;
  int limit_;
  VolumeWay way_;
  std::vector<SideEdge> sides_;
};

}  // namespace kage
