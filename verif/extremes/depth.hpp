// SPDX-License-Identifier: Apache-2.0
//
// Cases of families 15 - 20: depth and colour along spans, and layers over each other.
#pragma once

#include "extremes/family.hpp"

namespace kage::verif {

/// A depth plane along a span, as steep as can be.
struct Ramp {
  int z_bits = 24, frac = 11;
  int count = 1;             ///< pixels
  int x = 0;                 ///< of the first
  int anchor = 0;            ///< how far left of it the plane's anchor is
  double from = 1, to = 1;   ///< depth at the ends, as a share of all of it
  int a_low = 0, c_low = 0;  ///< added to slope and start, in 2^-24

 protected:
  /// With `least` pixels at least.
  void set_fields(Fields& f, int least);
  /// Errors are measured from pixel `first` on.
  [[nodiscard]] Outcome errors(const Context& context, int first) const;
};

/// Family 15: errors along a span.
struct RampCase : Ramp {
  void fields(Fields& f) { set_fields(f, 1); }
  [[nodiscard]] Outcome check(const Context& context) const { return errors(context, 0); }
};

/// Family 15: errors at the end of long spans, where the slope's rounding adds up.
struct LongRampCase : Ramp {
  void fields(Fields& f) { set_fields(f, 600); }
  [[nodiscard]] Outcome check(const Context& context) const { return errors(context, 500); }
};

/// Family 15: a plane that leaves depth's range within the picture is clamped there.
struct PastEndCase {
  double at = 8e6;     ///< depth in the middle of the picture
  double slope = 1e5;  ///< a pixel
  int frac = 11;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 16: depth that is whole at every pixel, and a second surface beside it.
struct WholeDepthCase {
  int z_bits = 24, frac = 11;
  int z = 9'000'000;  ///< in the middle of the picture
  int slope = 0;      ///< a pixel
  int offset = 0;     ///< of the second surface
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 17: several polygons with one plane and one outline.
struct CoplanarCase {
  struct Face {
    int color = 0;
    void fields(Fields& f);
  };
  double z = 1e6, a = 0, b = 0;
  std::vector<Face> faces;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 18: planes that are close to each other, parallel or crossing.
struct ClosePlanesCase {
  struct Face {
    int left = 0, right = 96;  ///< pixels that it covers
    double z = 0;              ///< in the middle, apart from the common depth, in LSB
    double a = 0, b = 0;       ///< slopes apart from the common ones, in LSB a pixel
    void fields(Fields& f);
  };
  int z_bits = 24, frac = 11;
  double at = 0.5;      ///< common depth, as a share of all
  double a = 0, b = 0;  ///< common slopes, as a share of all depth a picture's width
  std::vector<Face> faces;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 19: colour along a span.
struct ColourCase {
  int frac = 8;
  bool grey = false;
  int width = 1;
  double from = 0, to = 255;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Translucent layers over a colour.
struct Layers {
  struct Layer {
    int color = 0;
    void fields(Fields& f);
  };
  int alpha = 0;
  int under = 0;
  int first = 0, first_count = 0;  ///< so many layers of one colour go ahead
  std::vector<Layer> layers;
  [[nodiscard]] Outcome check(const Context& context) const;

 protected:
  /// With `least` layers at least.
  void set_fields(Fields& f, int least);
};

/// Family 20: a few layers.
struct LayersCase : Layers {
  void fields(Fields& f) { set_fields(f, 0); }
};

/// Family 20: hundreds of layers.
struct DeepLayersCase : Layers {
  void fields(Fields& f) { set_fields(f, 300); }
};

void add_depth_families(Families& to);

}  // namespace kage::verif
