// SPDX-License-Identifier: Apache-2.0
//
// Which way each component of a scene went: by an expansion unit or by spans, and why.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cosim/report/run_record.hpp"
#include "kage/pipeline.hpp"
#include "kage/scene.hpp"
#include "kage/stream.hpp"

namespace kage::cosim {

/// Summed over frames, for a configuration that has units.
class ComponentWays {
 public:
  /// A polyhedron that no unit took.
  struct LeftOut {
    std::string object;
    std::size_t component = 0;
    std::string cause;
  };

  /// A frame more. Returns the first polyhedron that no unit took, if there is one.
  std::optional<LeftOut> add(const Scene& scene, const FrameParts& parts, int units);

  /// Frames that come behind these.
  void absorb(const ComponentWays& later);

  void clear() { ways_.clear(); }

  /// See Source::ways().
  [[nodiscard]] std::vector<report::WayRecord> records() const;

 private:
  struct Way {
    std::string object;
    int unit_frames = 0;
    int span_frames = 0;
    SpanReason reason = SpanReason::none;
    std::string why;

    /// Whether a neighbour went the same way for the same reason, and never by a unit.
    [[nodiscard]] bool is_like(const Way& w) const {
      return object == w.object && reason == w.reason && unit_frames == 0 && span_frames == w.span_frames;
    }
  };

  std::optional<LeftOut> add_polyhedra(const FrameParts& parts, int units);

  std::vector<Way> ways_;  // by component
};

/// The ways that a stream file holds (Source::ways()), if it does. Throws Error that begins with `name` where section
/// ORIG is no JSON, or nests too deeply.
report::WayRecords ways_of(const StreamFile& file, const std::string& name);

}  // namespace kage::cosim
