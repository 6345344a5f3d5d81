// SPDX-License-Identifier: Apache-2.0
//
// Which named configuration draws a scene at least cost.
#pragma once

#include <cstdint>
#include <vector>

#include "kage/pipeline.hpp"

namespace kage {

// The picture by which costs are judged, whatever size is asked for: so a scene has one configuration for all sizes
// that it fits.
inline constexpr int kJudgedWidth = 640;
inline constexpr int kJudgedHeight = 480;

/// A named configuration that can draw a scene, with what the scene's first frame costs it at 640x480.
struct ChoiceCost {
  NamedConfig named;
  std::uint64_t clocks = 0;        ///< of the frame, by design (docs/rtl.md, "Clocks")
  double luts = 0;                 ///< of the core, estimated
  std::vector<std::string> rough;  ///< approximates(): taken only where no other serves

  /// Clocks times look-up tables: what a picture takes of an FPGA's area and time together.
  [[nodiscard]] double cost() const { return static_cast<double>(clocks) * luts; }
};

/// All named configurations that have what the scene needs and are chosen without being asked for by name, in listed
/// order. Cores with a processor for each pixel or with expansion units are not among them: which of these pays is a
/// question of the design that they go into, not of a scene. Nor is a core without FSF where a later frame might have a
/// second volume, nor one that counts light samples where there is one sample, unless no other serves. Throws as
/// make_geometry() and make_frame() do.
std::vector<ChoiceCost> choices(const SceneFrame& first, const Needs& needs, const DrawOptions& draw);

}  // namespace kage
