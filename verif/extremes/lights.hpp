// SPDX-License-Identifier: Apache-2.0
//
// Cases of families 29 and 30: samples of lights, the table of what each light gives to faces of each direction, and
// light after light.
#pragma once

#include <vector>

#include "extremes/light_frames.hpp"
#include "extremes/scene_case.hpp"

namespace kage::verif {

/// Family 29: samples of lights over one white line.
struct SamplesCase {
  struct Sample {
    int left = 0, right = 40, light = 0;
    void fields(Fields& f);
  };
  int bits = 1;  ///< COUNT_BITS
  bool fsf = true;
  int class_bits = 2;
  int lights = 1;
  int equal = 0;    ///< so many samples of the first light over the same pixels go ahead
  int share = 256;  ///< what the first light's sample takes, in 2^-16; each further light half as much again
  std::vector<Sample> samples;
  void fields(Fields& f);
  [[nodiscard]] std::vector<LightSample> all() const;
  [[nodiscard]] std::vector<std::uint32_t> shares(const Config& config) const;
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 29: whole pictures of several lights, of several samples each.
struct LitSceneCase {
  struct Lamp {
    LampCase lamp;
    int shape = 0;
    double size = 0.5;
    TurnCase turn;
    bool falls_off = false;
    void fields(Fields& f);
  };
  int samples = 4;
  int seed = 1;
  bool smooth = false;
  SceneCase scene;
  std::vector<Lamp> lamps;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 30: directional lights on a face, and its entry in the table.
struct TableCase {
  struct Sun {
    double x = 0, y = -1, z = 0;
    double red = 1, green = 1, blue = 1;
    void fields(Fields& f);
  };
  double x = 0, y = 1, z = 0;  ///< the face's normal
  std::vector<Sun> suns;
  void fields(Fields& f);
  /// Holds, in every state of shadow, what the face's entry takes against the light of the model, added in linear
  /// light.
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 30: whole pictures by light after light, of several suns over solids of one colour each.
struct PassesCase {
  int bits = 12;  ///< LINEAR_BITS
  std::vector<TableCase::Sun> suns;
  SceneCase scene;
  void fields(Fields& f);
  /// Holds each pixel against each light worked out there.
  [[nodiscard]] Outcome check(const Context& context) const;
};

void add_light_families(Families& to);

}  // namespace kage::verif
