// SPDX-License-Identifier: Apache-2.0
// Formats that Assimp reads, and the same file by both readers.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "files.hpp"
#include "scene/functions.hpp"
#include "scene/import.hpp"
#include "scene/polygon.hpp"
#include "scene/transform.hpp"
#include "test/support/catch.hpp"
#include "test/support/installed.hpp"

using namespace kage;
using test::TempDirectory;

namespace {

constexpr const char* kCube = R"(o cube
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";

constexpr const char* kCollada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_cameras><camera id="eye" name="eye"><optics><technique_common><perspective>
  <yfov>40</yfov><aspect_ratio>1.5</aspect_ratio><znear>0.5</znear><zfar>50</zfar>
</perspective></technique_common></optics></camera></library_cameras>
<library_lights><light id="lamp"><technique_common><point><color>2 1 0</color></point></technique_common></light></library_lights>
<library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
    <accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
    <param name="Z" type="float"/></accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_animations><animation>
  <source id="t"><float_array id="ta" count="2">0 1</float_array><technique_common>
    <accessor source="#ta" count="2" stride="1"><param name="TIME" type="float"/></accessor></technique_common></source>
  <source id="k"><float_array id="ka" count="6">0 0 0 2 0 0</float_array><technique_common>
    <accessor source="#ka" count="2" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
    <param name="Z" type="float"/></accessor></technique_common></source>
  <source id="i"><Name_array id="ia" count="2">LINEAR LINEAR</Name_array><technique_common>
    <accessor source="#ia" count="2" stride="1"><param name="INTERPOLATION" type="name"/></accessor></technique_common></source>
  <sampler id="s"><input semantic="INPUT" source="#t"/><input semantic="OUTPUT" source="#k"/>
    <input semantic="INTERPOLATION" source="#i"/></sampler>
  <channel source="#s" target="mover/move"/>
</animation></library_animations>
<library_visual_scenes><visual_scene id="scene">
  <node id="mover" name="mover"><translate sid="move">0 0 0</translate><instance_geometry url="#g"/></node>
  <node id="c" name="c"><translate>0 0 5</translate><instance_camera url="#eye"/></node>
  <node id="l" name="l"><translate>3 4 5</translate><instance_light url="#lamp"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
)";

std::vector<glm::dvec3> flat(std::initializer_list<std::array<double, 2>> p) {
  std::vector<glm::dvec3> out;
  for (const auto& q : p) out.emplace_back(q[0], q[1], 0);
  return out;
}

// Twice the area of each triangle, signed; their sum is the polygon's.
std::vector<double> areas(const std::vector<glm::dvec3>& p) {
  std::vector<double> a;
  for (const auto& t : scene::triangulate(p)) a.push_back(scene::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]).z);
  return a;
}

// World positions of all triangles' corners, unordered, to compare two readings of a file.
std::multiset<std::array<float, 3>> corner_set(const scene::RawScene& s) {
  std::multiset<std::array<float, 3>> out;
  std::vector<scene::Affine> world;
  for (const scene::RawNode& n : s.nodes) {
    const scene::Affine own = n.fixed ? n.matrix : scene::compose(n.translation, n.rotation, n.scale);
    world.push_back(n.parent < 0 ? own : world[static_cast<std::size_t>(n.parent)] * own);
    if (n.mesh < 0) continue;
    for (const scene::RawPrimitive& p : s.meshes[static_cast<std::size_t>(n.mesh)].primitives)
      for (const std::size_t c : p.corners) {
        const glm::dvec3 q = world.back().point({p.positions[3 * c], p.positions[3 * c + 1], p.positions[3 * c + 2]});
        // Assimp's matrices are floats: compare to a thousandth.
        out.insert({static_cast<float>(std::nearbyint(q.x * 1e3)), static_cast<float>(std::nearbyint(q.y * 1e3)),
                    static_cast<float>(std::nearbyint(q.z * 1e3))});
      }
  }
  return out;
}

}  // namespace

TEST_CASE("polygons: convex as fans, concave by ears, what crosses itself somehow") {
  CHECK(scene::triangulate(flat({{0, 0}, {1, 0}})).empty());
  CHECK(areas(flat({{0, 0}, {2, 0}, {2, 1}, {0, 1}})) == std::vector<double>{2, 2});
  const auto check_area = [](const std::vector<glm::dvec3>& p, double twice) {
    double sum = 0;
    for (const double a : areas(p)) {
      CHECK(a * twice > 0);
      sum += a;
    }
    CHECK(sum == Approx(twice));
  };
  check_area(flat({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}}), 20);                              // a notch from above
  check_area(flat({{0, 4}, {2, 1}, {4, 4}, {4, 0}, {0, 0}}), -20);                             // the other way round
  check_area(flat({{0, 0}, {1, 1}, {2, 0}, {1, 4}}), 6);                                       // an arrow
  check_area(flat({{0, 0}, {6, 0}, {6, 1}, {1, 1}, {1, 5}, {6, 5}, {6, 6}, {0, 6}}), 2 * 16);  // a bracket
  CHECK(areas(flat({{0, 0}, {1, 1}, {1, 0}, {0, 1}})).size() == 2);
  CHECK(areas(flat({{0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}})).size() == 3);
}

TEST_CASE("polygons that cross themselves are found, and no others") {
  const auto crosses = [](const std::vector<glm::dvec3>& p) { return scene::crosses_itself(p); };
  CHECK_FALSE(crosses(flat({{0, 0}, {1, 0}, {0, 1}})));
  CHECK_FALSE(crosses(flat({{0, 0}, {2, 0}, {2, 1}, {0, 1}})));
  CHECK_FALSE(crosses(flat({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}})));
  CHECK_FALSE(crosses(flat({{0, 0}, {1, 1}, {2, 0}, {1, 4}})));
  CHECK_FALSE(crosses(flat({{0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}})));
  CHECK_FALSE(crosses(flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}})));
  // A hole that a cut joins to the outline: its two edges lie on each other.
  CHECK_FALSE(crosses(flat({{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}})));
  // A bow, whose halves' areas are each other's opposite, or nearly, and a corner that reaches over an edge.
  CHECK(crosses(flat({{0, 0}, {1, 1}, {1, 0}, {0, 1}})));
  CHECK(crosses(flat({{0, 0}, {2, 1}, {2, 0}, {0, 1.5}})));
  CHECK(crosses(flat({{0, 0}, {4, 0}, {4, 4}, {2, -1}, {0, 4}})));
  // One that touches an edge, or crosses it by less than a float tells, does not.
  CHECK_FALSE(crosses(flat({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}})));
  CHECK_FALSE(crosses(flat({{0, 0}, {4, 0}, {4, 4}, {2, -1e-7}, {0, 4}})));
  // Round twice, to the same side at each corner; a regular polygon goes round once. Any plane will do.
  for (const glm::dvec3& x : {glm::dvec3{1, 0, 0}, {0, 0.6, 0.8}})
    for (const std::size_t corners : {5U, 6U, 7U, 101U})
      for (const int times : {1, 2}) {
        std::vector<glm::dvec3> p;
        for (std::size_t i = 0; i < corners; ++i) {
          const double angle = 2 * portable::kPi * times * static_cast<double>(i) / static_cast<double>(corners);
          p.push_back(x * std::cos(angle) + scene::cross({0, 0.8, -0.6}, x) * std::sin(angle));
        }
        CAPTURE(corners, times);
        CHECK(crosses(p) == (times == 2));
      }
  // Many edges: a comb of 20000 teeth, as it is and with one tooth that reaches through the back.
  std::vector<glm::dvec3> teeth = flat({{0, 5}});
  for (int i = 0; i < 20000; ++i) {
    teeth.emplace_back(i, 0, 0);
    teeth.emplace_back(i + 0.5, 4, 0);
  }
  teeth.emplace_back(20000, 5, 0);
  CHECK_FALSE(crosses(teeth));
  teeth[10002].y = 6;
  CHECK(crosses(teeth));
}

TEST_CASE("a cube of quads: faces keep the file's numbers, the solid is closed and convex") {
  const TempDirectory dir;
  const Scene s = Scene::load(dir.write("cube.obj", kCube));
  CHECK(s.name() == "cube");
  const SceneFrame f = s.frame(0, 1);
  REQUIRE(f.triangles.size() == 12);
  CHECK(f.vertices.size() == 8);
  for (std::size_t i = 0; i < 12; ++i) CHECK(f.triangles[i].face == i / 2);
  REQUIRE(f.components.size() == 1);
  CHECK(f.components[0].convex);
  CHECK_FALSE(s.needs_smooth());
}

TEST_CASE("the side that a file shows stays the same, whichever way a triangle is turned") {
  const TempDirectory dir;
  const auto backs = [&dir](const std::vector<std::string>& turned) {
    std::string text = kCube;
    for (const std::string& face : turned)
      text.replace(text.find(face), face.size(), "f " + std::string(face.rbegin(), face.rend() - 2));
    const Scene s = Scene::load(dir.write("cube.obj", text));
    std::string sides;
    for (const Triangle& t : s.frame(0, 1).triangles)
      sides += t.sides == Sides::back ? 'b' : t.sides == Sides::front ? 'f' : '2';
    return sides;
  };
  CHECK(backs({}) == "ffffffffffff");
  CHECK(backs({"f 5 6 7 8"}) == "ffbbffffffff");
  CHECK(backs({"f 4 3 2 1", "f 5 6 7 8", "f 1 2 6 5", "f 2 3 7 6", "f 3 4 8 7", "f 4 1 5 8"}) == "bbbbbbbbbbbb");
}

TEST_CASE("camera, light and animation of another format") {
  const TempDirectory dir;
  const Scene s = Scene::load(dir.write("scene.dae", kCollada));
  const SceneFrame f = s.frame(1, 2);
  // Assimp turns the vertical angle into a horizontal one, in floats, by libm; back again it is the file's.
  CHECK(f.camera.perspective);
  CHECK(f.camera.half_height == Approx(std::tan(20 * 3.14159265358979 / 180)).epsilon(1e-6));
  CHECK(f.camera.near == Approx(0.5));
  CHECK(f.camera.far == Approx(50));
  CHECK(f.camera.eye == glm::dvec3{0, 0, 5});
  CHECK(f.camera.forward == glm::dvec3{0, 0, -1});
  CHECK(f.camera.up == glm::dvec3{0, 1, 0});
  CHECK_FALSE(f.lights[0].directional);
  CHECK(f.lights[0].position == glm::dvec3{3, 4, 5});
  CHECK(f.lights[0].color == glm::dvec3{1, 0.5, 0});
  CHECK(s.objects() == std::vector<std::string>{"mover"});
  CHECK(s.frame_count() == 8);
  CHECK(s.frame(0, 2).vertices[0] == glm::dvec3{0, 0, 0});
  CHECK(f.vertices[0] == glm::dvec3{1, 0, 0});  // half way from (0 0 0) to (2 0 0)
}

TEST_CASE("colours outside of 0 to 1 and polygons that cross themselves are told of Assimp's formats too") {
  const TempDirectory dir;
  const auto notes = [](const std::string& file) {
    std::string all;
    for (const std::string& note : scene::import_assimp(file, "x").notes) all += note + "\n";
    return all;
  };
  const std::string mesh = "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>";
  REQUIRE(std::string(kCollada).find(mesh) != std::string::npos);
  const auto colored = [&](const std::string& first) {
    std::string text = kCollada;
    text.replace(text.find(mesh), mesh.size(),
                 "<source id=\"c\"><float_array id=\"ca\" count=\"9\">" + first +
                     " 0 1 0 0 0 1</float_array><technique_common><accessor source=\"#ca\" count=\"3\" stride=\"3\">"
                     "<param name=\"R\" type=\"float\"/><param name=\"G\" type=\"float\"/>"
                     "<param name=\"B\" type=\"float\"/></accessor></technique_common></source>"
                     "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/>"
                     "<input semantic=\"COLOR\" source=\"#c\"/></vertices>");
    return notes(dir.write("colored.dae", text));
  };
  CHECK(colored("1 0 0").find("colour") == std::string::npos);
  CHECK(colored("2 0 0").find("1 mesh has a colour above 1, which is taken as 1\n") != std::string::npos);
  CHECK(colored("1 -1 0").find("1 mesh has a colour below 0, which is taken as 0\n") != std::string::npos);
  std::string bow = kCollada;
  for (const auto& [from, to] : {std::pair{"count=\"9\">0 0 0 1 0 0 0 1 0<", "count=\"12\">0 0 0 1 1 0 1 0 0 0 1 0<"},
                                 {"<accessor source=\"#pa\" count=\"3\"", "<accessor source=\"#pa\" count=\"4\""},
                                 {"<triangles count=\"1\">", "<polylist count=\"1\">"},
                                 {"<p>0 1 2</p></triangles>", "<vcount>4</vcount><p>0 1 2 3</p></polylist>"}}) {
    REQUIRE(bow.find(from) != std::string::npos);
    bow.replace(bow.find(from), std::string(from).size(), to);
  }
  CHECK(notes(dir.write("bow.dae", bow)).find("1 face crosses itself, and is drawn as some triangles") !=
        std::string::npos);
}

TEST_CASE("both readers see the same triangles in a glTF file") {
  const std::string root = "/usr/share/assimp/models/glTF2/";
  if (!verif::present(root)) return;
  for (const char* file : {"BoxTextured-glTF/BoxTextured.gltf", "BoxTextured-glTF-Binary/BoxTextured.glb",
                           "BoxTextured-glTF-Embedded/BoxTextured.gltf",
                           "2CylinderEngine-glTF-Binary/2CylinderEngine.glb", "ClearCoat-glTF/ClearCoatTest.gltf",
                           "cameras/Cameras.gltf", "glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_04.gltf",
                           "glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_05.gltf",
                           "glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_06.gltf",
                           "glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_12.gltf",
                           "glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf"}) {
    INFO(file);
    const auto ours = corner_set(scene::import_gltf(scene::GltfFile(root + file, file)));
    const auto theirs = corner_set(scene::import_assimp(root + file, file));
    CHECK(ours.size() == theirs.size());
    std::size_t unlike = 0;
    for (const auto& p : ours) unlike += theirs.count(p) == 0 ? 1 : 0;
    CHECK(unlike * 50 <= ours.size());  // those that a thousandth's rounding parts
  }
}
