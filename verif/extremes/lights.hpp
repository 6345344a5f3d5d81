// SPDX-License-Identifier: Apache-2.0
//
// Cases of families 29 and 30: samples of lights, and the table of what each light gives to faces of each direction.
#pragma once

#include <bitset>
#include <optional>
#include <vector>

#include "extremes/light_frames.hpp"
#include "extremes/scene_case.hpp"
#include "geometry/light_table.hpp"

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

/// Family 30: faces under directional lights, and the table of what each light gives to their classes.
class TableFrame {
 public:
  TableFrame(std::vector<Light> suns, int classes);
  TableFrame(const TableFrame&) = delete;  // the table refers to the lights
  TableFrame& operator=(const TableFrame&) = delete;
  /// A face more; false: no light reaches it, and it is left out.
  bool add(const glm::dvec3& normal);
  /// The table is made: no face comes after it.
  void finish();
  [[nodiscard]] std::size_t faces() const { return faces_.size(); }
  /// Measures, in every state of shadow, how far the shares of a face's class are off its own, against their bound. The
  /// bound goes with the distance from the face's normal to its class's: `off_class`, or less.
  void measure(std::size_t face, double off_class, Outcome& o, const Context& context = {}) const;

 private:
  struct Face {
    glm::dvec3 normal;
    std::bitset<kMaxLights> reach;
  };
  std::vector<Light> lights_;
  std::vector<int> samples_;
  Lighting lighting_;
  std::size_t count_;  // of a class's shares: LIGHTS
  Config config_;
  Look look_;
  std::optional<LightTable> table_;
  FrameGeometry g_;
  std::vector<Face> faces_;
};

/// Family 30: directional lights on a face whose normal is not that of its class.
struct TableCase {
  struct Sun {
    double x = 0, y = -1, z = 0;
    double red = 1, green = 1, blue = 1;
    void fields(Fields& f);
  };
  int classes_log = 3;
  double x = 0, y = 1, z = 0;  ///< the face's normal
  std::vector<Sun> suns;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

void add_light_families(Families& to);

}  // namespace kage::verif
