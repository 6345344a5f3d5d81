// SPDX-License-Identifier: Apache-2.0
#include "order/splitter.hpp"

#include <algorithm>
#include <cmath>

namespace kage::order {
namespace {

constexpr std::size_t kSample = 256;
constexpr std::size_t kCandidates = 64;
constexpr double kSplitCost =
    8;  // against one fragment more on the larger side; 4 and 16 gave more nodes on real meshes

}  // namespace

void SplitterChoice::take_sample(std::span<const BuildFragment> fragments, std::uint64_t& random) {
  points_.clear();
  ends_.clear();
  const std::size_t n = std::min(fragments.size(), kSample);
  for (std::size_t i = 0; i < n; ++i) {
    // One of each of n equal parts.
    const std::size_t low = fragments.size() * i / n;
    const std::size_t high = fragments.size() * (i + 1) / n;
    const BuildFragment& f = fragments[low + (high - low > 1 ? next_random(random) % (high - low) : 0)];
    const Face& face = faces_.faces[f.face];
    if (f.piece)
      for (const Piece::Vertex& v : f.piece->vertices) points_.push_back(v.point.at);
    else
      for (std::uint32_t k = 0; k < face.count; ++k) points_.push_back(faces_.scaled[faces_.corners[face.first + k]]);
    ends_.push_back(static_cast<std::uint32_t>(points_.size()));
  }
}

double SplitterChoice::cost(std::uint32_t face, double least) const {
  const FilterPlane plane = faces_.filter(faces_.faces[face]);
  const OrderPoint& n = plane.normal();
  const double near = 1e-11 * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  double splits = 0;
  double balance = 0;
  std::size_t at = 0;
  for (const std::uint32_t end : ends_) {
    double low = 0;
    double high = 0;
    for (; at < end; ++at) {
      const double d = plane.value(points_[at]);
      low = std::min(low, d);
      high = std::max(high, d);
    }
    const bool front = high > near;
    const bool back = low < -near;
    if (front && back) {
      splits += kSplitCost;
      if (splits > least) return splits;
    } else {
      balance += front ? 1 : back ? -1 : 0;
    }
  }
  return splits + std::abs(balance);
}

std::uint32_t SplitterChoice::choose(std::span<const BuildFragment> fragments, std::uint64_t& random) {
  if (fragments.size() < 3) return fragments[next_random(random) % fragments.size()].face;
  take_sample(fragments, random);
  const bool all = fragments.size() <= kCandidates;
  const std::size_t tries = all ? fragments.size() : kCandidates;
  std::uint32_t best = fragments[0].face;
  double least = 1e300;
  for (std::size_t k = 0; k < tries; ++k) {
    const std::uint32_t face = fragments[all ? k : next_random(random) % fragments.size()].face;
    const double c = cost(face, least);
    if (c < least) {
      least = c;
      best = face;
    }
  }
  return best;
}

}  // namespace kage::order
