// SPDX-License-Identifier: Apache-2.0
//
// Demands of the frames of scenes on a core: found by making all of them once with widths that lose next to nothing.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kage/config.hpp"
#include "kage/plan.hpp"

namespace kage::plan {

/// CLASS_BITS that a plan may have.
inline constexpr std::array kClassSteps{4, 8, 11};

/// A greatest number and where it was found.
struct Most {
  double value = 0;
  PlanPlace at;

  void raise(double v, const PlanPlace& place) {
    if (at.scene >= 0 && !(v > value)) return;
    value = v;
    at = place;
  }
};

/// Demands of scenes that do not depend on the way shadows are drawn.
struct Features {
  Needs needs;  ///< of all frames together
  Most width;   ///< of a picture
  Most height;
};

/// A light's share of a colour in 2^-16, and the samples of that light that may all be in shadow.
struct Share {
  std::uint32_t value = 0;
  int samples = 1;
};

/// Shares that darken one pixel together: all lights of one class and channel.
struct ShareGroup {
  std::vector<Share> shares;
  PlanPlace at;
};

/// How shadows are drawn: by volumes that DSF counts with so many bits, and by a table or a light after the other.
struct ShadowWay {
  int dsf_bits = 0;
  bool linear = false;  ///< light after light
};

/// Demands of one way to draw shadows.
struct WayDemand {
  ShadowWay way;
  Most volumes;                                       ///< of a light sample
  Most depth_span;                                    ///< pixels along which depth goes on by steps
  Most color_span;                                    ///< pixels along which colour does
  std::array<Most, kClassSteps.size()> class_errors;  ///< LightDemand::share_error by a table of each step
  std::vector<ShareGroup> groups;                     ///< what shadows take, without repetition
  Most lights;                                        ///< with light after light: passes of a line
  Most lit_samples;                                   ///< likewise: samples of all lights
};

/// Expansion units that hold all polyhedra that can go to one.
struct UnitDemand {
  Most units;       ///< 0: no frame has a polyhedron
  Most faces;       ///< of a unit
  Most dx;          ///< pixels of a segment
  Most segments;    ///< of a unit's line
  Most bodies;      ///< polyhedra in units
  Most last_index;  ///< draw index of the last polyhedron in a unit
};

/// A front end that holds all polygons that can go as such.
struct FrontEndDemand {
  Most active;              ///< polygons at once on a line
  std::uint64_t left = 0;   ///< those for which no front end has room
  std::uint64_t words = 0;  ///< of all frames
};

/// Called before each frame.
using FrameStep = std::function<void()>;

/// Counts the frames of a scene.
int frames_of(const PlannedScene& scene);

Features features_of(std::span<const PlannedScene> scenes);

/// A configuration that draws scenes with these features in this way by `units`, with the finest fractions. More lights
/// than a table has come one after the other in any way.
Config finest(const Features& features, ShadowWay way, int units);

WayDemand demand_of(std::span<const PlannedScene> scenes, const Features& features, ShadowWay way,
                    const FrameStep& step);

/// The most columns of the picture that an opaque polygon has which is diced: its parts' depth is that of a span so
/// long.
int longest_diced(const FrameGeometry& geometry);

UnitDemand unit_demand_of(std::span<const PlannedScene> scenes, const Features& features, const FrameStep& step);

/// The front end that the scenes need in a core of this configuration, whatever its ACTIVE.
FrontEndDemand front_end_demand_of(std::span<const PlannedScene> scenes, Config config, const FrameStep& step);

/// "frame 3, line 211", with the scene's name if there are several.
std::string text_of(std::span<const PlannedScene> scenes, const PlanPlace& place);

}  // namespace kage::plan
