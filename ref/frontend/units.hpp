// SPDX-License-Identifier: Apache-2.0
//
// Which polyhedron goes to which expansion unit. Polyhedra share a unit if no line has both or no column has both, and
// if their visible faces fit the unit's face table and their segments its buffer.
//
// In the order of their first lines each takes the lowest unit that has room. A unit without room for one either meets
// it on that one's first line, or its tables are full; so where tables suffice, no more units are needed than polyhedra
// lie on one line.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kage {

/// Room that a polyhedron needs in a unit.
struct UnitNeed {
  int first = 0;  ///< lines [first, end)
  int end = 0;
  int left = 0;  ///< columns [left, right)
  int right = 0;
  int faces = 0;     ///< visible ones
  int segments = 0;  ///< most on a line, with blank ones between them
};

/// Room that the units of a core have.
struct UnitRoom {
  int units = 0;
  int faces = 0;     ///< of a unit's table
  int segments = 0;  ///< that a unit buffers of a line
  int max_dx = 0;    ///< pixels of the longest segment
  int width = 0;     ///< of the frame
};

/// The unit of each, or nothing if one finds none.
std::optional<std::vector<int>> assign_all(std::span<const UnitNeed> needs, const UnitRoom& room);

/// The units of polyhedra from the start, in draw order, up to one that finds none with all before it placed.
std::vector<int> assign_units(std::span<const UnitNeed> needs, const UnitRoom& room);

}  // namespace kage
