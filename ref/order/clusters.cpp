// SPDX-License-Identifier: Apache-2.0
#include "order/clusters.hpp"

#include <algorithm>

namespace kage::order {
namespace {

/// Order of a small subtree: nodes counted from its first.
std::uint64_t order_of(const std::uint32_t* size, std::uint32_t sides) {
  std::uint64_t order = 0;
  unsigned written = 0;
  std::array<std::uint32_t, 2 * kClusterNodes> stack{};
  std::size_t height = 0;
  stack[height++] = 0;
  while (height != 0) {
    const std::uint32_t entry = stack[--height];
    const std::uint32_t v = entry & 15U;
    if ((entry & 16U) != 0) {
      order |= std::uint64_t{v} << (8 * written++);
      continue;
    }
    std::array<std::uint32_t, 2> child{kNoNode, kNoNode};
    if (size[v] > 1) child[0] = v + 1;
    if (size[v] > 1 && 1 + size[v + 1] < size[v]) child[1] = v + 1 + size[v + 1];
    const bool front = (sides >> v & 1U) != 0;
    if (child[front ? 0 : 1] != kNoNode) stack[height++] = child[front ? 0 : 1];
    stack[height++] = v | 16U;
    if (child[front ? 1 : 0] != kNoNode) stack[height++] = child[front ? 1 : 0];
  }
  return order;
}

std::vector<std::uint32_t> sums(const std::vector<std::uint64_t>& bits) {
  std::vector<std::uint32_t> before;
  std::uint32_t sum = 0;
  for (const std::uint64_t b : bits) {
    before.push_back(sum);
    sum += static_cast<std::uint32_t>(__builtin_popcountll(b));
  }
  return before;
}

}  // namespace

Clusters::Clusters(const OrderTree::Data& data) {
  mark(data);
  const auto tops = tops_before_.back() + static_cast<std::uint32_t>(__builtin_popcountll(top_.back()));
  const auto count = starts_before_.back() + static_cast<std::uint32_t>(__builtin_popcountll(start_.back()));
  tops_.reserve(tops);
  clusters_.reserve(count);
  const auto part = [&](std::uint32_t child) {
    if (child == kNoNode) return tops + count;
    return is_top(child) ? tops_below(child) : tops + clusters_below(child);
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> known;
  for (std::uint32_t v = 0; v < data.nodes();) {
    if (!is_top(v)) {
      clusters_.push_back({v, shape_entry(data, v, known)});
      v += data.size[v];
      continue;
    }
    const std::uint32_t front = data.first_child(v);
    const std::uint32_t back = data.second_child(v);
    tops_.push_back({v, part(front), part(back), data.size[front], back == kNoNode ? 0 : data.size[back]});
    ++v;
  }
  table_.shrink_to_fit();
}

void Clusters::mark(const OrderTree::Data& data) {
  const std::uint32_t n = data.nodes();
  top_.assign(n / kBlock + 1, 0);
  start_.assign(n / kBlock + 1, 0);
  for (std::uint32_t v = 0; v < n;) {
    const std::uint64_t bit = std::uint64_t{1} << (v % kBlock);
    const bool top = data.size[v] > kClusterNodes;
    (top ? top_ : start_)[v / kBlock] |= bit;
    v += top ? 1 : data.size[v];
  }
  tops_before_ = sums(top_);
  starts_before_ = sums(start_);
}

std::uint32_t Clusters::shape_entry(const OrderTree::Data& data, std::uint32_t first,
                                    std::vector<std::pair<std::uint32_t, std::uint32_t>>& known) {
  const std::uint32_t nodes = data.size[first];
  std::uint32_t shape = 0;  // sizes in preorder, a digit each
  for (std::uint32_t i = 0; i < nodes; ++i) shape = shape << 4U | data.size[first + i];
  const auto at = std::lower_bound(known.begin(), known.end(), std::pair{shape, 0U});
  if (at != known.end() && at->first == shape) return at->second;
  const auto entry = static_cast<std::uint32_t>(table_.size()) << 4U | nodes;
  known.insert(at, {shape, entry});
  for (std::uint32_t sides = 0; sides < 1U << nodes; ++sides) table_.push_back(order_of(&data.size[first], sides));
  return entry;
}

std::uint64_t Clusters::bytes() const {
  return tops_.capacity() * sizeof(Top) + clusters_.capacity() * sizeof(Cluster) + table_.capacity() * 8 +
         (top_.size() + start_.size()) * 8 + (tops_before_.size() + starts_before_.size()) * 4;
}

}  // namespace kage::order
