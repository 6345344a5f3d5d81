// SPDX-License-Identifier: Apache-2.0
// A scene's picture does not depend on where its file puts it nor on the file's unit, up to where doubles end.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "oracle/light_truth.hpp"
#include "oracle/ray_truth.hpp"
#include "test/support/catch.hpp"
#include "test/unit/scene/files.hpp"

namespace kage::verif {
namespace {

using Json = nlohmann::json;

constexpr int kWidth = 128;
constexpr int kHeight = 96;

/// How the file says where the scene is, and in which unit.
enum class Way : std::uint8_t {
  root,  ///< all hangs on one node that is moved and scaled
  own,   ///< every node has a place and a size of its own
};

enum class Lamp : std::uint8_t { sun, lamp, both };

struct Made {
  double offset = 0;
  double unit = 1;
  Way way = Way::root;
  Lamp lamp = Lamp::sun;
};

/// Turned boxes on a floor, 10 across, and a camera 11 away. All numbers of places are short, so that a double holds
/// them up to 2^48 from the origin.
std::string file(const Made& m) {
  const std::vector<float> box{-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
  const std::vector<std::uint16_t> faces{0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                         2, 3, 7, 2, 7, 6, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5};
  const double own = m.way == Way::own ? m.unit : 1;
  const double moved = m.way == Way::own ? m.offset : 0;
  const auto place = [&](double x, double y, double z) {
    return Json::array({x * own + moved, y * own + moved / 2, z * own - moved});
  };
  Json nodes = Json::array();
  const auto add_box = [&](const Json& at, double sx, double sy, double sz, double turn) {
    nodes.push_back({{"mesh", 0},
                     {"translation", at},
                     {"scale", {sx * own, sy * own, sz * own}},
                     {"rotation", {0, std::sin(turn), 0, std::cos(turn)}}});
  };
  add_box(place(0, -2.25, 0), 5, 0.25, 5, 0);
  for (int i = 0; i < 12; ++i)
    add_box(place(-3.25 + 2.25 * (i % 4), -1.5 + 0.125 * i, -2.25 + 2.25 * std::floor(i / 4.0)), 0.375, 0.5 + 0.125 * i,
            0.5, i);
  const double down = -0.2;
  const double aside = 0.16;
  nodes.push_back({{"camera", 0},
                   {"translation", place(3, 4, 9)},
                   {"rotation",
                    {std::cos(aside) * std::sin(down), std::sin(aside) * std::cos(down),
                     -std::sin(aside) * std::sin(down), std::cos(aside) * std::cos(down)}}});
  Json lights = Json::array();
  const auto light = [&](Json node, const char* type, double intensity) {
    node["extensions"] = {{"KHR_lights_punctual", {{"light", lights.size()}}}};
    nodes.push_back(node);
    lights.push_back({{"type", type}, {"intensity", intensity}});
  };
  const Json sun{{"rotation", {std::sin(-0.55), 0, 0, std::cos(-0.55)}}};
  const Json lamp{{"translation", place(1, 5, 4)}};
  // A lamp falls off with the square of the distance in the file's unit: as bright beside the sun in each.
  if (m.lamp != Lamp::lamp) light(sun, "directional", 1);
  if (m.lamp != Lamp::sun) light(lamp, "point", m.lamp == Lamp::both ? 40 * m.unit * m.unit : 1);
  Json top = Json::array();
  for (std::size_t i = 0; i < nodes.size(); ++i) top.push_back(i);
  if (m.way == Way::root) {
    nodes.push_back(
        {{"children", top}, {"translation", {m.offset, m.offset / 2, -m.offset}}, {"scale", {m.unit, m.unit, m.unit}}});
    top = Json::array({nodes.size() - 1});
  }
  const Json members{
      {"scene", 0},
      {"scenes", {{{"nodes", top}}}},
      {"nodes", nodes},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
      {"cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.5 * m.unit}}}}}},
      {"extensionsUsed", {"KHR_lights_punctual"}},
      {"extensions", {{"KHR_lights_punctual", {{"lights", lights}}}}},
      {"bufferViews", {{{"buffer", 0}, {"byteLength", 96}}, {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 72}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5123}, {"count", 36}, {"type", "SCALAR"}}}}};
  const std::string text = members.dump();
  return test::gltf(text.substr(1, text.size() - 2), test::bytes_of(box) + test::bytes_of(faces));
}

struct Loaded {
  SceneFrame frame;
  bool noted;
};

Loaded load(const test::TempDirectory& directory, const Made& m) {
  const std::string path = directory.write("far.gltf", file(m));
  const Scene scene = Scene::load(path);
  return {scene.frame(0, 1), test::has_note(scene, "noticeably rounded")};
}

std::vector<std::uint32_t> picture(const SceneFrame& f) {
  Config c;
  c = config_for_lights(f, 1, c);
  return draw(make_geometry(f, c, kWidth, kHeight), c);
}

std::size_t different(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
  return count;
}

}  // namespace

TEST_CASE("a scene's picture is the same wherever its file puts it, as far as the file's numbers tell") {
  const test::TempDirectory directory;
  for (const Lamp lamp : {Lamp::sun, Lamp::lamp, Lamp::both}) {
    const Loaded near = load(directory, {0, 1, Way::root, lamp});
    CHECK(near.frame.origin == glm::dvec3{0, 0, 0});
    CHECK(near.frame.exponent == 0);
    CHECK_FALSE(near.noted);
    const auto truth = picture(near.frame);
    for (const double power : {3.0, 5.0, 8.0, 10.0, 12.0, 14.0, 15.0, 16.0, 20.0, 28.0, 40.0})
      for (const Way way : {Way::root, Way::own}) {
        const Loaded far = load(directory, {std::pow(10.0, power), 1, way, lamp});
        CAPTURE(power, way, lamp);
        // Places of nodes of their own are multiples of 1/8, which a double holds up to 2^50, 1.1e15.
        const bool told = way == Way::root || power <= 15;
        if (told) CHECK(different(picture(far.frame), truth) == 0);
        CHECK(far.noted == (way == Way::own && power >= 10));
        CHECK((far.frame.origin != glm::dvec3{0, 0, 0}) == (power >= 5));
      }
  }
}

TEST_CASE("a scene's picture is the same in any unit, as far as doubles reach") {
  const test::TempDirectory directory;
  for (const Lamp lamp : {Lamp::sun, Lamp::lamp, Lamp::both}) {
    const auto truth = picture(load(directory, {0, 1, Way::root, lamp}).frame);
    for (const double power :
         {-306.0, -200.0, -120.0, -60.0, -30.0, -21.0, -10.0, 10.0, 21.0, 30.0, 60.0, 120.0, 200.0, 300.0, 306.0})
      for (const Way way : {Way::root, Way::own}) {
        // The lamp's intensity beside a sun is a number of the file, too: the square of the unit.
        if (lamp == Lamp::both && std::abs(power) > 150) continue;
        CAPTURE(power, way, lamp);
        const Loaded scaled = load(directory, {0, std::pow(10.0, power), way, lamp});
        CHECK(different(picture(scaled.frame), truth) == 0);
        CHECK_FALSE(scaled.noted);
        CHECK((scaled.frame.exponent != 0) == (std::abs(power) > 20));
      }
  }
}

TEST_CASE("a frame of a program's own is the same in any unit from 2^-120 to 2^120") {
  const test::TempDirectory directory;
  for (const Lamp lamp : {Lamp::sun, Lamp::lamp, Lamp::both}) {
    const SceneFrame f = load(directory, {0, 1, Way::root, lamp}).frame;
    const auto truth = picture(f);
    for (const int exponent : {-120, -60, 60, 120}) {
      CAPTURE(exponent, lamp);
      SceneFrame scaled = f;
      const double unit = std::ldexp(1.0, exponent);
      for (glm::dvec3& p : scaled.vertices) p *= unit;
      scaled.camera.eye *= unit;
      scaled.camera.near *= unit;
      for (Light& l : scaled.lights) {
        l.position *= unit;
        if (l.falls_off) l.color *= unit * unit;
      }
      // A power of two scales all exactly, where depth begins too.
      CHECK(different(picture(scaled), truth) == 0);
    }
  }
}

TEST_CASE("far away and in an odd unit the picture is what rays say") {
  const test::TempDirectory directory;
  for (const Made& m : {Made{1e14, 1, Way::root, Lamp::sun}, Made{0, 1e-200, Way::root, Lamp::lamp},
                        Made{1e220, 1e200, Way::root, Lamp::sun}}) {
    const SceneFrame f = load(directory, m).frame;
    const RayCount count = compare_with_rays(f, kWidth, kHeight);
    INFO(count.text());
    CHECK(count.good());
    CHECK(count.shadowed > 200);
    CHECK(count.lit > 1000);
    CHECK(count.near_surface + count.near_shadow < 20);
  }
}

}  // namespace kage::verif
