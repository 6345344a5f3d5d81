// SPDX-License-Identifier: Apache-2.0
// Light samples, what lights send where, and family 30: how far a table's shares are off.
#include "kage/light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "extremes/lights.hpp"
#include "oracle/penumbra_truth.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

glm::dvec3 direction(Random& random) {
  for (;;) {
    const glm::dvec3 v(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1));
    const double n = glm::dot(v, v);
    if (n > 0.01 && n < 1) return v / std::sqrt(n);
  }
}

Light disc() {
  Light l;
  l.directional = false;
  l.position = {1, 2, 3};
  l.shape = LightShape::disc;
  l.axis_u = {0.5, 0, 0};
  l.axis_v = {0, 0.3, 0.4};
  return l;
}

}  // namespace

TEST_CASE("light points: the middle for one, else spread over the shape, by the seed") {
  Light l = disc();
  CHECK(light_points(l, 1, 7)[0].position == l.position);
  for (const LightShape shape : {LightShape::disc, LightShape::rectangle, LightShape::sphere})
    for (const int n : {2, 3, 15, 64, 255}) {
      l.shape = shape;
      const auto points = light_points(l, n, 7);
      REQUIRE(points.size() == static_cast<std::size_t>(n));
      glm::dvec3 sum{0, 0, 0};
      std::set<std::pair<double, double>> places;
      for (const LightPoint& p : points) {
        CHECK_FALSE(p.directional);
        const glm::dvec3 off = p.position - l.position;
        sum += off;
        places.emplace(off.x, off.y);
        if (shape == LightShape::sphere) {
          CHECK(glm::dot(off, off) < 0.25 * (1 + 1e-12));
          continue;
        }
        const double u = glm::dot(off, l.axis_u) / glm::dot(l.axis_u, l.axis_u);
        const double v = glm::dot(off, l.axis_v) / glm::dot(l.axis_v, l.axis_v);
        const glm::dvec3 left = off - l.axis_u * u - l.axis_v * v;
        CHECK(glm::dot(left, left) < 1e-20);
        if (shape == LightShape::disc)
          CHECK(u * u + v * v <= 1);
        else
          CHECK(std::max(std::abs(u), std::abs(v)) <= 1);
      }
      CHECK(places.size() == points.size());
      // Evenly: the middle of 3 or more points is near the light's.
      INFO(fmt::format("shape {}, {} points", static_cast<int>(shape), n));
      if (n > 2) CHECK(std::sqrt(glm::dot(sum, sum)) / n < 1.2 / n);
      CHECK(light_points(l, n, 8)[0].position != points[0].position);
      CHECK(light_points(l, n, 7)[1].position == points[1].position);
    }
  l.shape = LightShape::point;
  CHECK(light_points(l, 255, 7).size() == 1);
  CHECK(light_points(Light{}, 255, 7).size() == 1);
}

// The law behind the ball's samples: a density f(r) within the unit ball gives a line at distance s from the middle 2 x
// the integral of f(r) r / sqrt(r^2 - s^2) from s to 1. For 1 / (pi^2 sqrt(1 - r^2)) that is 1 / pi for every s: a
// disc.
TEST_CASE("the density of a ball's samples is that of an even disc along every line, and adds up to 1") {
  constexpr int kSteps = 2000;
  const auto mean = [](auto f) {  // over 0 .. 1
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += f((i + 0.5) / kSteps);
    return sum / kSteps;
  };
  // r^2 = s^2 + (1 - s^2) sin^2 a takes both ends' infinities away: r dr = (1 - s^2) sin a cos a da.
  for (const double s : {0.0, 0.3, 0.7, 0.99}) {
    const double along = 2 * mean([&](double t) {
                           const double a = t * M_PI / 2;
                           const double q = 1 - s * s;
                           const double density = 1 / (M_PI * M_PI * std::sqrt(q) * std::cos(a));
                           return density * q * std::sin(a) * std::cos(a) / (std::sqrt(q) * std::sin(a)) * (M_PI / 2);
                         });
    CHECK(along == Approx(1 / M_PI).epsilon(1e-9));
  }
  const double all = mean([](double t) {
    const double r = std::sin(t * M_PI / 2);
    return 4 * M_PI * r * r / (M_PI * M_PI) * (M_PI / 2);  // dr / sqrt(1 - r^2) is an angle's
  });
  CHECK(all == Approx(1).epsilon(1e-9));
  // And the points have that density: of the radii, the share up to r is 2 / pi (asin r - r sqrt(1 - r^2)).
  Light ball = disc();
  ball.shape = LightShape::sphere;
  std::vector<double> radii;
  for (const glm::dvec3& p : unit_points(ball, light_points(ball, 255, 1))) radii.push_back(std::sqrt(glm::dot(p, p)));
  std::sort(radii.begin(), radii.end());
  double worst = 0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double r = radii[i];
    worst = std::max(
        worst, std::abs((static_cast<double>(i) + 0.5) / 255 - 2 / M_PI * (std::asin(r) - r * std::sqrt(1 - r * r))));
  }
  CHECK(worst < 0.03);  // chance would come to 0.05
}

// The bounds are those that docs/lights.md states; `tools/bench light_points` prints what is measured.
TEST_CASE("light points: edges of all directions keep out their share, and more points make it finer") {
  struct Row {
    LightShape shape;
    int samples;
    double rms;    // of the light
    double worst;  // in samples
  };
  for (const Row& row : std::initializer_list<Row>{{LightShape::disc, 15, 0.041, 3},
                                                   {LightShape::disc, 64, 0.013, 3.8},
                                                   {LightShape::disc, 255, 0.0044, 6},
                                                   {LightShape::rectangle, 15, 0.039, 3},
                                                   {LightShape::rectangle, 64, 0.0125, 6.2},
                                                   {LightShape::rectangle, 255, 0.0042, 10},
                                                   {LightShape::sphere, 15, 0.049, 3.8},
                                                   {LightShape::sphere, 64, 0.018, 6.4},
                                                   {LightShape::sphere, 255, 0.0074, 11}})
    for (const std::uint64_t seed : {1U, 2U, 3U, 77U, 1000U}) {
      Light l = disc();
      l.shape = row.shape;
      const EdgeErrors e = edge_errors(row.shape, unit_points(l, light_points(l, row.samples, seed)));
      INFO(fmt::format("shape {}, {} samples, seed {}: rms {:.4f} of the light, worst {:.2f} samples",
                       static_cast<int>(row.shape), row.samples, seed, e.rms(), e.worst * row.samples));
      CHECK(e.rms() < row.rms);
      CHECK(e.worst * row.samples < row.worst);
    }
}

TEST_CASE("points on a ball's surface do not come to what is seen of it, however many") {
  for (const int n : {15, 64, 255}) {
    CHECK(edge_errors(LightShape::sphere, even_directions(n)).rms() > 0.041);
  }
}

TEST_CASE("light points: each of as many columns and rows of a rectangle has one, and no box has many too many") {
  double disc_worst = 0;
  double rectangle_worst = 0;
  for (int n = 2; n <= kMaxSamples; ++n)
    for (const std::uint64_t seed : {1U, 2U}) {
      Light l = disc();
      const auto on_disc = square_numbers(l.shape, unit_points(l, light_points(l, n, seed)));
      l.shape = LightShape::rectangle;
      const auto on_rectangle = square_numbers(l.shape, unit_points(l, light_points(l, n, seed)));
      std::set<int> columns;
      std::set<int> rows;
      for (const glm::dvec2& p : on_rectangle) {
        columns.insert(static_cast<int>(p.x * n));
        rows.insert(static_cast<int>(p.y * n));
        REQUIRE(std::abs(p.y * n - std::floor(p.y * n) - 0.5) < 1e-9);
      }
      REQUIRE(columns.size() == static_cast<std::size_t>(n));
      REQUIRE(rows.size() == static_cast<std::size_t>(n));
      disc_worst = std::max(disc_worst, star_discrepancy(on_disc) * n);
      rectangle_worst = std::max(rectangle_worst, star_discrepancy(on_rectangle) * n);
    }
  std::printf("star discrepancy of 2 to 255 samples: disc at most %.2f / N, rectangle at most %.2f / N\n", disc_worst,
              rectangle_worst);
  CHECK(disc_worst < 3.5);
  CHECK(rectangle_worst < 3.5);
}

TEST_CASE("the exact star discrepancy: of known sets") {
  CHECK(star_discrepancy({{0.5, 0.5}}) == Approx(0.75));
  CHECK(star_discrepancy({{1, 1}}) == Approx(1));
  // Four on a grid's middles: the box to (3/4, 3/4) with its border holds all four, for nine sixteenths.
  CHECK(star_discrepancy({{0.25, 0.25}, {0.25, 0.75}, {0.75, 0.25}, {0.75, 0.75}}) == Approx(7.0 / 16));
}

TEST_CASE("attenuation is glTF's: inverse square, range, cone") {
  Light l;
  CHECK(attenuation(l, {5, 5, 5}) == 1);
  l.directional = false;
  l.falls_off = true;
  l.position = {0, 3, 0};
  CHECK(attenuation(l, {0, 1, 0}) == 0.25);
  CHECK(attenuation(l, l.position) == 0);
  l.range = 4;
  CHECK(attenuation(l, {0, 1, 0}) == Approx(0.25 * (1 - std::pow(2.0 / 4, 4))));
  CHECK(attenuation(l, {0, -1, 0}) == 0);
  CHECK(attenuation(l, {0, -7, 0}) == 0);
  l.range = 0;
  l.spot = true;
  l.direction = {0, -1, 0};
  l.inner_cosine = std::cos(0.3);
  l.outer_cosine = std::cos(0.6);
  const auto at = [&](double angle) { return attenuation(l, {2 * std::sin(angle), 3 - 2 * std::cos(angle), 0}) * 4; };
  CHECK(at(0) == Approx(1));
  CHECK(at(0.29) == Approx(1));
  CHECK(at(0.61) == 0);
  CHECK(at(3) == 0);
  const double t = (std::cos(0.45) - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6));
  CHECK(at(0.45) == Approx(t * t));
  // Seen at an angle; nothing from behind, nothing infinite beside the light.
  l.spot = false;
  CHECK(received(l, {0, 1, 0}, {0, 1, 0}).x == Approx(0.25));
  CHECK(received(l, {0, 1, 0}, {0.6, 0.8, 0}).x == Approx(0.2));
  CHECK(received(l, {0, 1, 0}, {0, -1, 0}).x == 0);
  CHECK(std::isfinite(received(l, {1e-200, 3, 0}, {-1, 0, 0}).x));
}

TEST_CASE("family 30: a table's shares are within the bound for directional lights, in every state of shadow") {
  Random random(3);
  Outcome all;
  for (int round = 0; round < 1500; ++round) {
    TableCase t;
    const glm::dvec3 normal = direction(random);
    t.x = normal.x, t.y = normal.y, t.z = normal.z;
    for (int n = random.in(1, 8); n > 0; --n) {
      const glm::dvec3 d = direction(random);
      t.suns.push_back({d.x, d.y, d.z, random.real(0, 1), random.real(0, 1), random.real(0, 1)});
    }
    // On the edge of what a light reaches, too.
    if (round % 3 == 1) {
      TableCase::Sun& s = t.suns.front();
      const glm::dvec3 d = glm::dvec3(s.x, s.y, s.z) - normal * (glm::dot(glm::dvec3(s.x, s.y, s.z), normal) + 1e-6);
      s.x = d.x, s.y = d.y, s.z = d.z;
    }
    all.add(t.check({}));
    REQUIRE(all.wrong.empty());
  }
  std::printf("family 30: largest share of the bound %.2f\n", all.share());
  CHECK(all.items > 10000);
  CHECK(all.share() > 0.1);
}

}  // namespace kage::verif
