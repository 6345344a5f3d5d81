// SPDX-License-Identifier: Apache-2.0
// Clusters against every way to put few vectors in few clusters.
#include "geometry/clusters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "stimulus/random.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

double error_of(const WeightedVectors& v, const Clusters& c) {
  double error = 0;
  for (std::size_t i = 0; i < v.count(); ++i)
    for (std::size_t d = 0; d < v.dimensions; ++d)
      error += v.weight(i)[d] * std::pow(v.value(i)[d] - c.middles[c.of[i] * v.dimensions + d], 2);
  return error;
}

/// The least error of all partitions: numbers of clusters as digits, each with its mean.
double least_error(const WeightedVectors& v, std::size_t most) {
  double least = INFINITY;
  std::vector<std::size_t> of(v.count(), 0);
  for (bool more = true; more;) {
    double error = 0;
    for (std::size_t d = 0; d < v.dimensions; ++d)
      for (std::size_t k = 0; k < most; ++k) {
        double weight = 0;
        double sum = 0;
        for (std::size_t i = 0; i < of.size(); ++i)
          if (of[i] == k) weight += v.weight(i)[d], sum += v.weight(i)[d] * v.value(i)[d];
        for (std::size_t i = 0; i < of.size(); ++i)
          if (of[i] == k && weight > 0) error += v.weight(i)[d] * std::pow(v.value(i)[d] - sum / weight, 2);
      }
    least = std::min(least, error);
    std::size_t at = 0;
    while (at < of.size() && ++of[at] == most) of[at++] = 0;
    more = at < of.size();
  }
  return least;
}

WeightedVectors random_vectors(Random& random, int count, int dimensions) {
  WeightedVectors v;
  v.dimensions = static_cast<std::size_t>(dimensions);
  for (int i = 0; i < count * dimensions; ++i) {
    v.values.push_back(random.chance(0.3) ? random.in(0, 3) / 4.0 : random.real(0, 1));
    v.weights.push_back(random.chance(0.1) ? 0 : random.real(0.01, 10));
  }
  return v;
}

}  // namespace

TEST_CASE("few vectors come to an error near the least that there is") {
  Random random(test_seed());
  CAPTURE(test_seed());
  double sum = 0;
  int rounds = 0;
  for (int round = 0; round < 300; ++round) {
    const WeightedVectors v = random_vectors(random, random.in(2, 7), random.in(1, 4));
    const std::size_t most = static_cast<std::size_t>(random.in(1, 3));
    const Clusters c = clusters_of(v, most);
    REQUIRE(c.of.size() == v.count());
    REQUIRE(c.middles.size() <= most * v.dimensions);
    for (const std::uint32_t k : c.of) REQUIRE(k * v.dimensions < c.middles.size());
    const double least = least_error(v, most);
    const double got = error_of(v, c);
    REQUIRE(got >= least * (1 - 1e-9) - 1e-12);
    if (least < 1e-6) continue;
    sum += got / least;
    ++rounds;
  }
  std::printf("clusters: error %.3f of the least in the mean\n", sum / rounds);
  CHECK(rounds > 100);
  CHECK(sum / rounds < 1.15);
}

TEST_CASE("where there is room each vector has a cluster without error, equal ones one together") {
  Random random(test_seed(1));
  CAPTURE(test_seed(1));
  for (int round = 0; round < 50; ++round) {
    WeightedVectors v = random_vectors(random, 20, 3);
    for (double& w : v.weights) w = std::max(w, 0.01);
    const WeightedVectors once = v;
    v.values.insert(v.values.end(), once.values.begin(), once.values.end());
    v.weights.insert(v.weights.end(), once.weights.rbegin(), once.weights.rend());
    const Clusters c = clusters_of(v, 20);
    CHECK(error_of(v, c) < 1e-24);
    for (std::size_t i = 0; i < 20; ++i) CHECK(c.of[i] == c.of[i + 20]);
  }
}

TEST_CASE("a member is in the cluster that is nearest to it, and more clusters have less error") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  const WeightedVectors v = random_vectors(random, 400, 6);
  double before = INFINITY;
  for (const std::size_t most : {1U, 3U, 15U, 63U, 255U}) {
    const Clusters c = clusters_of(v, most);
    const double error = error_of(v, c);
    CHECK(error < before);
    before = error;
    const Clusters again = clusters_of(v, most);
    CHECK(again.of == c.of);
    CHECK(again.middles == c.middles);
    // Passes end where nothing moves, or soon after: then next to nothing is left to gain by moving.
    Clusters moved = c;
    for (std::size_t i = 0; i < v.count(); ++i)
      moved.of[i] = nearest_middle(c.middles, v.dimensions, v.value(i), v.weight(i));
    CHECK(error_of(v, moved) <= error);
    CHECK(error_of(v, moved) > 0.97 * error - 1e-12);
  }
}

TEST_CASE("no vectors have no clusters, and vectors without weight have one") {
  CHECK(clusters_of({}, 15).of.empty());
  WeightedVectors v;
  v.dimensions = 2;
  v.values = {1, 2, 3, 4};
  v.weights = {0, 0, 0, 0};
  const Clusters c = clusters_of(v, 15);
  CHECK(c.of == std::vector<std::uint32_t>{0, 0});
  CHECK(c.middles.size() == 2);
}

}  // namespace kage::verif
