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
  const Lighting lighting(std::span(&light, 1), {0, 1, 0}, false);
  const auto color = [&](const glm::dvec3& normal, std::int8_t side) {
    glm::dvec3 arrives;
    lighting.arriving({0, 0, 0}, normal, std::span(&side, 1), 1, std::span(&arrives, 1));
    return lighting.displayed(normal, {1, 1, 1}, arrives).x;
  };
  const double straight = color({0, 1, 0}, 1);
  const double oblique = color({0.8, 0.6, 0}, 1);
  const double unlit = color({0, 1, 0}, -1);
  CHECK(straight > oblique);
  CHECK(oblique > unlit);
  CHECK(straight <= 255);
  CHECK(color({0, 1, 0}, 0) == unlit);
  const glm::dvec3 grey = Lighting(std::span(&light, 1), {0, 1, 0}, true).displayed({0, 1, 0}, {1, 0, 0}, {1, 1, 1});
  CHECK(grey.x == grey.z);
}

}  // namespace kage::verif
