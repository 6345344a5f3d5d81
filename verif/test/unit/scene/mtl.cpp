// SPDX-License-Identifier: Apache-2.0
// Materials of OBJ files: none of their words keeps a scene from being drawn, and what is not drawn is said.
#include "plain_outcome.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::colors;
using test::PlainFiles;
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

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

}  // namespace

TEST_CASE("materials give their diffuse colour; textures are noted") {
  const TempDirectory dir;
  dir.write("paint.mtl", "newmtl red\nKd 0.5 0.25 0.125\nmap_Kd red.png\nnewmtl glass\nKd 0 0 1\nd 0.5\n");
  std::string text = std::string("mtllib paint.mtl\n") + kCube;
  text.replace(text.find("f 4 3 2 1"), 0, "usemtl red\n");
  text.replace(text.find("f 4 1 5 8"), 0, "usemtl glass\n");
  const Scene s = Scene::load(dir.write("cube.obj", text));
  const SceneFrame f = s.frame(0, 1);
  // Two materials, one solid; but where one is translucent, what is left is open.
  REQUIRE(f.components.size() == 2);
  CHECK_FALSE(f.components[0].translucent);
  CHECK_FALSE(f.components[0].closed);
  CHECK(f.components[1].translucent);
  CHECK(f.triangles[f.components[0].first].alpha == 255);
  CHECK(f.triangles[f.components[1].first].alpha == 128);
  CHECK(Scene::load(dir.write("cube2.obj", text), {0.5}).frame(0, 1).triangles[f.components[1].first].alpha == 64);
  CHECK(f.shading[f.triangles[0].shading[0]].color == glm::dvec3{0.5, 0.25, 0.125});
  CHECK(test::has_note(s, "1 texture is ignored"));
  CHECK_FALSE(test::has_note(s, "alpha"));
}

TEST_CASE("emission over black is unlit, other emission and gloss are noted") {
  const TempDirectory dir;
  const auto load = [&dir](const std::string& look) {
    (void)dir.write("look.mtl", "newmtl m\n" + look);
    return Scene::load(dir.write("t.obj", "mtllib look.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  };
  const auto first = [](const Scene& s) { return s.frame(0, 1).triangles[0]; };
  const Scene lamp = load("Kd 0 0 0\nKe 0.5 0.25 1\nKs 0 0 0\n");
  CHECK(first(lamp).unlit);
  CHECK(lamp.frame(0, 1).shading[0].color == glm::dvec3{0.5, 0.25, 1});
  CHECK(lamp.contents().unlit == 1);
  const Scene both = load("Kd 0.5 0.5 0.5\nKe 0 1 0\nKs 0 0 0\n");
  CHECK_FALSE(first(both).unlit);
  CHECK(test::has_note(both, "1 material emits light, which is ignored"));
  CHECK_FALSE(test::has_note(both, "glossy"));
  const Scene gloss = load("Kd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nNs 90\n");
  CHECK(test::has_note(gloss, "1 material is glossy, which is ignored"));
  CHECK_FALSE(test::has_note(gloss, "emits"));
}

TEST_CASE("materials that an OBJ file names and does not get are told") {
  const TempDirectory dir;
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto load = [&](const std::string& head) { return Scene::load(dir.write("t.obj", head + triangle)); };
  const auto told = [](const Scene& s) {
    return test::has_note(s, "no file") || test::has_note(s, "no material") || test::has_note(s, "grey");
  };
  (void)dir.write("look.mtl", "# a library\n  newmtl  red\nKd 1 0 0\nnewmtl dark red \r\nKd 0.5 0 0\n");
  CHECK_FALSE(told(load("")));
  CHECK_FALSE(told(load("mtllib look.mtl\n")));
  CHECK_FALSE(told(load("mtllib look.mtl\nusemtl red\n")));
  CHECK_FALSE(told(load("mtllib look.mtl \nusemtl dark red\n")));
  CHECK_FALSE(told(load("mtllib look.mtl\nusemtl rde\nusemtl red\n")));  // nothing is drawn of it
  // The file is not there: it is named once, whatever is asked of it.
  const Scene lost = load("mtllib nothere.mtl\nmtllib nothere.mtl\nusemtl red\n");
  CHECK(test::has_note(lost, "no file nothere.mtl: its materials are drawn grey"));
  CHECK_FALSE(test::has_note(lost, "no material"));
  CHECK(test::has_note(load("mtllib look.mtl\nusemtl rde\n"), "no material 'rde': drawn grey"));
  CHECK(test::has_note(load("usemtl red\n"), "no material 'red': drawn grey"));
  std::string many = "mtllib look.mtl\n";
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g"})
    many += std::string("usemtl ") + name + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -3\n";
  CHECK(test::has_note(load(many + "usemtl red\n"), "no materials 'a', 'b', 'c', 'd', 'e' and 2 more: drawn grey"));
  // One of the scene's own name is taken then.
  (void)dir.write("t.mtl", "newmtl red\nKd 1 0 0\n");
  const Scene own = load("mtllib nothere.mtl\nusemtl red\n");
  CHECK(test::has_note(own, "no file nothere.mtl: the materials are those of t.mtl"));
  CHECK_FALSE(test::has_note(own, "grey"));
  CHECK(own.frame(0, 1).shading[0].color == glm::dvec3{1, 0, 0});
}

TEST_CASE("no word of a material keeps a scene from being drawn; each that is ignored is told once, with its line") {
  const PlainFiles obj(".obj");
  const auto look = [&obj](const std::string& words) {
    obj.add("m.mtl", "newmtl m\nKs 0 0 0\n" + words);
    return std::string("mtllib m.mtl\nusemtl m\n") + kTriangle;
  };
  struct Case {
    const char* words;
    const char* color;
    const char* note;
  };
  for (const Case& c : {
           Case{"Kd 0.8\n", "800 800 800", ""},
           {"Kd 0.5 0.25 1\n", "500 250 1000", ""},
           {"\tKd\t+.5 2.5e-1 1.\r\n", "500 250 1000", ""},
           {"Kd 0.5 0.25 1 # 4\n", "500 250 1000", ""},
           {"Kd 0.5 0.25\n", "600 600 600", "1 word of m.mtl is ignored: Kd of two numbers (line 3)\n"},
           {"Kd\n", "600 600 600", "1 word of m.mtl is ignored: Kd alone (line 3)\n"},
           {"Kd 1 0 0 0\n", "600 600 600", "1 word of m.mtl is ignored: Kd 0 (line 3)\n"},
           {"Kd spectral red.rfl 0.5\n", "600 600 600", "1 word of m.mtl is ignored: Kd spectral (line 3)\n"},
           {"Kd xyz 0.5 0.5 0.5\n", "600 600 600", "1 word of m.mtl is ignored: Kd xyz (line 3)\n"},
           {"Kd 1,0 0 0\n", "600 600 600", "1 word of m.mtl is ignored: Kd 1,0 (line 3)\n"},
           {"Kd nan 0 0\n", "600 600 600", "1 word of m.mtl is ignored: Kd nan (line 3)\n"},
           {"Kd 1 0 0\naniso 0.5\nanisor 0.1\naniso 0.6\n", "1000 0 0",
            "2 words of m.mtl are ignored: aniso (line 4), anisor (line 5)\n"},
           {"Kd 1 0 0\nd -halo 0.5\n", "1000 0 0", "1 word of m.mtl is ignored: d -halo (line 4)\n"},
           {"Kd 1 0 0\nd half\n", "1000 0 0", "1 word of m.mtl is ignored: d half (line 4)\n"},
           {"Kd 1 0 0\nTf 0 1 0\nillum glass\n", "1000 0 0",
            "2 words of m.mtl are ignored: Tf (line 4), illum glass (line 5)\n"},
           {"Kd 1 0 0\nKa 1 1 1\nNs 90\nNi 1.5\nTf 1 1 1\nTf 1\nillum 2\nsharpness 60\nmap_aat on\n", "1000 0 0", ""},
           {"Kd 1 0 0\ndecal -s 1 1 1 a b.png\nbump x.png\nmap_Kd -clamp on y.png\nnorm n.png\n", "1000 0 0",
            "4 textures are ignored\n"},
           {"Kd 1 0 0\nPm 0.5\n", "1000 0 0", "1 material is glossy, which is ignored: drawn matt\n"},
           {"Kd 1 0 0\nPr 0.5\n", "1000 0 0", "1 material is glossy, which is ignored: drawn matt\n"},
           {"Kd 1 0 0\nPr 1\nPm 0\nPs 0\nPc 0\nPcr 0.5\n", "1000 0 0", ""},
           {"Kd 1 0 0\nillum 0\n", "1000 0 0",
            "1 material is said to be without shading, which is ignored: drawn lit\n"},
           {"Kd 1 0 0\nillum 7\n", "1000 0 0", "1 material is glossy, which is ignored: drawn matt\n"},
           {"Kd 255 0 0\n", "1000 0 0", "1 material has a colour above 1, which is taken as 1\n"},
           {"Kd -1 0.5 2\n", "0 500 1000",
            "1 material has a colour above 1, which is taken as 1\n"
            "1 material has a colour below 0, which is taken as 0\n"},
           {"Kd 0 0 0\nKe 3 0.5 -1\n", "1000 500 0",
            "1 material has a colour above 1, which is taken as 1\n"
            "1 material has a colour below 0, which is taken as 0\n"},
           {"Kd 1 0 0\nd 1.5\n", "1000 0 0", "1 material has an opacity above 1, which is taken as 1\n"},
           {"Kd 1 0 0\nd 0\n", "1000 0 0", "1 material has opacity 0, which is ignored: drawn opaque\n"},
       }) {
    CAPTURE(c.words);
    const std::string text = look(c.words);
    CHECK(colors(obj.frame(text)) == c.color);
    CHECK(obj.notes(text) == c.note);
  }
  obj.add("m.mtl", "Kd 1 0 0\nnewmtl m\nKd 0 1 0\nnewmtl m\nKd 0 0 1\n");
  CHECK(colors(obj.frame("mtllib m.mtl\nusemtl m\n" + kTriangle)) == "0 1000 0");
  CHECK(obj.notes("mtllib m.mtl\nusemtl m\n" + kTriangle) ==
        "1 word of m.mtl is ignored: Kd (line 1)\n"
        "1 material of m.mtl has a name that was there before, and is ignored\n");
}

TEST_CASE("opacity is that of d, or of Tr where there is no d") {
  const PlainFiles obj(".obj");
  const auto alpha = [&obj](const std::string& words) {
    obj.add("m.mtl", "newmtl m\n" + words);
    return obj.frame("mtllib m.mtl\nusemtl m\n" + kTriangle).triangles[0].alpha;
  };
  CHECK(alpha("d 0.5\n") == 128);
  CHECK(alpha("Tr 0.25\n") == 191);
  CHECK(alpha("d 0.5\nTr 0.25\n") == 128);
  CHECK(alpha("Tr 0.25\nd 0.5\n") == 128);
  CHECK(alpha("d 1\nTr 1\n") == 255);  // Tr as some programs write d
  CHECK(alpha("d -halo 0.5\n") == 128);
  CHECK(alpha("d 1.5\n") == 255);
}

TEST_CASE("libraries: several in a line, blanks in names, names of other machines, comments") {
  const PlainFiles obj(".obj");
  obj.add("red.mtl", "newmtl red\nKd 1 0 0\n");
  obj.add("green one.mtl", "newmtl green # 5\nKd 0 1 0\n");
  const auto drawn = [&obj](const std::string& library, const std::string& material) {
    return colors(obj.frame("mtllib " + library + "\nusemtl " + material + "\n" + kTriangle));
  };
  for (const char* name :
       {"red.mtl", "./red.mtl", "\"red.mtl\"", "red.mtl # c", "red.mtl none.mtl", "none.mtl\tred.mtl",
        "C:\\models\\red.mtl", "..\\red.mtl", "/home/somebody/red.mtl", "red.mtl red.mtl"}) {
    CAPTURE(name);
    CHECK(drawn(name, "red") == "1000 0 0");
  }
  for (const char* name : {"green one.mtl", "\"green one.mtl\"", "green one.mtl # c"}) {
    CAPTURE(name);
    for (const char* material : {"green", "green # 5", "green # of grass"}) CHECK(drawn(name, material) == "0 1000 0");
  }
  CHECK(obj.notes("mtllib red.mtl none.mtl\nusemtl red\n" + kTriangle) ==
        "no file none.mtl: its materials are drawn grey\n");
  CHECK(obj.notes("mtllib a b.mtl\nusemtl red\n" + kTriangle) == "no file a b.mtl: its materials are drawn grey\n");
  // A library may come after its materials are asked for, and the first that has one counts.
  obj.add("other.mtl", "newmtl red\nKd 0 0 1\nnewmtl\nKd 0 1 1\n");
  CHECK(colors(obj.frame("usemtl red\n" + kTriangle + "mtllib red.mtl\nmtllib other.mtl\n")) == "1000 0 0");
  CHECK(drawn("other.mtl", "") == "0 1000 1000");
  CHECK(obj.notes("usemtl\n" + kTriangle).empty());
}
