// SPDX-License-Identifier: Apache-2.0
//
// The least widths by measurement: each is lowered bit by bit while the pictures of all frames stay within the limits.
// What holds of the frames that were drawn need not hold of others: kage plan --guarantee bound is for those.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kage/plan.hpp"
#include "trade/accuracy.hpp"

namespace kage::trade {

/// What may be wrong in the pictures, at most.
struct MeasuredLimits {
  std::optional<double> wrong;  ///< pixels in a million that show another face or shadow than the oracle, near ties too
  double z = 0;                 ///< error of a stored depth, as a share of the range
  int color = 1;                ///< steps of 8 bits from the finest picture
};

class MeasuredPlan {
 public:
  /// Keeps the truth of each frame once it has been asked for. `step` is called before each frame that is drawn; what
  /// it throws goes through.
  MeasuredPlan(std::span<const PlannedScene> scenes, const MeasuredLimits& limits, std::function<void()> step);
  ~MeasuredPlan();
  MeasuredPlan(const MeasuredPlan&) = delete;
  MeasuredPlan& operator=(const MeasuredPlan&) = delete;

  /// Lowers Z_BITS, Z_FRAC, SMOOTH, COLOR_FRAC, SHADE_FRAC and CLASS_BITS as far as the limits allow and rounds each up
  /// to its step: PlanOptions::lower. Each reason says what the width gives, and what one less gave. Where the widths
  /// it is given are not enough, the finest depth is tried; Error if that is not enough either.
  void lower(Config& widths, std::vector<PlanReason>& reasons);

  /// Draws all frames with a configuration and holds them against the truth. Ends early, with what it has, once a limit
  /// is passed, unless `whole`. None: the configuration cannot represent a frame.
  std::optional<Accuracy> measure(const Config& config, bool whole = false);

  /// Whether pictures are within the limits, all frames being counted.
  [[nodiscard]] bool within(const Accuracy& accuracy) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage::trade
