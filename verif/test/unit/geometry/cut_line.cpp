// SPDX-License-Identifier: Apache-2.0
// The line on which one plane cuts another on the picture, against rational numbers. Whatever the planes, each pixel
// lies on the side that the exact line has it on, unless it lies within 2^-15 of a pixel of that line.
#include <algorithm>
#include <cmath>

#include "geometry/translucent.hpp"
#include "oracle/cut_oracle.hpp"
#include "stimulus/random.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

using Number = CutOracle::Number;
using Point = CutOracle::Point;
using Face = CutOracle::Face;

Point normal(const Face& f) { return CutOracle::normal(f); }

constexpr int kWidth = 64;
constexpr int kHeight = 48;

struct Judged {
  int pixels = 0;
  int near = 0;
  int wrong = 0;
  int both = 0;  // lines with pixels on either side
};

void judge(const Camera& camera, const Face& face, const Face& node, Judged& sum) {
  const int side = eye_side(camera, face);
  if (side == 0 || normal(node) == Point{0, 0, 0}) return;  // no tree has a node without a plane
  const View view(camera, kWidth, kHeight, 24, {camera.near, 100});
  const CutLine line = cut_line(view, camera, face, side, node);
  const CutOracle truth(camera, face, node, side, kWidth, kHeight);
  bool front = false;
  bool back = false;
  for (int y = 0; y < kHeight; y += 5)
    for (int x = 0; x < kWidth; x += 5) {
      const Number value = truth.value(x, y);
      ++sum.pixels;
      if (abs(value) * 32768 <= truth.slope()) {
        ++sum.near;
        continue;
      }
      const bool found = line.a * x + line.b * y + line.c >= 0;
      (value > 0 ? front : back) = true;
      sum.wrong += found == (value > 0) ? 0 : 1;
    }
  sum.both += front && back ? 1 : 0;
}

Camera random_camera(Random& random) {
  Camera c;
  look_at(c, {random.real(-1, 1), random.real(-1, 1), random.real(2, 4)},
          {random.real(-0.3, 0.3), random.real(-0.3, 0.3), 0});
  c.perspective = random.chance(0.6);
  c.half_height = c.perspective ? 0.5 : 1.5;
  c.near = 0.1;
  return c;
}

glm::dvec3 random_place(Random& random) { return {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}; }

Face random_face(Random& random) { return {random_place(random), random_place(random), random_place(random)}; }

/// A triangle that is `width` wide, next to an edge of which its third corner lies.
Face sliver(Random& random, double width) {
  Face f = random_face(random);
  for (int i = 0; i < 3; ++i) f[1][i] = f[0][i] + width * random.real(-1, 1);
  return f;
}

}  // namespace

TEST_CASE("cut lines of planes in general position") {
  Random random(test_seed());
  CAPTURE(test_seed());
  Judged sum;
  for (int i = 0; i < 200; ++i) judge(random_camera(random), random_face(random), random_face(random), sum);
  CHECK(sum.wrong == 0);
  CHECK(sum.both > 100);
  CHECK(sum.near * 100 < sum.pixels);
}

TEST_CASE("family 37: cut lines of faces next to nothing wide, down to one unit in the last place") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  Judged sum;
  for (int i = 0; i < 300; ++i) {
    const double width = std::pow(10.0, random.in(-18, -8));
    Face node = sliver(random, width);
    // At the pole of a sphere: one corner on the axis, two close to it, with coordinates smaller than any rounding.
    if (i % 2 == 0)
      node = {glm::dvec3{width * random.real(-1, 1), -0.5, width * random.real(-1, 1)},
              glm::dvec3{width * random.real(-1, 1), -0.5, width * random.real(-1, 1)}, random_place(random)};
    // Which corner comes first decides how much of the width is left in a difference of doubles.
    std::rotate(node.begin(), node.begin() + random.in(0, 2), node.end());
    judge(random_camera(random), random_face(random), node, sum);
  }
  CHECK(sum.wrong == 0);
  CHECK(sum.both > 150);
  CHECK(sum.near * 100 < sum.pixels);
}

TEST_CASE("family 37: cut lines of planes that nearly coincide, and of eyes next to a plane") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  Judged sum;
  for (int i = 0; i < 300; ++i) {
    Camera camera = random_camera(random);
    const Face face = random_face(random);
    Face node = face;
    const double off = std::pow(10.0, random.in(-17, -3));
    for (glm::dvec3& p : node) p += off * random_place(random);
    if (i % 4 == 0) {  // a plane that nearly holds the eye
      node = random_face(random);
      camera.eye = node[0] + 2.0 * (node[1] - node[0]) + off * random_place(random);
    }
    judge(camera, face, node, sum);
  }
  CHECK(sum.wrong == 0);
  CHECK(sum.both > 150);
}

TEST_CASE("cut lines at the ends of what doubles hold") {
  Random random(test_seed(4));
  CAPTURE(test_seed(4));
  Judged sum;
  for (const double size : {0x1p-120, 0x1p-40, 0x1p40, 0x1p120})
    for (int i = 0; i < 30; ++i) {
      Camera camera = random_camera(random);
      camera.eye *= size;
      if (!camera.perspective) camera.half_height *= size;
      Face face = random_face(random);
      Face node = i % 2 == 0 ? random_face(random) : sliver(random, 1e-17);
      for (Face* f : {&face, &node})
        for (glm::dvec3& p : *f) p *= size;
      judge(camera, face, node, sum);
    }
  CHECK(sum.wrong == 0);
  CHECK(sum.both > 40);
}

}  // namespace kage::verif
