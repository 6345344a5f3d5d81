// SPDX-License-Identifier: Apache-2.0
#include "geometry/shade.hpp"

#include <algorithm>
#include <cmath>

#include "kage/light.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {

TEST_CASE("the sRGB curve by square roots is within 0.017 of a step of the exact one, monotone, exact at its ends") {
  double worst = 0;
  double before = -1;
  for (int i = 0; i <= 200000; ++i) {
    const double x = i / 200000.0;
    const double exact = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    const double got = srgb_encode(x);
    worst = std::max(worst, std::abs(got - exact) * 255);
    REQUIRE(got >= before);
    before = got;
  }
  CAPTURE(worst);
  CHECK(worst < 0.017);
  CHECK(srgb_encode(0) == 0);
  CHECK(srgb_encode(1) == 1);
  CHECK(srgb_encode(-5) == 0);
  CHECK(srgb_encode(5) == 1);
}

TEST_CASE("an unlit face gets ambient light only, a lit one more the straighter the light falls") {
  Light light;
  light.direction = {0, -1, 0};
  const Lighting view(std::span(&light, 1), {0, 1, 0});
  const glm::dvec3 white(1, 1, 1);
  const double straight = view.displayed({0, 0, 0}, {0, 1, 0}, white, 1, false).x;
  const double oblique = view.displayed({0, 0, 0}, {0.8, 0.6, 0}, white, 1, false).x;
  const double unlit = view.displayed({0, 0, 0}, {0, 1, 0}, white, 0, false).x;
  CHECK(straight > oblique);
  CHECK(oblique > unlit);
  CHECK(straight <= 255);
  CHECK(view.displayed({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 1, true).x ==
        view.displayed({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 1, true).z);
}

TEST_CASE("what a white surface loses where lights are kept out is what they gave it") {
  std::array<Light, 2> lights;
  lights[0].direction = {0, -1, 0};
  lights[0].color = {0.5, 0.3, 0.1};
  lights[1].direction = {0.6, -0.8, 0};
  lights[1].color = {0.1, 0.4, 0.3};
  const Lighting view(lights, {0, 1, 0});
  const glm::dvec3 white(1, 1, 1);
  for (const glm::dvec3& normal : {glm::dvec3{0, 1, 0}, glm::dvec3{-0.6, 0.8, 0}, glm::dvec3{0, 0.6, 0.8}}) {
    const auto share = view.shares({}, normal, 3, false);
    const glm::dvec3 all = view.displayed({}, normal, white, 3, false);
    const glm::dvec3 none = view.displayed({}, normal, white, 0, false);
    for (int c = 0; c < 3; ++c) {
      CHECK(all[c] * (1 - share[0][c] - share[1][c]) == Approx(none[c]).epsilon(1e-12));
      CHECK(share[0][c] >= 0);
      CHECK(share[1][c] >= 0);
    }
    // As much of the loss as of the light.
    CHECK(share[0].x / share[1].x ==
          Approx(received(lights[0], {}, normal).x / received(lights[1], {}, normal).x).epsilon(1e-12));
  }
  CHECK(view.shares({}, {0, 1, 0}, 2, false)[0] == glm::dvec3(0));
  CHECK(view.shares({}, {0, -1, 0}, 3, false)[1] == glm::dvec3(0));
}

}  // namespace kage::verif
