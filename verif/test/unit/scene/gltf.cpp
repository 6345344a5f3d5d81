// SPDX-License-Identifier: Apache-2.0
// The glTF reader: what it makes of geometry, cameras and lights, and what it refuses.
#include <cmath>

#include "files.hpp"
#include "scene/functions.hpp"
#include "scene/import.hpp"
#include "scene/transform.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::TempDirectory;
using test::triangle_gltf;

namespace {

Scene load(const std::string& text) {
  const TempDirectory dir;
  return Scene::load(dir.write("scene.gltf", text));
}

// The message without the file's name.
std::string refused(const std::string& text) {
  const TempDirectory dir;
  const std::string path = dir.write("scene.gltf", text);
  std::string message = test::refusal(path);
  CHECK(message.find('\n') == std::string::npos);
  if (message.rfind(path + ": ", 0) != 0) return message;
  return message.substr(path.size() + 2);
}

// The positions of the corners of all triangles, in order.
std::vector<glm::dvec3> corners(const Scene& scene) {
  const SceneFrame f = scene.frame(0, scene.frame_count());
  std::vector<glm::dvec3> p;
  for (const Triangle& t : f.triangles)
    for (const std::uint32_t v : t.vertex) p.push_back(f.vertices[v]);
  return p;
}

double distance(const glm::dvec3& a, const glm::dvec3& b) { return length(a - b); }

const std::string kNode = R"("nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}])";

}  // namespace

TEST_CASE("a triangle: what is added is noted") {
  const Scene s = load(triangle_gltf(kNode));
  CHECK(s.frame_count() == 8);
  CHECK(s.objects() == std::vector<std::string>{"0"});
  CHECK(corners(s) == std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  CHECK(test::has_note(s, "no camera"));
  CHECK(test::has_note(s, "no light"));
  CHECK_FALSE(s.needs_smooth());
  const SceneFrame f = s.frame(0, 1);
  CHECK(f.shading[f.triangles[0].shading[0]].normal == glm::dvec3{0, 0, 1});
  CHECK(f.components[0].reason.find("one face only") != std::string::npos);
  CHECK(f.lights[0].directional);
  CHECK(length(f.lights[0].direction) == Approx(1).epsilon(1e-15));
  CHECK(f.lights[0].direction.y < 0);
}

TEST_CASE("matrices are by columns; parents come first; a mirrored node keeps its outside") {
  const Scene s = load(triangle_gltf(R"("nodes": [
      {"children": [1], "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 10,20,30,1]}, {"mesh": 0, "translation": [1, 0, 0], "name": "kid"},
      {"mesh": 0, "scale": [1, 1, -1]}], "scenes": [{"nodes": [0, 2]}])"));
  CHECK(s.objects() == std::vector<std::string>{"kid", "0"});
  const std::vector<glm::dvec3> p = corners(s);
  CHECK(p[0] == glm::dvec3{10, 21, 30});
  CHECK(p[1] == glm::dvec3{10, 22, 30});
  CHECK(p[2] == glm::dvec3{9, 21, 30});
  // Mirrored in z: the winding turns, so that counter-clockwise is still outside, which now is -z.
  CHECK(p[4] == glm::dvec3{0, 1, 0});
  const SceneFrame f = s.frame(0, 1);
  CHECK(f.shading[f.triangles[1].shading[0]].normal.z == -1);
}

TEST_CASE("strips, fans, indices of every size, strides, sparse and normalised accessors") {
  // A square as strip and as fan from 8-bit indices; positions as floats with a stride, and as normalised bytes.
  std::string data = test::bytes_of(std::vector<float>{0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9, 1, 1, 0, 9});  // 0: 64 bytes
  data += test::bytes_of(std::vector<std::uint8_t>{0, 1, 2, 3, 0, 1, 3, 2});                    // 64: strip, fan
  data += test::bytes_of(std::vector<std::int8_t>{0, 0, 0, 0, 127, 0, 0, 0, -128, 127, 0, 0});  // 72: 3 of stride 4
  data += test::bytes_of(std::vector<std::uint16_t>{2, 0});                                     // 84: sparse index
  data += test::bytes_of(std::vector<float>{5, 5, 5});                                          // 88: sparse value
  const Scene s = load(test::gltf(R"(
      "bufferViews": [{"buffer": 0, "byteLength": 64, "byteStride": 16}, {"buffer": 0, "byteOffset": 64, "byteLength": 8},
                      {"buffer": 0, "byteOffset": 72, "byteLength": 12, "byteStride": 4},
                      {"buffer": 0, "byteOffset": 84, "byteLength": 2}, {"buffer": 0, "byteOffset": 88, "byteLength": 12}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5121, "count": 4, "type": "SCALAR"},
                    {"bufferView": 1, "byteOffset": 4, "componentType": 5121, "count": 4, "type": "SCALAR"},
                    {"bufferView": 2, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
                    {"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {"count": 1,
                     "indices": {"bufferView": 3, "componentType": 5123}, "values": {"bufferView": 4}}}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 5},
                                 {"attributes": {"POSITION": 0}, "indices": 2, "mode": 6},
                                 {"attributes": {"POSITION": 3}},
                                 {"attributes": {"POSITION": 0}, "mode": 1}]}], )" +
                                      kNode,
                                  data));
  const std::vector<glm::dvec3> p = corners(s);
  REQUIRE(p.size() == 15);
  const glm::dvec3 a{0, 0, 0};
  const glm::dvec3 b{1, 0, 0};
  const glm::dvec3 c{0, 1, 0};
  const glm::dvec3 d{1, 1, 0};
  // Strip and fan are one component: 4 triangles over the same square. The bytes make a triangle of their own.
  CHECK(std::vector<glm::dvec3>(p.begin(), p.begin() + 12) ==
        std::vector<glm::dvec3>{a, b, c, b, d, c, a, b, d, a, d, c});
  CHECK(std::vector<glm::dvec3>(p.begin() + 12, p.end()) == std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {-1, 1, 0}});
  CHECK(test::has_note(s, "1 primitive of points or lines is ignored"));
  CHECK(s.frame(0, 1).triangles[4].face == 4);
}

TEST_CASE("colours: factor times vertex colour; smooth where they differ within a triangle") {
  std::string data = test::bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  data += test::bytes_of(std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 51, 51, 51, 255});
  const Scene s = load(test::gltf(R"(
      "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC4"}],
      "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 2, 0.5]}, "alphaMode": "BLEND"}],
      "textures": [{}, {}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "material": 0}]}], )" +
                                      kNode,
                                  data));
  const SceneFrame f = s.frame(0, 1);
  CHECK(s.needs_smooth());
  CHECK(f.shading[f.triangles[0].shading[0]].color == glm::dvec3{0.5, 0, 0});
  CHECK(f.shading[f.triangles[0].shading[1]].color == glm::dvec3{0, 0.25, 0});
  CHECK(distance(f.shading[f.triangles[0].shading[2]].color, {0.1, 0.05, 0.4}) < 1e-7);
  CHECK(test::has_note(s, "2 textures are ignored"));
  CHECK_FALSE(test::has_note(s, "alpha"));
  CHECK(f.triangles[0].alpha == 128);
  CHECK(f.components[0].translucent);
}

TEST_CASE("alpha: of the material where it blends, 255 where that is opaque; masks and vertices have none") {
  const auto alpha = [](const std::string& material, const std::string& note) {
    std::string text = triangle_gltf(R"("materials": [)" + material + "], " + kNode);
    const std::string attributes = R"("attributes": {"POSITION": 0})";
    REQUIRE(text.find(attributes) != std::string::npos);
    text.insert(text.find(attributes), R"("material": 0, )");
    const Scene s = load(text);
    CHECK(test::has_note(s, "alpha") == !note.empty());
    CHECK((note.empty() || test::has_note(s, note)));
    const SceneFrame f = s.frame(0, 1);
    CHECK(f.components[0].translucent == (f.triangles[0].alpha < 255));
    return static_cast<int>(f.triangles[0].alpha);
  };
  const std::string factor = R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, )";
  CHECK(alpha("{" + factor + R"(0.2]}, "alphaMode": "BLEND"})", "") == 51);
  CHECK(alpha("{" + factor + R"(0]}, "alphaMode": "BLEND"})", "") == 0);
  CHECK(alpha("{" + factor + R"(1]}, "alphaMode": "BLEND"})", "") == 255);
  CHECK(alpha("{" + factor + R"(0.9979]}, "alphaMode": "BLEND"})", "") == 254);
  CHECK(alpha("{" + factor + R"(0.9981]}, "alphaMode": "BLEND"})", "") == 255);
  CHECK(alpha("{" + factor + R"(0.2]}})", "") == 255);
  CHECK(alpha("{" + factor + R"(0.2]}, "alphaMode": "MASK"})", "alpha mask") == 255);
}

TEST_CASE("a perspective camera: field of view, clip planes, its node's frame without the scale") {
  const Scene s =
      load(triangle_gltf(R"("cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.25}},
        {"type": "orthographic", "orthographic": {"xmag": 4, "ymag": 3, "znear": 0, "zfar": 8}}],
      "nodes": [{"mesh": 0}, {"camera": 0, "translation": [1, 2, 3], "scale": [2, 3, 4], "rotation": [0, 0.6, 0, 0.8]},
                {"camera": 1}], "scenes": [{"nodes": [0, 1, 2]}])"));
  const Camera c = s.frame(0, 1).camera;
  CHECK(s.frame_count() == 1);
  CHECK(c.perspective);
  CHECK(c.half_height == Approx(std::tan(0.5)).epsilon(1e-15));
  CHECK(c.near == 0.25);
  CHECK(c.far == 0);
  CHECK(c.eye == glm::dvec3{1, 2, 3});
  // Turned about y by the angle whose half has sine 0.6: sine 0.96, cosine 0.28.
  CHECK(distance(c.forward, {-0.96, 0, -0.28}) < 1e-15);
  CHECK(distance(c.right, {0.28, 0, -0.96}) < 1e-15);
  CHECK(distance(c.up, {0, 1, 0}) < 1e-15);
  CHECK(test::has_note(s, "1 camera is ignored"));
}

TEST_CASE("an orthographic camera") {
  const Scene s = load(triangle_gltf(R"("cameras": [{"type": "orthographic",
      "orthographic": {"xmag": 4, "ymag": 3, "znear": 0.5, "zfar": 8}}],
      "nodes": [{"mesh": 0}, {"camera": 0}], "scenes": [{"nodes": [0, 1]}])"));
  const Camera c = s.frame(0, 1).camera;
  CHECK_FALSE(c.perspective);
  CHECK(c.half_height == 3);
  CHECK(c.near == 0.5);
  CHECK(c.far == 8);
  CHECK(c.right == glm::dvec3{1, 0, 0});
  CHECK(c.up == glm::dvec3{0, 1, 0});
  CHECK(c.forward == glm::dvec3{0, 0, -1});
}

TEST_CASE("lights: all of them, with cone, fall-off and shape, and one factor for their intensities") {
  const auto with = [](const std::string& lights, const std::string& nodes) {
    return load(triangle_gltf(
        R"("extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [)" + lights +
        R"(]}}, "nodes": [{"mesh": 0}, )" + nodes + R"(], "scenes": [{"nodes": [0, 1]}])"));
  };
  const auto refusal = [](const std::string& light, const std::string& node) {
    return refused(triangle_gltf(
        R"("extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [)" + light +
        R"(]}}, "nodes": [{"mesh": 0}, )" + node + R"(], "scenes": [{"nodes": [0, 1]}])"));
  };
  const std::string node = R"({"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 2, 3],
      "rotation": [-0.70710678118654752, 0, 0, 0.70710678118654752]})";
  const std::string two =
      node.substr(0, node.size() - 1) + R"(, "children": [2]}, {"extensions": {"KHR_lights_punctual": {"light": 1}}})";

  const Scene sun = with(R"({"type": "directional", "color": [0.25, 0.5, 0], "intensity": 7})", node);
  REQUIRE(sun.frame(0, 1).lights.size() == 1);
  const Light l = sun.frame(0, 1).lights[0];
  CHECK(l.directional);
  CHECK_FALSE(l.falls_off);
  CHECK(distance(l.direction, {0, -1, 0}) < 1e-15);
  CHECK(l.color == glm::dvec3{0.5, 1, 0});
  CHECK_FALSE(test::has_note(sun, "light"));

  const Scene both = with(
      R"({"type": "spot", "intensity": 3, "range": 20, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 1.25}},
         {"type": "point", "intensity": 1, "extras": {"kage": {"shape": "disc", "radius": 0.5}}})",
      two);
  const SceneFrame f = both.frame(0, 1);
  REQUIRE(f.lights.size() == 2);
  CHECK(f.lights[0].spot);
  CHECK(f.lights[0].falls_off);
  CHECK(f.lights[0].range == 20);
  CHECK(f.lights[0].inner_cosine == Approx(std::cos(0.25)).epsilon(1e-14));
  CHECK(f.lights[0].outer_cosine == Approx(std::cos(1.25)).epsilon(1e-14));
  CHECK(f.lights[0].position == glm::dvec3{1, 2, 3});
  CHECK(distance(f.lights[0].direction, {0, -1, 0}) < 1e-15);
  CHECK(f.lights[0].color.x == Approx(3 * f.lights[1].color.x).epsilon(1e-14));
  CHECK(f.lights[1].shape == LightShape::disc);
  CHECK(distance(f.lights[1].axis_u, {0.5, 0, 0}) < 1e-15);
  CHECK(distance(f.lights[1].axis_v, {0, 0, -0.5}) < 1e-15);  // in the plane of the node's x and y

  // A node's scale is its lights' too: a ball takes that of x.
  const Scene ball = with(R"({"type": "point", "extras": {"kage": {"shape": "sphere", "radius": 0.5}}})",
                          node.substr(0, node.size() - 1) + R"(, "scale": [3, 1, 1]})");
  CHECK(ball.frame(0, 1).lights[0].shape == LightShape::sphere);
  CHECK(distance(ball.frame(0, 1).lights[0].axis_u, {1.5, 0, 0}) < 1e-15);
  const Scene window = with(R"({"type": "spot", "extras": {"kage": {"shape": "rectangle", "width": 4, "height": 2}}})",
                            node.substr(0, node.size() - 1) + R"(, "scale": [1, 3, 1]})");
  CHECK(window.frame(0, 1).lights[0].shape == LightShape::rectangle);
  CHECK(distance(window.frame(0, 1).lights[0].axis_u, {2, 0, 0}) < 1e-15);
  CHECK(distance(window.frame(0, 1).lights[0].axis_v, {0, 0, -3}) < 1e-14);

  const Scene black = with(R"({"type": "point", "intensity": 0})", node);
  CHECK(black.frame(0, 1).lights.size() == 1);
  CHECK(test::has_note(black, "1 light is black, and ignored"));
  CHECK(test::has_note(black, "no light"));
  const Scene shaped = with(R"({"type": "directional", "extras": {"kage": {"shape": "disc", "radius": 0.5}}})", node);
  CHECK(shaped.frame(0, 1).lights[0].shape == LightShape::point);
  CHECK(test::has_note(shaped, "1 directional light has a shape, which is ignored"));

  using Catch::Matchers::ContainsSubstring;
  // A light's defect is no reason to refuse a scene.
  const auto defect = [&](const std::string& light) {
    const Scene scene = with(light, node);
    for (const std::string& note : scene.notes())
      if (note.rfind("light 0: ", 0) == 0) return note.substr(9);
    return std::string();
  };
  CHECK(defect(R"({"type": "point", "intensity": -1})") ==
        "colour times intensity is negative or not finite: taken as 0");
  CHECK(defect(R"({"type": "point", "range": 0})") == "'range' is not above 0: it has none");
  CHECK(defect(R"({"type": "beam"})") == "type 'beam' is unknown: it is ignored");
  const std::string cone =
      "its cone is not 0 <= innerConeAngle <= outerConeAngle <= pi / 2: the nearest that is, is taken";
  const auto spot = [](const char* angles) { return std::string(R"({"type": "spot", "spot": {)") + angles + "}}"; };
  for (const char* angles :
       {R"("innerConeAngle": 1, "outerConeAngle": 0.5)", R"("outerConeAngle": 1.6)", R"("innerConeAngle": -0.1)",
        R"("outerConeAngle": 1.5707964897155762)", R"("outerConeAngle": -1)"}) {
    CAPTURE(angles);
    CHECK(defect(spot(angles)) == cone);
    const Light lamp = with(spot(angles), node).frame(0, 1).lights[0];
    CHECK((lamp.spot && lamp.inner_cosine >= lamp.outer_cosine && lamp.outer_cosine >= 0));
  }
  for (const char* angles : {R"("outerConeAngle": 1.5707963705062866)", R"("outerConeAngle": 1.5707963267948966)",
                             R"("innerConeAngle": 0.5, "outerConeAngle": 0.5)",
                             R"("innerConeAngle": 1.5707963705062866, "outerConeAngle": 1.5707963705062866)",
                             R"("innerConeAngle": 0, "outerConeAngle": 0)"}) {
    CAPTURE(angles);
    CHECK(defect(spot(angles)).empty());
  }
  CHECK_THAT(refusal(R"({"type": "point", "extras": {"kage": {"shape": "blob"}}})", node),
             ContainsSubstring("none of disc, rectangle and sphere"));
  CHECK_THAT(refusal(R"({"type": "point", "extras": {"kage": {"shape": "sphere"}}})", node),
             ContainsSubstring("'radius' of a sphere"));
  // kage ignores the extras of other programs.
  CHECK(with(R"({"type": "point", "extras": "anything"})", node).frame(0, 1).lights.size() == 1);
}

TEST_CASE("the scene that the file names; all roots where it has none") {
  const std::string nodes =
      R"("nodes": [{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b", "children": [2]}, {"mesh": 0, "name": "c"}])";
  CHECK(load(triangle_gltf(nodes + R"(, "scenes": [{"nodes": [0]}, {"nodes": [1]}], "scene": 1)")).objects() ==
        std::vector<std::string>{"b", "c"});
  CHECK(load(triangle_gltf(nodes)).objects() == std::vector<std::string>{"a", "b", "c"});
}

TEST_CASE("frames as the file asks") {
  std::string text = triangle_gltf(kNode);
  text.replace(text.find(R"("version": "2.0")"), 16, R"("version": "2.0", "extras": {"kage": {"frames": 5}})");
  CHECK(load(text).frame_count() == 5);
}

TEST_CASE("what the format advises against is told") {
  const TempDirectory dir;
  const auto told = [&](const std::string& members, const char* note) {
    return test::has_note(Scene::load(dir.write("t.gltf", triangle_gltf(members))), note);
  };
  for (const char* mag : {R"("xmag": -1, "ymag": 1)", R"("xmag": 1, "ymag": -1)"})
    CHECK(told(std::string(R"("cameras": [{"type": "orthographic", "orthographic": {"znear": 1, "zfar": 2, )") + mag +
                   R"(}}], "nodes": [{"mesh": 0}, {"camera": 0}])",
               "the camera's xmag or ymag is negative: its magnitude is taken, nothing is mirrored"));
  CHECK(told(R"("nodes": [{"mesh": 0, "rotation": [0, 0, 0, 2]}])",
             "1 node's rotation is no unit quaternion: brought to length 1"));
  CHECK_FALSE(told(R"("nodes": [{"mesh": 0, "rotation": [0, 0, 0.70710677, 0.70710677]}])", "quaternion"));
}

TEST_CASE("compressed by Draco: refused for it, unless the same data stand there without") {
  std::string text = triangle_gltf(R"("nodes": [{"mesh": 0}], "extensionsUsed": ["KHR_draco_mesh_compression"])");
  const std::string attributes = R"("attributes": {"POSITION": 0})";
  text.replace(
      text.find(attributes), attributes.size(),
      attributes +
          R"(, "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}})");
  CHECK(refused(text) == "loaded");
  const std::string view = R"("bufferView": 0, "componentType")";
  text.replace(text.find(view), view.size(), R"("componentType")");
  CHECK(refused(text) == "mesh 0 primitive 0: is compressed by Draco (KHR_draco_mesh_compression), which is not read");
}

TEST_CASE("refusals name the place and the cause") {
  CHECK(refused(triangle_gltf(R"("nodes": [{"mesh": 7}], "scenes": [{"nodes": [0]}])")) ==
        "node 0: asks for number 7 of 1 meshes");
  CHECK(refused(triangle_gltf(
            R"("nodes": [{"mesh": 0, "children": [1]}, {"children": [0]}], "scenes": [{"nodes": [0]}])")) ==
        "node 0: has two parents, or is its own ancestor");
  CHECK(refused(triangle_gltf(R"("nodes": [{"mesh": 0, "scale": [1, 2]}])")) == "node 0: 'scale' is not 3 numbers");
  CHECK(refused(triangle_gltf(R"("nodes": [{"mesh": -1}])")) == "node 0: 'mesh' is not a whole number");
  CHECK(refused(triangle_gltf(R"("nodes": [{}], "scenes": [{"nodes": [0]}])")) == "no faces");
  CHECK(refused(triangle_gltf(R"("cameras": [{"type": "perspective", "perspective": {"yfov": 4, "znear": 1}}],
      "nodes": [{"mesh": 0, "camera": 0}])")) == "camera 0: 'yfov' is not between 0 and pi");
  CHECK(refused(triangle_gltf(R"("nodes": [{"mesh": 0, "camera": 2}])")) == "node 0: asks for number 2 of 0 cameras");
  CHECK(refused(triangle_gltf(R"("nodes": [{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 1}}}])")) ==
        "node 0: asks for number 1 of 0 lights");
  CHECK(refused(triangle_gltf(R"("nodes": [{"mesh": 0, "rotation": [0, 0, 0, 0]}])")) ==
        "node 0: 'rotation' is a quaternion of length 0");
  CHECK(refused(
            triangle_gltf(R"("nodes": [{"mesh": 0, "matrix": [1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])")) ==
        "node 0: 'matrix' is projective: its last row is not 0, 0, 0, 1");
  CHECK(refused(triangle_gltf(
            R"("nodes": [{"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.99999994]}])")) ==
        "loaded");
  for (const char* mag : {R"("xmag": 0, "ymag": 1)", R"("ymag": 1)"})
    CHECK(refused(triangle_gltf(
              std::string(R"("cameras": [{"type": "orthographic", "orthographic": {"znear": 1, "zfar": 2, )") + mag +
              R"(}}], "nodes": [{"mesh": 0, "camera": 0}])")) == "camera 0: 'xmag' is 0 or missing");
  CHECK(refused(triangle_gltf(R"("extensionsRequired": ["KHR_draco_mesh_compression"])")).find("KHR_draco") !=
        std::string::npos);
  const std::string whole = triangle_gltf(kNode);
  CHECK(refused(whole.substr(0, whole.size() / 2)).find("not JSON, or cut off") != std::string::npos);
  CHECK(refused("[]") == "JSON: the outermost value is not an object");
  CHECK(refused(R"({"asset": {"version": "3.0"}})") == "asset: version 3.0 is not 2.x");
  CHECK(refused("{}") == "asset: no version: not glTF");
  std::string longer = whole;
  longer.replace(longer.find(R"("count": 3)"), 10, R"("count": 4)");
  CHECK(refused(longer) == "accessor 0: goes past the end of its bufferView");
  longer.replace(longer.find(R"("count": 4)"), 10, R"("count": 4294967295)");
  CHECK(refused(longer) == "accessor 0: 4294967295 elements are too many");
  longer = whole;
  longer.replace(longer.find(R"("byteLength": 36}])"), 16, R"("byteLength": 99)");
  CHECK(refused(longer).find("goes past the end of its buffer") != std::string::npos);
}

TEST_CASE("positions that are no numbers are refused by mesh and vertex; bad normals give way to the face's") {
  std::vector<float> p{0, 0, 0, 1, 0, 0, 0, NAN, 0};
  const std::string members =
      R"("bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteLength": 36, "byteOffset": 36}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "meshes": [{"name": "kite", "primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}}]}], )" +
      kNode;
  const std::string normals = test::bytes_of(std::vector<float>{0, 0, 1, 0, 0, 0, NAN, 0, 0});
  CHECK(refused(test::gltf(members, test::bytes_of(p) + normals)) == "mesh 'kite' vertex 2: position is not a number");
  p[7] = -INFINITY;
  CHECK(refused(test::gltf(members, test::bytes_of(p) + normals)) == "mesh 'kite' vertex 2: position is infinite");
  p[7] = 1;
  const Scene s = load(test::gltf(members, test::bytes_of(p) + normals));
  CHECK(test::has_note(s, "2 corners have a normal that is 0 or not finite"));
  for (const ShadingVertex& v : s.frame(0, 1).shading) CHECK(v.normal == glm::dvec3{0, 0, 1});
}

TEST_CASE("any byte changed, or the file cut anywhere: read or refused in one line") {
  // Without the child process, so that a crash is one. Text, and the same scene as a .glb.
  const std::vector<std::uint16_t> index{0, 1, 2, 0};
  const std::string data =
      test::bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2}) + test::bytes_of(index);
  const std::string members =
      R"("bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 48, "byteLength": 8},
                      {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
                    {"bufferView": 2, "componentType": 5126, "count": 3, "type": "SCALAR"}],
      "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}],
      "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0, "mode": 5}]}],
      "animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
                      "samplers": [{"input": 2, "output": 0}]}],
      "nodes": [{"mesh": 0, "children": [1]}, {"camera": 0}], "scenes": [{"nodes": [0]}])";
  const auto word = [](std::size_t v) {
    return test::bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(v)});
  };
  std::string json = R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 56}], )" + members + "}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string body = word(json.size()) + "JSON" + json + word(data.size()) + std::string("BIN\0", 4) + data;
  const std::string binary = "glTF" + word(2) + word(12 + body.size()) + body;
  const std::string text = test::gltf(members, data);

  const TempDirectory dir;
  std::size_t read = 0;
  std::size_t refused_files = 0;
  const auto attempt = [&](const char* name, const std::string& content) {
    const std::string path = dir.write(name, content);
    try {
      (void)scene::import_file(path, "x");
      ++read;
    } catch (const Error& e) {
      ++refused_files;
      const std::string message = e.what();
      if (message.rfind("x: ", 0) != 0 || message.find('\n') != std::string::npos) FAIL_CHECK(message);
    }
  };
  attempt("x.gltf", text);
  attempt("x.glb", binary);
  REQUIRE(read == 2);
  for (const auto& [name, whole] : {std::pair{"x.gltf", text}, {"x.glb", binary}})
    for (std::size_t i = 0; i < whole.size(); ++i) {
      if (i > 0) attempt(name, whole.substr(0, i));
      for (const char c : {'\0', '9', '-', '"', '\xff'}) {
        std::string changed = whole;
        changed[i] = c;
        attempt(name, changed);
      }
    }
  INFO(read << " read, " << refused_files << " refused");
  CHECK(read > 100);
  CHECK(refused_files > 1000);
}
