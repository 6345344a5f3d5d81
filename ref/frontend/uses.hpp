// SPDX-License-Identifier: Apache-2.0
//
// Polygons of a frame in each of their roles, and what they would take as spans.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kage/defs.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Numbers of the uses of a frame's polygons: first drawn polygons, then faces of volumes, then polygons of fragments,
/// then drawn polygons once more for each light.
class Uses {
 public:
  Uses(const FrameGeometry& geometry, const Config& config)
      : g_(&geometry),
        first_face_(geometry.drawn),
        first_translucent_(first_face_ + (config.dsf_bits > 0 ? geometry.volume_faces.size() : 0)) {
    if (config.translucency > 0)
      for (std::uint32_t f = 0; f < geometry.fragments.size(); ++f) {
        first_of_fragment_.push_back(first_translucent_ + fragment_of_.size());
        fragment_of_.resize(fragment_of_.size() + geometry.fragments[f].polygon_count, f);
      }
    first_lit_ = first_translucent_ + fragment_of_.size();
  }

  [[nodiscard]] std::size_t count() const { return lit(g_->passes.size(), 0); }

  [[nodiscard]] static std::size_t drawn(std::size_t polygon) { return polygon; }
  [[nodiscard]] std::size_t face(std::size_t volume_face) const { return first_face_ + volume_face; }
  /// The n-th polygon of a fragment.
  [[nodiscard]] std::size_t translucent(std::size_t fragment, std::uint32_t n) const {
    return first_of_fragment_[fragment] + n;
  }
  /// With linear light, in the pass of a light.
  [[nodiscard]] std::size_t lit(std::size_t light, std::size_t polygon) const {
    return first_lit_ + light * g_->drawn + polygon;
  }

  /// Where those of a role begin; each ends where the next begins.
  [[nodiscard]] std::size_t first_face() const { return first_face_; }
  [[nodiscard]] std::size_t first_translucent() const { return first_translucent_; }
  [[nodiscard]] std::size_t first_lit() const { return first_lit_; }

  [[nodiscard]] bool has_faces() const { return first_translucent_ > first_face_; }
  [[nodiscard]] Kind span_of(std::size_t use) const {
    if (use < first_face_ || use >= first_lit_) return Kind::OP;
    return use < first_translucent_ ? Kind::SP : Kind::TP;
  }
  [[nodiscard]] std::uint32_t polygon_of(std::size_t use) const {
    if (use < first_face_) return static_cast<std::uint32_t>(use);
    if (use < first_translucent_) return g_->volume_faces[use - first_face_].polygon;
    if (use >= first_lit_) return static_cast<std::uint32_t>((use - first_lit_) % g_->drawn);
    return fragment_of(use).first_polygon + static_cast<std::uint32_t>(use - first_of_fragment_[number_of(use)]);
  }
  /// The fragment of a translucent polygon.
  [[nodiscard]] const ScreenFragment& fragment_of(std::size_t use) const { return g_->fragments[number_of(use)]; }

 private:
  [[nodiscard]] std::uint32_t number_of(std::size_t use) const { return fragment_of_[use - first_translucent_]; }

  const FrameGeometry* g_;
  std::size_t first_face_;
  std::size_t first_translucent_;
  std::size_t first_lit_ = 0;
  std::vector<std::size_t> first_of_fragment_;
  std::vector<std::uint32_t> fragment_of_;  // from first_translucent_ on
};

/// Words that the spans with an effect take, of each use; 0 of those that have none (BandEffect).
class SpanWords {
 public:
  SpanWords(const FrameGeometry& geometry, const Uses& uses, const Config& config)
      : layout_(config), of_use_(uses.count()), volumes_(geometry.volumes.size()) {}

  /// A use has such a span.
  void add(std::size_t use, Kind kind) { of_use_[use] += static_cast<std::uint32_t>(words(kind)); }
  /// A volume has an effect on a line, by so many spans and fronts as are left of all of its faces together.
  void add_volume(std::size_t volume, std::size_t spans, std::size_t fronts) {
    volumes_[volume] +=
        static_cast<std::uint32_t>(spans * words(Kind::SP) + fronts * words(Kind::NC) + words(Kind::AT));
  }

  /// Add those of other bands.
  SpanWords& operator+=(const SpanWords& other) {
    for (std::size_t i = 0; i < of_use_.size(); ++i) of_use_[i] += other.of_use_[i];
    for (std::size_t i = 0; i < volumes_.size(); ++i) volumes_[i] += other.volumes_[i];
    return *this;
  }

  /// All bands have come: faces of a volume without effect have none.
  void end(const FrameGeometry& geometry, const Uses& uses) {
    for (std::size_t v = 0; v < volumes_.size() && uses.has_faces(); ++v)
      if (volumes_[v] == 0)
        std::fill_n(of_use_.begin() + static_cast<std::ptrdiff_t>(uses.face(geometry.volumes[v].first_face)),
                    geometry.volumes[v].face_count, 0U);
  }

  [[nodiscard]] std::uint32_t of(std::size_t use) const { return of_use_[use]; }
  /// Words of a volume none of whose faces goes as a polygon, with an AT on each line.
  [[nodiscard]] std::uint32_t of_volume(std::size_t volume) const { return volumes_[volume]; }

 private:
  [[nodiscard]] std::size_t words(Kind kind) const {
    return static_cast<std::size_t>(layout_.words[static_cast<std::size_t>(kind)]);
  }

  Layout layout_;
  std::vector<std::uint32_t> of_use_;
  std::vector<std::uint32_t> volumes_;
};

}  // namespace kage
