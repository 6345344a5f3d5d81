// SPDX-License-Identifier: Apache-2.0
//
// From build nodes to flat arrays in preorder. The larger child comes first, so that the subtree sizes alone say what
// the tree is; of equal ones the one with the larger shape, so that small subtrees come in few shapes (parts.hpp).
#include <algorithm>

#include "kage/error.hpp"
#include "order/build_node.hpp"
#include "order/placing.hpp"

namespace kage::order {
namespace {

/// Cuts and edges, with room for those of a node.
constexpr std::size_t kMostCuts = 0xf0000000;

std::uint32_t size_of(const BuildNode* n) { return n == nullptr ? 0 : n->size; }

/// Sizes of the subtree in preorder, a hexadecimal digit each, the root's highest; 0 past kClusterNodes nodes.
void set_shape(BuildNode& n) {
  if (n.size > kClusterNodes) return;
  n.shape = n.size;
  for (const BuildNode* c : {n.child[n.reversed ? 1 : 0], n.child[n.reversed ? 0 : 1]})
    if (c != nullptr) n.shape = n.shape << (4 * c->size) | c->shape;
}

bool before(const BuildNode* p, const BuildNode* q) {
  if (size_of(p) != size_of(q)) return size_of(p) > size_of(q);
  return p == nullptr || q == nullptr || p->shape >= q->shape;
}

std::vector<BuildNode*> preorder(BuildNode* root) {
  std::vector<BuildNode*> nodes;
  std::vector<BuildNode*> stack;
  if (root != nullptr) stack.push_back(root);
  while (!stack.empty()) {
    BuildNode* n = stack.back();
    stack.pop_back();
    nodes.push_back(n);
    for (BuildNode* c : {n->child[n->reversed ? 0 : 1], n->child[n->reversed ? 1 : 0]})
      if (c != nullptr) stack.push_back(c);
  }
  return nodes;
}

std::uint64_t depth_of(const TreeData& data) {
  std::vector<std::uint64_t> depth(data.nodes(), 1);
  std::uint64_t deepest = 0;
  for (std::uint32_t v = 0; v < data.nodes(); ++v) {
    deepest = std::max(deepest, depth[v]);
    for (const std::uint32_t c : {data.first_child(v), data.second_child(v)})
      if (c != kNoNode) depth[c] = depth[v] + 1;
  }
  return deepest;
}

void add_fragment(const BuildFragment& f, TreeData& data) {
  data.fragments.push_back(
      {f.face, static_cast<std::uint32_t>(data.cuts.size()), static_cast<std::uint32_t>(data.edges.size())});
  const Faces& faces = data.faces;
  const Face& face = faces.faces[f.face];
  if (!f.piece) {
    for (std::uint32_t i = 0; i < face.count; ++i) {
      data.edges.push_back(i);
      data.points.push_back(faces.vertices[faces.corners[face.first + i]]);
    }
    return;
  }
  for (const Piece::Cut& c : f.piece->cuts) data.cuts.push_back({c.node->number, c.front != c.node->reversed});
  const Scale back{-faces.scale.exponent};
  for (const Piece::Vertex& v : f.piece->vertices)
    data.points.push_back(v.corner != kNoNode ? faces.vertices[v.corner] : back(v.point.at));
  data.edges.insert(data.edges.end(), f.piece->edges.begin(), f.piece->edges.end());
}

}  // namespace

void lay_out(const BuildTree& tree, TreeData& data) {
  const std::vector<BuildNode*> top_down = preorder(tree.root);
  for (std::size_t i = top_down.size(); i-- > 0;) {  // children before parents
    BuildNode& node = *top_down[i];
    node.size = 1 + size_of(node.child[0]) + size_of(node.child[1]);
    node.reversed = !before(node.child[0], node.child[1]);
    set_shape(node);
  }
  const std::vector<BuildNode*> nodes = preorder(tree.root);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i]->number = static_cast<std::uint32_t>(i);
  for (BuildNode* n : nodes) {
    if (data.cuts.size() > kMostCuts || data.edges.size() > kMostCuts)
      throw Error("the fragments' edges are more than fit");
    data.size.push_back(n->size);
    data.plane.push_back(n->face << 1U | (n->reversed ? 1U : 0U));
    data.first_fragment.push_back(static_cast<std::uint32_t>(data.fragments.size()));
    std::sort(n->fragments.begin(), n->fragments.end(),
              [](const BuildFragment& p, const BuildFragment& q) { return p.face < q.face; });
    for (const BuildFragment& f : n->fragments) add_fragment(f, data);
    std::vector<BuildFragment>().swap(n->fragments);
  }
  data.first_fragment.push_back(static_cast<std::uint32_t>(data.fragments.size()));
  data.stats.nodes = data.nodes();
  data.stats.fragments = data.fragments.size();
  data.fragments.push_back(
      {0, static_cast<std::uint32_t>(data.cuts.size()), static_cast<std::uint32_t>(data.edges.size())});
  data.stats.depth = depth_of(data);
}

}  // namespace kage::order
