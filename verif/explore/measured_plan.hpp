// SPDX-License-Identifier: Apache-2.0
//
// The least widths by measurement: each is lowered bit by bit while the pictures of all frames stay within the limits.
// They need not be enough for frames that were not drawn: kage plan --guarantee bound is for those.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "explore/accuracy.hpp"
#include "explore/sweep_accuracy.hpp"
#include "kage/plan.hpp"

namespace kage::explore {

/// Greatest errors allowed in the pictures.
struct MeasuredLimits {
  std::optional<double> wrong;  ///< pixels in a million that show another face or shadow than the oracle, near ties too
  double z = 0;                 ///< error of a stored depth, as a share of the range
  /// Steps of 8 bits: at most from the picture of the finest widths that shows light the same way, and root mean square
  /// from the truth of light.
  int color = 1;
};

/// Errors of the pictures of all frames.
struct MeasuredErrors {
  Accuracy pictures;
  LightErrors light;          ///< no pixels with Look::cull, of which rays know nothing
  bool light_is_kept = true;  ///< the finest widths that show light the same way are within the limit of light
};

class MeasuredPlan {
 public:
  /// Keeps the truth of each frame once it has been asked for. `step` is called before each frame that is drawn; what
  /// it throws goes through.
  MeasuredPlan(std::span<const PlannedScene> scenes, const MeasuredLimits& limits, std::function<void()> step);
  ~MeasuredPlan();
  MeasuredPlan(const MeasuredPlan&) = delete;
  MeasuredPlan& operator=(const MeasuredPlan&) = delete;

  /// Lowers Z_BITS, Z_FRAC, COLOR_FRAC, SHADE_FRAC, CLASS_BITS and LINEAR_BITS as far as the limits allow and rounds
  /// each up to its step: PlanOptions::lower. Each reason says what the width gives, and what one less gave. Where the
  /// widths it is given are not enough, it begins at the finest; Error, which names the limit, if those are not enough
  /// either.
  /// @return "", or how far light is off, where no widths that show it the same way are within its limit
  std::string lower(Config& widths, std::vector<PlanReason>& reasons);

  /// Result of lower().
  struct Lowered {
    Config least;  ///< before widths are rounded up to steps: what the reasons tell of
    MeasuredErrors least_gives;
    Config taken;  ///< what it put in their place
    MeasuredErrors taken_gives;
  };
  /// The result for a configuration with widths that lower() gave, in any arrangement; null: it gave none such.
  [[nodiscard]] const Lowered* lowered(const Config& config) const;

  /// "0 ppm wrong, depth off by 6.02e-08 (over --max-z 5.96e-08), colour by 1 step, light by 0.31", all frames being
  /// counted.
  [[nodiscard]] std::string text(const MeasuredErrors& errors) const;
  /// "--max-z 5.96e-08, --max-color 1".
  [[nodiscard]] std::string limits_text() const;
  /// "Z_BITS 22, Z_FRAC 9": the widths that lower() may lower.
  static std::string widths_text(const Config& config);

  /// Draws all frames with a configuration and holds them against the truth. Ends early, with what it has, once a limit
  /// is passed, unless `whole`. None: the configuration cannot represent a frame.
  std::optional<MeasuredErrors> measure(const Config& config, bool whole = false);

  /// Whether pictures are within the limits, all frames being counted.
  [[nodiscard]] bool within(const MeasuredErrors& errors) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage::explore
