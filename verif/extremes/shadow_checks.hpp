// SPDX-License-Identifier: Apache-2.0
//
// Rules for any frame with shadow volumes.
#pragma once

#include <span>

#include "extremes/family.hpp"
#include "oracle/judge.hpp"
#include "stimulus/shapes.hpp"

namespace kage::verif {

/// Boxes over a floor, in threes and in this order: a box, one round it, and one that overlaps or touches them, `aside`
/// of them.
SceneFrame box_threes(std::span<const int> order, double aside);

/// `n` parallel panes, one behind another as the light sees them, joined by strips to one mesh: a zigzag.
SceneFrame zigzag_scene(int n);

/// A core whose shadow volumes are counted in so many bits; 1: parity.
inline Config counting(int bits) {
  Config c;
  c.dsf_bits = bits;
  return c;
}

/// The golden core's picture is the oracle's.
Outcome picture_is_the_oracles(const FrameGeometry& g, const Config& config, const Context& context = {});

/// With near and far caps the toggles of every volume sum to zero at every pixel: volumes are closed. Its items are
/// pixels of volumes.
Outcome volumes_are_closed(const SceneFrame& f, const Config& config, int width, int height,
                           const Context& context = {}, Look look = {});

/// Whether a ray to the light says the same of each pixel, up to near ties.
Outcome picture_is_the_rays(const SceneFrame& f, const FrameGeometry& g, const Config& config,
                            const Context& context = {});

/// Two geometries of a frame: how many pixels of their pictures differ. Where one does, one of them must be a near tie.
struct TwoPictures {
  std::size_t pixels = 0;
  std::size_t different = 0;
  std::size_t wrong = 0;    ///< differ, and are no near tie of either
  std::string first_wrong;  ///< the first of those

  [[nodiscard]] Outcome outcome() const;
};
TwoPictures same_but_near_ties_count(const FrameGeometry& a, const Config& ca, const FrameGeometry& b,
                                     const Config& cb);

/// Pixels of lit faces in shadow, where no edge of a volume is near and which are no near ties. A volume's own caps
/// must have none. The geometry's look has `sub_bits`.
Outcome no_acne(const FrameGeometry& g, const Config& config, int sub_bits);

}  // namespace kage::verif
