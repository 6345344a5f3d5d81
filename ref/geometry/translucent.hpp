// SPDX-License-Identifier: Apache-2.0
//
// Translucent faces on the screen: their order back to front, and the fragments that it cuts them into.
//
// A fragment is never a polygon of its own: it is its face's snapped polygon, restricted by lines. Where a node's plane
// cuts a face, both sides take the same line in integers, so the fragments of a face part its pixels exactly, whatever
// was rounded on the way to that line. [Tanaka 2005 leaves open how fragments are drawn.]
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "geometry/line_search.hpp"
#include "geometry/view.hpp"
#include "kage/geometry.hpp"
#include "kage/order.hpp"

namespace kage {

/// The corners of a face that is a triangle.
inline std::array<glm::dvec3, 3> triangle_of(const SceneFrame& frame, std::uint32_t face) {
  const auto outline = frame.outline(frame.polygons[face]);
  return {frame.vertices[outline[0]], frame.vertices[outline[1]], frame.vertices[outline[2]]};
}

/// On which side of the plane of a face the eye is, exactly: 1 before it (its corners are seen counter-clockwise), -1
/// behind it, 0 in it. Such a face is seen edge-on and covers nothing.
int eye_side(const Camera& camera, const std::array<glm::dvec3, 3>& face);

/// Where `side`, the eye's exact side of `face`, is not 0: the line on which the plane of `node` cuts that of `face`.
CutLine cut_line(const View& view, const Camera& camera, const std::array<glm::dvec3, 3>& face, int side,
                 const std::array<glm::dvec3, 3>& node);

/// The library's way into what is kept of an order.
struct TranslucentOrderInside {
  using Data = TranslucentOrder::Data;
  static Data& of(TranslucentOrder& order) { return *order.data_; }
};

/// Puts translucent faces in order.
class FragmentMaker {
 public:
  /// `faces`: those to be put in order, into frame.polygons, in draw order; all are triangles. `sides`: of each the
  /// eye's.
  FragmentMaker(const SceneFrame& frame, const View& view, TranslucentOrderInside::Data& kept,
                std::span<const std::uint32_t> faces, std::span<const int> sides);

  /// Append the fragments to `out`, back to front. `drawn(face)` is the range {first, count} of a face's polygons.
  template <class Drawn>
  void make(TranslucentWay way, Drawn drawn, FrameGeometry& out) {
    each(way, [&](std::uint32_t face, const OrderFragment* fragment) {
      const auto [first, count] = drawn(faces_[face]);
      if (count > 0) add(face, first, count, fragment, out);
    });
  }

 private:
  // From here on a face is its number in faces_.

  /// Call emit(face, fragment or nullptr for a whole face) back to front.
  template <class Emit>
  void each(TranslucentWay way, Emit emit) {
    if (way != TranslucentWay::exact) {
      for (const std::uint32_t f : whole(way)) emit(f, static_cast<const OrderFragment*>(nullptr));
      return;
    }
    for (const std::uint32_t node : nodes()) {
      if (++walked_ % 4096 == 0) report();
      const std::uint32_t end = tree().first_fragment(node + 1);
      for (std::uint32_t i = tree().first_fragment(node); i < end; ++i) {
        const OrderFragment fragment = tree().fragment(i);
        emit(tree().face(fragment.face).polygon, &fragment);
      }
    }
  }

  [[nodiscard]] std::vector<std::uint32_t> whole(TranslucentWay way) const;
  [[nodiscard]] std::span<const std::uint32_t> nodes();
  [[nodiscard]] const OrderTree& tree() const;
  void report() const;
  std::uint32_t line_of(std::uint32_t face, std::uint32_t node, FrameGeometry& out);
  void add(std::uint32_t face, std::uint32_t first, std::uint32_t count, const OrderFragment* fragment,
           FrameGeometry& out);

  const SceneFrame* frame_;
  const View* view_;
  TranslucentOrderInside::Data* kept_;
  std::span<const std::uint32_t> faces_;
  std::span<const int> sides_;
  std::unordered_map<std::uint64_t, std::uint32_t> lines_;  // of node and face
  LineSearch search_;
  std::uint64_t walked_ = 0;  // nodes
};

}  // namespace kage
