// SPDX-License-Identifier: Apache-2.0
#include "order/parts.hpp"

#include <algorithm>

namespace kage::order {
namespace {

/// Order of a small subtree for some sides: nodes counted from its first, a byte each.
std::uint64_t order_of(const std::uint32_t* size, std::uint32_t sides) {
  constexpr std::uint32_t kFarDone = 16;
  std::uint64_t order = 0;
  unsigned written = 0;
  std::array<std::uint32_t, std::size_t{2} * kClusterNodes> stack{};
  std::size_t height = 1;
  while (height != 0) {
    const std::uint32_t entry = stack[--height];
    const std::uint32_t v = entry % kFarDone;
    if (entry >= kFarDone) {
      order |= std::uint64_t{v} << (8 * written++);
      continue;
    }
    std::array<std::uint32_t, 2> child{kNoNode, kNoNode};
    if (size[v] > 1) child[0] = v + 1;
    if (size[v] > 1 && 1 + size[v + 1] < size[v]) child[1] = v + 1 + size[v + 1];
    const bool front = (sides >> v & 1U) != 0;
    if (child[front ? 0 : 1] != kNoNode) stack[height++] = child[front ? 0 : 1];
    stack[height++] = v + kFarDone;
    if (child[front ? 1 : 0] != kNoNode) stack[height++] = child[front ? 1 : 0];
  }
  return order;
}

}  // namespace

Parts::Parts(const TreeData& data) {
  mark(data);
  parts_.resize(below(data.nodes()));
  const auto none = static_cast<std::uint32_t>(parts_.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> known;
  std::uint32_t part = 0;
  for (std::uint32_t v = 0; v < data.nodes(); ++part) {
    if (data.size[v] <= kClusterNodes) {
      parts_[part] = {v, shape_entry(data, v, known)};
      clusters_.push_back(part);
      v += data.size[v];
      continue;
    }
    const std::uint32_t back = data.second_child(v);
    parts_[part] = back == kNoNode ? Part{none, 1} : Part{below(back), data.size[back] + 1};
    largest_back_ = std::max(largest_back_, parts_[part].b - 1);
    // The first child of a top follows it, so a run goes on as long as tops follow one another.
    if (runs_.empty() || runs_.back().node + runs_.back().tops != v)
      runs_.push_back({v, part, 1});
    else
      ++runs_.back().tops;
    ++v;
  }
  runs_.shrink_to_fit();
  clusters_.shrink_to_fit();
  table_.shrink_to_fit();
}

void Parts::mark(const TreeData& data) {
  const std::uint32_t n = data.nodes();
  starts_.assign(n / 64 + 1, {});
  for (std::uint32_t v = 0; v < n;) {
    starts_[v / 64].bits |= std::uint64_t{1} << (v % 64);
    v += data.size[v] > kClusterNodes ? 1 : data.size[v];
  }
  std::uint64_t sum = 0;
  for (Starts& s : starts_) {
    s.before = sum;
    sum += static_cast<std::uint64_t>(__builtin_popcountll(s.bits));
  }
}

std::uint32_t Parts::shape_entry(const TreeData& data, std::uint32_t first,
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

std::uint64_t Parts::bytes() const {
  return parts_.capacity() * sizeof(Part) + runs_.capacity() * sizeof(Run) + clusters_.capacity() * 4 +
         table_.capacity() * 8 + starts_.capacity() * sizeof(Starts);
}

}  // namespace kage::order
