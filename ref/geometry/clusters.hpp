// SPDX-License-Identifier: Apache-2.0
//
// Vectors that are put together in a few clusters, each of which has one vector for all of its members.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kage {

/// Vectors of `dimensions` numbers, one after the other, and their weights, likewise: a member's error in a dimension
/// counts as its square times the weight there, >= 0.
struct WeightedVectors {
  std::size_t dimensions = 0;
  std::vector<double> values;
  std::vector<double> weights;

  [[nodiscard]] std::size_t count() const { return dimensions > 0 ? values.size() / dimensions : 0; }
  [[nodiscard]] const double* value(std::size_t i) const { return &values[i * dimensions]; }
  [[nodiscard]] const double* weight(std::size_t i) const { return &weights[i * dimensions]; }
};

struct Clusters {
  std::vector<std::uint32_t> of;  ///< of each vector its cluster
  std::vector<double> middles;    ///< of each cluster its vector, the weighted mean of its members
};

/// At most `most` >= 1 clusters of small total error. Each time the cluster of greatest error is parted where it falls
/// least. Then members move to the nearest middle and middles to their members' mean, as long as that is cheap and
/// changes something. The same on every machine.
Clusters clusters_of(const WeightedVectors& vectors, std::size_t most);

/// The cluster, of middles of `dimensions` numbers each, of least error for one more vector; of several the first.
std::uint32_t nearest_middle(const std::vector<double>& middles, std::size_t dimensions, const double* value,
                             const double* weight);

}  // namespace kage
