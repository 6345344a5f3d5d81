// SPDX-License-Identifier: Apache-2.0
//
// Polygons for tests and benchmarks of the visibility order: crossing, coplanar, nearly coplanar, on lattices.
#pragma once

#include <cmath>
#include <vector>

#include "kage/order.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

/// Adds a polygon with vertices of its own.
inline void add_polygon(OrderMesh& mesh, const std::vector<OrderPoint>& points) {
  mesh.polygons.push_back({static_cast<std::uint32_t>(mesh.corners.size()), static_cast<std::uint32_t>(points.size())});
  for (const OrderPoint& p : points) {
    mesh.corners.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back(p);
  }
}

inline OrderPoint random_point(Random& random, double size) {
  return {random.real(-size, size), random.real(-size, size), random.real(-size, size)};
}

/// A point with whole coordinates: planes and edges then meet in vertices, coincide, are parallel.
inline OrderPoint lattice_point(Random& random, int size) {
  return {static_cast<double>(random.in(-size, size)), static_cast<double>(random.in(-size, size)),
          static_cast<double>(random.in(-size, size))};
}

/// Triangles through one another.
inline OrderMesh crossing_triangles(Random& random, int count) {
  OrderMesh mesh;
  for (int i = 0; i < count; ++i)
    add_polygon(mesh, {random_point(random, 1), random_point(random, 1), random_point(random, 1)});
  return mesh;
}

/// Large ones about one point: nearly all of them go through nearly all others.
inline OrderMesh mutually_crossing(Random& random, int count) {
  OrderMesh mesh;
  for (int i = 0; i < count; ++i) {
    // Corners of a triangle with its middle near the origin.
    std::vector<OrderPoint> corners(3);
    const OrderPoint p = random_point(random, 1);
    const OrderPoint q = random_point(random, 1);
    const OrderPoint middle = random_point(random, 0.1);
    for (std::size_t k = 0; k < 3; ++k) corners[0][k] = p[k], corners[1][k] = q[k], corners[2][k] = -p[k] - q[k];
    for (OrderPoint& corner : corners) {
      const double length = std::sqrt(corner[0] * corner[0] + corner[1] * corner[1] + corner[2] * corner[2]);
      for (std::size_t k = 0; k < 3; ++k) corner[k] = middle[k] + 2 * corner[k] / length;
    }
    add_polygon(mesh, corners);
  }
  return mesh;
}

/// Smaller ones, of which a few cross: about as many nodes as triangles.
inline OrderMesh loose_triangles(Random& random, int count) {
  OrderMesh mesh;
  for (int i = 0; i < count; ++i) {
    const OrderPoint at = random_point(random, 1);
    std::vector<OrderPoint> corners(3, at);
    for (OrderPoint& p : corners)
      for (double& x : p) x += random.real(-0.3, 0.3);
    add_polygon(mesh, corners);
  }
  return mesh;
}

/// The same as crossing_triangles on a coarse lattice: some without area, some twice, many in one plane.
inline OrderMesh lattice_triangles(Random& random, int count, int size = 2) {
  OrderMesh mesh;
  for (int i = 0; i < count; ++i)
    add_polygon(mesh, {lattice_point(random, size), lattice_point(random, size), lattice_point(random, size)});
  return mesh;
}

/// Squares of two sizes in planes at right angles, some of them the very same.
inline OrderMesh lattice_panes(Random& random, int count, int size = 3) {
  OrderMesh mesh;
  for (int i = 0; i < count; ++i) {
    const OrderPoint m = lattice_point(random, size);
    const auto x = static_cast<std::size_t>(random.in(0, 2));
    const std::size_t y = (x + 1) % 3;
    const double half = random.in(1, 2);
    std::vector<OrderPoint> corners(4, m);
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k][x] += k == 0 || k == 3 ? -half : half;
      corners[k][y] += k < 2 ? -half : half;
    }
    add_polygon(mesh, corners);
  }
  return mesh;
}

/// Triangles that miss one plane by a few units in the last place, or do not.
inline OrderMesh nearly_coplanar(Random& random, int count) {
  OrderMesh mesh;
  const OrderPoint slope{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
  for (int i = 0; i < count; ++i) {
    std::vector<OrderPoint> points;
    for (int k = 0; k < 3; ++k) {
      OrderPoint p = random_point(random, 1);
      p[2] = slope[0] * p[0] + slope[1] * p[1] + slope[2];
      for (int n = random.in(0, 2); n > 0; --n) p[2] = std::nextafter(p[2], 10.0);
      points.push_back(p);
    }
    add_polygon(mesh, points);
  }
  return mesh;
}

/// A ball of `rings` times `segments` quadrilaterals and triangles, pushed in and out a little: neighbours share
/// vertices, quadrilaterals are bent.
inline OrderMesh bumpy_ball(Random& random, unsigned rings, unsigned segments, double bumps = 0.2) {
  OrderMesh mesh;
  mesh.vertices = {{0, 0, 1}, {0, 0, -1}};
  for (unsigned r = 1; r < rings; ++r)
    for (unsigned s = 0; s < segments; ++s) {
      const double a = M_PI * r / rings;
      const double b = 2 * M_PI * s / segments;
      const double size = 1 + random.real(-bumps, bumps);
      mesh.vertices.push_back({size * std::sin(a) * std::cos(b), size * std::sin(a) * std::sin(b), size * std::cos(a)});
    }
  const auto at = [&](unsigned r, unsigned s) {
    return r == 0 ? 0U : r == rings ? 1U : 2 + (r - 1) * segments + s % segments;
  };
  for (unsigned r = 0; r < rings; ++r)
    for (unsigned s = 0; s < segments; ++s) {
      std::vector<std::uint32_t> c{at(r, s), at(r + 1, s)};
      if (r + 1 < rings) c.push_back(at(r + 1, s + 1));
      if (r > 0) c.push_back(at(r, s + 1));
      mesh.polygons.push_back({static_cast<std::uint32_t>(mesh.corners.size()), static_cast<std::uint32_t>(c.size())});
      mesh.corners.insert(mesh.corners.end(), c.begin(), c.end());
    }
  return mesh;
}

/// An eye somewhere, as tests of this file's meshes want it: near and far, inside, on lattice points, parallel.
inline Eye random_eye(Random& random) {
  switch (random.in(0, 4)) {
    case 0:
      return Eye::point(random_point(random, 1));
    case 1:
      return Eye::point(lattice_point(random, 4));
    case 2: {
      OrderPoint d = lattice_point(random, 2);
      if (d == OrderPoint{0, 0, 0}) d[2] = 1;
      return Eye::parallel(d);
    }
    case 3:
      return Eye::parallel(random_point(random, 1));
    default:
      return Eye::point(random_point(random, 10));
  }
}

}  // namespace kage::verif
