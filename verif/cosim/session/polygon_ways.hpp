// SPDX-License-Identifier: Apache-2.0
//
// How many polygons of a stream at the polygon level go as polygons, and why the others do not.
#pragma once

#include <cstdint>
#include <string>

#include "cosim/report/run_record.hpp"
#include "kage/frontend.hpp"

namespace kage::cosim {

/// Sums over the frames of a scene at the polygon level.
class PolygonWays {
 public:
  /// A frame more.
  void add(const PolygonReport& frame);

  /// Frames that come behind these.
  void absorb(const PolygonWays& later);

  void clear() { *this = {}; }

  /// A line on the share that the front end makes, and one on the rest where there is one.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] report::Json json() const;

 private:
  PolygonReport sum_;
  int whole_ = 0;  // frames at the span level
};

}  // namespace kage::cosim
