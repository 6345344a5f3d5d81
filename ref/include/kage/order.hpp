// SPDX-License-Identifier: Apache-2.0

/// @file
/// Visibility order: polygons back to front for any eye, exactly [Tanaka 2005]. A library of its own (target
/// kage::order), which knows nothing of scenes and pixels. docs/order.md has the method and its proofs.
///
/// Conventions, for all of this header: coordinates are doubles, taken as the exact numbers that they are; every
/// decision is that of exact arithmetic. The plane of three points a, b, c has its front where they are seen
/// counter-clockwise, (b - a) x (c - a) . (p - a) > 0. An OrderTree does not change once built, and any number of
/// threads and VisibilityOrders may use it at once; a VisibilityOrder belongs to one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kage/error.hpp"

namespace kage {

/// A point, or a direction: x, y, z.
using OrderPoint = std::array<double, 3>;

/// The number of no node.
inline constexpr std::uint32_t kNoNode = 0xffffffff;

/// Polygons over common vertices. Each is convex and plane, or is cut into triangles from its first corner.
struct OrderMesh {
  /// Corners that follow each other in `corners`.
  struct Polygon {
    std::uint32_t first = 0;  ///< of its corners, into `corners`
    std::uint32_t count = 0;  ///< at least 3
  };
  std::vector<OrderPoint> vertices;    ///< finite
  std::vector<std::uint32_t> corners;  ///< into vertices
  std::vector<Polygon> polygons;       ///< in the order in which those in one plane are drawn
};

/// How a tree is built.
struct OrderBuildOptions {
  std::uint64_t seed = 1;  ///< of the choice among planes; any gives a right tree, and each its own
  int threads = 0;         ///< 0: one per processor. The tree does not depend on it
  /// The default limit is never below this many fragments, which take up to 4 GB (2 kB each).
  static constexpr std::uint64_t kFragments = 2'000'000;
  /// The build throws TooManyFragments above this many. Default: the larger of kFragments and four times the number of
  /// faces.
  std::optional<std::uint64_t> max_fragments = {};
  /// Called several times a second, never from two threads at once, with the share of the work that is done, 0 .. 1.
  /// The share never falls. An exception from it ends the build and reaches the caller. The share is an estimate: how
  /// much a set of fragments will still be cut is not known beforehand.
  std::function<void(double)> progress;
};

/// Polygons were cut into more fragments than OrderBuildOptions::max_fragments.
class TooManyFragments : public Error {
 public:
  /// Says so in a line.
  /// @param limit that was passed
  /// @param where opens the message, as far as it is known: "glass: frame 3"
  explicit TooManyFragments(std::uint64_t limit, const std::string& where = {});

  /// @return the limit that was passed
  [[nodiscard]] std::uint64_t limit() const { return limit_; }

 private:
  std::uint64_t limit_;
};

/// Work that building a tree took.
struct OrderBuildStats {
  std::uint64_t polygons = 0;     ///< given
  std::uint64_t flat = 0;         ///< of those, dropped because their area is exactly 0
  std::uint64_t bent = 0;         ///< of those, not plane, so cut into triangles
  std::uint64_t faces = 0;        ///< convex plane polygons that the tree was built from
  std::uint64_t nodes = 0;        ///< of the tree
  std::uint64_t fragments = 0;    ///< faces + splits
  std::uint64_t splits = 0;       ///< fragments cut in two by a node's plane
  std::uint64_t depth = 0;        ///< nodes on the longest way down
  std::uint64_t side_tests = 0;   ///< of vertices against planes
  std::uint64_t exact_tests = 0;  ///< of those, decided by integers
};

/// A convex piece of a face: where the face lies on the given sides of some nodes' planes.
struct OrderFragment {
  /// A node's plane that really cut the face on the way down, and on which side of it the fragment lies.
  struct Cut {
    std::uint32_t node = 0;  ///< whose plane it is
    bool front = false;      ///< the fragment lies before it
  };
  std::uint32_t face = 0;     ///< into OrderTree::face()
  std::span<const Cut> cuts;  ///< in the order of the way down
  /// Edge i goes from vertex i to the next. Below kCutEdge: along the face's edge from that corner to the next; else
  /// along the plane of cuts[edge - kCutEdge]. So vertex i is exactly where edge i - 1 and edge i meet. It is a corner
  /// of the face, a point of its edge on a node's plane, or the point of its plane on two nodes' planes.
  std::span<const std::uint32_t> edges;
  std::span<const OrderPoint> vertices;  ///< rounded, for drawing; counter-clockwise as the face
  /// From here on a number in `edges` is a cut's.
  static constexpr std::uint32_t kCutEdge = 0x80000000;
};

/// A face that the tree was built from: a polygon of the mesh, or a triangle of one.
struct OrderFace {
  std::uint32_t polygon = 0;               ///< into OrderMesh::polygons
  std::span<const std::uint32_t> corners;  ///< into vertices(); consecutive ones at unlike places
  std::array<std::uint32_t, 3> plane{};    ///< three vertices, not on a line, whose plane is the face's, same front
};

/// Looks at how a file begins.
/// @param path any file
/// @return true if it begins like a tree that OrderTree::save() wrote, in whatever version
bool is_order_file(const std::filesystem::path& path);

/// A BSP tree. Nodes are numbered in preorder, the child with more nodes first, so that a subtree is a range of
/// numbers. A node's plane is that of a face, or its reverse: `front` is the side where the larger child lies. All
/// fragments in the plane lie in the node, duplicates and those of either facing too, in the order of the mesh.
class OrderTree {
 public:
  /// Builds a tree. Open, self-intersecting and overlapping meshes are fine. n faces give at most n (n^2 - n + 2) / 2
  /// fragments, and no more nodes than fragments. Throws Error that names the polygon if a coordinate is not finite, a
  /// corner is out of range, or a plane polygon is not convex; TooManyFragments past options.max_fragments.
  /// @param mesh the polygons; it need not outlive the call
  /// @param options how it is built
  /// @return the tree, the same for any number of threads
  static OrderTree build(const OrderMesh& mesh, const OrderBuildOptions& options = {});

  /// Reads a tree. Throws Error that names file and place if the file is not what save() wrote.
  /// @param path a file that save() wrote
  /// @return the tree
  static OrderTree load(const std::filesystem::path& path);

  /// Writes a file that load() reads. It appears under its name when it is whole; one that was there stays until then.
  /// Throws Error that names it if it cannot be written.
  /// @param path its name
  void save(const std::filesystem::path& path) const;
  /// Writes the same bytes to a stream, whose errors the caller looks for.
  /// @param out gets them
  void save(std::ostream& out) const;

  ~OrderTree();
  OrderTree(OrderTree&&) noexcept;
  OrderTree& operator=(OrderTree&&) noexcept;

  /// @return how many nodes there are; node 0 is the root
  [[nodiscard]] std::uint32_t node_count() const;
  /// How many nodes a subtree has.
  /// @param node 0 .. node_count() - 1, not checked
  /// @return nodes in the subtree, the node counted
  [[nodiscard]] std::uint32_t subtree_size(std::uint32_t node) const;
  /// The child on the side of the plane where its front is.
  /// @param node 0 .. node_count() - 1, not checked
  /// @return child before the plane, or kNoNode
  [[nodiscard]] std::uint32_t front(std::uint32_t node) const;
  /// The child on the other side.
  /// @param node 0 .. node_count() - 1, not checked
  /// @return child behind the plane, or kNoNode
  [[nodiscard]] std::uint32_t back(std::uint32_t node) const;

  /// The plane that parts a node's children.
  /// @param node 0 .. node_count() - 1, not checked
  /// @return three vertices, into vertices(), whose plane is the node's, with its front
  [[nodiscard]] std::array<std::uint32_t, 3> plane(std::uint32_t node) const;

  /// The node's fragments are first_fragment(node) .. first_fragment(node + 1) - 1; at least one.
  /// @param node 0 .. node_count(), not checked
  /// @return number of its first fragment
  [[nodiscard]] std::uint32_t first_fragment(std::uint32_t node) const;
  /// @return how many fragments all nodes have
  [[nodiscard]] std::uint32_t fragment_count() const;
  /// A fragment.
  /// @param fragment 0 .. fragment_count() - 1, not checked
  /// @return what it is, valid as long as the tree
  [[nodiscard]] OrderFragment fragment(std::uint32_t fragment) const;

  /// @return how many faces the tree was built from
  [[nodiscard]] std::uint32_t face_count() const;
  /// A face.
  /// @param face 0 .. face_count() - 1, not checked
  /// @return what it is, valid as long as the tree
  [[nodiscard]] OrderFace face(std::uint32_t face) const;
  /// @return the mesh's vertices
  [[nodiscard]] const std::vector<OrderPoint>& vertices() const;

  /// @return what building it took; of a tree that was loaded, what building took then
  [[nodiscard]] const OrderBuildStats& stats() const;

 private:
  friend struct OrderTreeInside;  // how the library itself comes to what a tree holds
  struct Data;
  explicit OrderTree(std::unique_ptr<const Data> data);
  std::unique_ptr<const Data> data_;
};

/// Where one looks from. Exactly on a node's plane counts as before it, in all ways.
struct Eye {
  bool perspective = true;  ///< one looks from a point; else along a direction
  OrderPoint at{0, 0, 0};   ///< the eye; parallel: the direction in which one looks, of any length but 0
  /// An eye at a point.
  /// @param p where it is, finite
  /// @return the eye
  static Eye point(const OrderPoint& p) { return {true, p}; }
  /// An eye infinitely far away.
  /// @param forward the direction in which one looks, of any length but 0
  /// @return the eye
  static Eye parallel(const OrderPoint& forward) { return {false, forward}; }
};

/// The ways to the order. All give the same.
enum class OrderWay : std::uint8_t {
  recursion,       ///< the whole tree walked, every node tested: the reference
  switching_list,  ///< [Tanaka 2005] section 3, with docs/order.md's corrections
  fast,            ///< vector tests, then exchange of what changed or a rebuild, whichever is cheaper
};

/// Report of one step: what it did, and why.
struct OrderStep {
  /// Which nodes were tested.
  enum class Tests : std::uint8_t {
    all,     ///< every node
    blocks,  ///< only blocks that the eye's way may have changed
  };
  /// How the order came to be that of the eye.
  enum class Change : std::uint8_t {
    none,      ///< the order of the last move still holds
    exchange,  ///< ranges of nodes changed places
    rebuild,   ///< all nodes were placed anew
  };
  Tests tests = Tests::all;         ///< which nodes were tested
  Change change = Change::rebuild;  ///< how the order came to be that of the eye
  std::uint64_t tested = 0;         ///< nodes
  std::uint64_t unsure = 0;         ///< of those, not decided by the vector test
  std::uint64_t exact = 0;          ///< of those, decided by integers
  std::uint64_t flips = 0;          ///< nodes whose side changed
  /// Seconds that exchanging would take by the costs measured on this tree, as far as summed; may be infinite if
  /// more than a quarter of the nodes flipped.
  double exchange_cost = 0;
  double rebuild_cost = 0;  ///< seconds that a rebuild takes by the same
  std::string_view why;     ///< in words
};

/// The order for an eye that moves.
class VisibilityOrder {
 public:
  virtual ~VisibilityOrder() = default;

  /// Puts everything in order for an eye. Throws Error if a coordinate is not finite, or a direction 0.
  /// @param eye where one looks from
  virtual void move_to(const Eye& eye) = 0;

  /// The order as of the last move_to().
  /// @return all nodes, back to front; before the first move, empty. Valid up to the next move
  [[nodiscard]] virtual std::span<const std::uint32_t> order() = 0;

  /// move_to() and order().
  /// @param eye where one looks from
  /// @return all nodes, back to front, valid up to the next move
  std::span<const std::uint32_t> update(const Eye& eye) {
    move_to(eye);
    return order();
  }

  /// Report of the last move_to(). Recursion and the switching list fill in `tested`, `flips` and `exact`.
  /// @return what it did, and why
  [[nodiscard]] const OrderStep& last_step() const { return step_; }

  /// @return bytes that this holds, and the tree's own nodes with it; polygons, fragments and vertices are not counted
  [[nodiscard]] virtual std::uint64_t bytes() const = 0;

 protected:
  OrderStep step_;  ///< what last_step() gives
};

/// Makes the order of a tree's nodes, which has no eye yet.
/// @param tree must outlive the result
/// @param way how it is kept; all give the same
/// @return the order
std::unique_ptr<VisibilityOrder> make_order(const OrderTree& tree, OrderWay way);

}  // namespace kage
