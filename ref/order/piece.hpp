// SPDX-License-Identifier: Apache-2.0
//
// Faces and what is left of them after cuts, while a tree is built: on which side of a plane they lie, exactly, and
// their two parts.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "order/data.hpp"

namespace kage::order {

struct BuildNode;

/// A convex part of a face, as OrderFragment has it; planes are still those of build nodes.
struct Piece {
  struct Vertex {
    NearPoint point;
    std::uint32_t corner = kNoNode;  ///< the face's vertex that it is, if it is one
  };
  struct Cut {
    BuildNode* node = nullptr;
    std::uint32_t face = 0;  ///< whose plane it is
    bool front = false;      ///< of that face
  };
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> edges;
  std::vector<Cut> cuts;
};

/// A whole face, or a piece of it.
struct BuildFragment {
  std::uint32_t face = 0;
  std::unique_ptr<Piece> piece;
};

/// A face's plane, as a splitter.
struct Splitter {
  Splitter(const Faces& faces, std::uint32_t of_face)
      : face(of_face), filter(faces.filter(faces.faces[face])), points(faces.plane(faces.faces[face])) {}
  std::uint32_t face;
  FilterPlane filter;
  PlanePoints points;
};

/// How a fragment lies to a plane.
enum class Side { kFront, kBack, kOn, kBoth };

class Classifier {
 public:
  explicit Classifier(const Faces& faces) : faces_(faces) {}

  /// Exact. After kBoth, split() may be called for the same fragment and plane.
  Side classify(const BuildFragment& f, const Splitter& plane);

  /// The parts before and behind `plane`, which `node` has.
  std::pair<BuildFragment, BuildFragment> split(const BuildFragment& f, const Splitter& plane, BuildNode* node);

  [[nodiscard]] std::uint64_t tests() const { return tests_; }
  [[nodiscard]] std::uint64_t exact() const { return exact_; }

 private:
  struct Test {
    int sign;
    double value;
    double error;
  };
  Test test_corner(std::uint32_t v, const Splitter& plane);
  Test test_vertex(const Face& face, const Piece& piece, std::size_t i, const Splitter& plane);
  [[nodiscard]] ExactVertex exact_vertex(const Face& face, const Piece& piece, std::size_t i) const;
  /// Where an edge of a piece meets a plane.
  [[nodiscard]] ExactVertex exact_vertex(const Face& face, const Piece& piece, std::uint32_t edge,
                                         const PlanePoints& plane) const;
  /// Where the edge from vertex i of a piece crosses a plane that at_ holds its vertices' tests against.
  [[nodiscard]] NearPoint crossing(const Face& face, const Piece& piece, std::size_t i, const Splitter& plane) const;
  [[nodiscard]] Piece whole(const Face& face) const;

  const Faces& faces_;
  std::vector<Test> at_;  // of the last fragment's vertices
  std::vector<NearPoint> crossings_;
  std::uint64_t tests_ = 0;
  std::uint64_t exact_ = 0;
};

}  // namespace kage::order
