// SPDX-License-Identifier: Apache-2.0
//
// Signs by integers: slow, always right, asked where the filters (filter.hpp) cannot tell. A double is an integer times
// a power of two, so all coordinates are integers on one grid fine enough. No sign comes from a point that was made:
// each is that of a polynomial in the given coordinates.
#pragma once

#include <cstdint>
#include <span>

#include "kage/order.hpp"

namespace kage::order {

/// Three points that span a plane.
struct PlanePoints {
  OrderPoint a;
  OrderPoint b;
  OrderPoint c;
};

/// The point that three things of a face have in common (OrderFragment::edges).
struct ExactVertex {
  enum class Kind { kCorner, kOnEdge, kInside };
  Kind kind = Kind::kCorner;
  PlanePoints face;    ///< kInside: the face's plane
  OrderPoint p;        ///< kCorner: the point; kOnEdge: one end of the edge
  OrderPoint q;        ///< kOnEdge: the other end, on the other side of `first`
  PlanePoints first;   ///< kOnEdge, kInside: a node's plane
  PlanePoints second;  ///< kInside: another
};

/// The coarsest grid that all coordinates of an input lie on: multiples of 2^exponent. `narrow`: below 2^61 of them.
struct Grid {
  int exponent = 0;
  bool narrow = true;
};

Grid grid_of(std::span<const OrderPoint> points);

/// Which side of the plane: 1 front, 0 on it, -1 back. All coordinates lie on the grid.
int exact_side(const Grid& grid, const ExactVertex& v, const PlanePoints& plane);

/// The same for any four points.
int exact_side(const PlanePoints& plane, const OrderPoint& p);

/// The point that kOnEdge and kInside name, each coordinate within 2^-52 of its size.
OrderPoint exact_point(const Grid& grid, const ExactVertex& v);

/// Sign of (b - a) x (c - a) . direction.
int exact_facing(const PlanePoints& plane, const OrderPoint& direction);

/// Signs of the components of (b - a) x (c - b).
std::array<int, 3> exact_turn(const OrderPoint& a, const OrderPoint& b, const OrderPoint& c);

/// How a picture is taken. The points at (x, y) of it, for every t, are
///   perspective:  eye + t (x right + y up + forward)
///   parallel:     eye + x right + y up + t forward
struct Picture {
  bool perspective = true;
  OrderPoint eye{};
  OrderPoint right{};
  OrderPoint up{};
  OrderPoint forward{};
};

/// The function l[0] x + l[1] y + l[2] on the picture that is 0 where `face` and `node` meet; cut_line() in
/// geometry/translucent.cpp derives it. Let n and m be the normals of node and face, dn = n . (eye - node.a) and
/// dm = m . (eye - face.a), and k = right, up, forward:
///   perspective:  l[k] = dm (n . k) - dn (m . k)
///   parallel:     l[0] = m.forward n.right - n.forward m.right
///                 l[1] = m.forward n.up - n.forward m.up
///                 l[2] = m.forward dn - n.forward dm
/// All are scaled by one positive factor, so that the largest is 1/2 .. 1. Each is within 2^-52 of its size, or of
/// 2^-1000.
OrderPoint exact_meeting(const PlanePoints& face, const PlanePoints& node, const Picture& picture);

}  // namespace kage::order
