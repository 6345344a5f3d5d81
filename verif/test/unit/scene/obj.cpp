// SPDX-License-Identifier: Apache-2.0
// OBJ files: what is drawn of them, what is said, what is refused.
#include "plain_outcome.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::area;
using test::colors;
using test::joined;
using test::PlainFiles;

namespace {

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kTriangle = kThree + "f 1 2 3\n";

}  // namespace

TEST_CASE("an OBJ file keeps all vertices, however it is written") {
  const test::TempDirectory dir;
  const auto load = [&dir](const std::string& vertex) {
    return Scene::load(dir.write("point.obj", "v 0 0 0\nv 1 0 0\n" + vertex + "\nv 0 2 2\nf 1 2 3\n"));
  };
  for (const char* third : {"v 0 1 0.5",
                            "v 0 1 .5",
                            "v\t0 \t1\t.5 ",
                            "  v 0 1 0.5",
                            "\tv 0 1 0.5\r",
                            "v 0 1 0.5 # 4 5",
                            "v 0 1 0.5 # information",
                            "v 0 1 0.5#4 5",
                            "v 0 1 .5 # .5",
                            "v 0 1 \\\n.5",
                            "v 0 1\\\r\n 0.5",
                            "v 0 1 .5 2",
                            "v 0 1 0.5\\# c",
                            "v 0 1 .5 .25 .5 .75",
                            "v 0 1 .5 .25 .5 .75 1",
                            "v 0 1 +.5e0",
                            "v 0 1 5E-1",
                            "v 1e-60 1. 0.5",
                            "v -0 1 0.5\\ # \\",
                            "# a comment \\\nv 0 1 0.5",
                            "vn 0 0 1 # \\\nv 0 1 0.5",
                            "o a # b\\\nv 0 1 0.5",
                            "#\rv 0 1 0.5\r#",
                            "o a \\\nb\nv 0 1 0.5"}) {
    CAPTURE(third);
    const glm::dvec3 corner = load(third).frame(0, 1).vertices[2];
    CHECK(corner.x == 0);
    CHECK(corner.y == 1);
    CHECK(corner.z == 0.5);
  }
  CHECK(load("v 0 1 -.5").frame(0, 1).vertices[2].z == -0.5);
  CHECK(load("v 0 1 +.5").frame(0, 1).vertices[2].z == 0.5);
  // A byte order mark is no part of the first vertex.
  CHECK(Scene::load(dir.write("mark.obj", "\xEF\xBB\xBFv 3 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n"))
            .frame(0, 1)
            .vertices[0]
            .x == 3);
  // Faces and normals too.
  const Scene indented = Scene::load(
      dir.write("faces.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn .5 0 0\nvn 0 0 1\n f 1//2 2//2 \\\n3//2 # 4\n"));
  CHECK(indented.frame(0, 1).triangles.size() == 1);
  CHECK(indented.frame(0, 1).shading[0].normal == glm::dvec3{0, 0, 1});
}

TEST_CASE("an OBJ file with a vertex that is none is refused") {
  const test::TempDirectory dir;
  const auto load = [&dir](const std::string& vertex) {
    Scene::load(dir.write("point.obj", "v 0 0 0\nv 1 0 0\n" + vertex + "\nv 0 2 2\nf 1 2 3\n"));
  };
  using Catch::Matchers::EndsWith;
  const std::pair<const char*, int> counts[]{
      {"", 0}, {"1", 1}, {"1 2", 2}, {"1 2 3 4 5", 5}, {"1 2 3 4 5 6 7 8", 8}, {"1 2 # 3", 2}, {"\\\n1", 1}};
  for (const auto& [numbers, count] : counts) {
    CAPTURE(numbers);
    CHECK_THROWS_WITH(load(std::string("v ") + numbers),
                      EndsWith("point.obj: line 3: a vertex has 3 numbers, 4 with w, 6 or 7 with a colour, not " +
                               std::to_string(count)));
  }
  for (const char* word :
       {"abc", ".", "-", "1.0D+01", "1,5", "1.5f", "0x10", "1e", "1e+", "--1", "+-1", "1.2.3", "1_000", "3.1+e2"}) {
    CAPTURE(word);
    for (const int place : {0, 1, 2}) {
      std::string numbers[3] = {"1", "2", "3"};
      numbers[place] = word;
      CHECK_THROWS_WITH(load("v " + numbers[0] + " " + numbers[1] + " " + numbers[2]),
                        EndsWith(std::string("point.obj: line 3: ") + word + " is not a number"));
    }
    CHECK_THROWS_WITH(load(std::string("v 1 2 3 0 0 ") + word),
                      EndsWith(std::string("point.obj: line 3: ") + word + " is not a number"));
  }
  CHECK_THROWS_WITH(load("v 1 2 4\\"), EndsWith("point.obj: line 3: v is not a number"));
  for (const char* word : {"nan", "inf", "-inf", "NaN", "infinity"})
    CHECK_THROWS_WITH(load(std::string("v 1 2 ") + word), EndsWith(std::string(word) + " is not finite"));
  CHECK_THROWS_WITH(load("v 1 2 1e39"), EndsWith("point.obj: line 3: 1e39 is too large"));
  CHECK_THROWS_WITH(load("v 1 2 1e99999999999999999999"), EndsWith("is too large"));
  CHECK_NOTHROW(load("v 1 2 1e-99999999999999999999"));
  CHECK_THROWS_WITH(load("vn 1 2 z\nv 1 2 3"), EndsWith("point.obj: line 3: z is not a number"));
  CHECK_THROWS_WITH(load("vn 1 2\nv 1 2 3"), EndsWith("point.obj: line 3: a normal has 3 numbers, not 2"));
}

TEST_CASE("numbers are the nearest floats") {
  const PlainFiles obj(".obj");
  const auto x = [&obj](const std::string& word) {
    return obj.frame("v " + word + " 9 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").vertices[0].x;
  };
  CHECK(x("0.1") == static_cast<double>(0.1F));
  CHECK(x("16777217") == 16777216);
  CHECK(x("0.333333333333333333333333333") == static_cast<double>(1.0F / 3));
  CHECK(x("+1.5e+2") == 150);
  CHECK(x("1e-50") == 0);
  CHECK(x("1e-45") == static_cast<double>(1e-45F));
  CHECK(x("0." + std::string(400, '0') + "1") == 0);
  CHECK(x("1" + std::string(60, '0') + "e-60") == 1);
}

TEST_CASE("an OBJ file's colours are those of its vertices, wherever in it they begin") {
  const PlainFiles obj(".obj");
  const std::string red = "v 0 0 1 1 0 0\nv 1 0 1 1 0 0\nv 0 1 1 1 0 0\n";
  CHECK(colors(obj.frame(joined({kThree, "f 1 2 3\n", red, "f 4 5 6\n"}))) == "600 600 600, 1000 0 0");
  CHECK(colors(obj.frame(joined({red, "f 1 2 3\n", kThree, "f 4 5 6\n"}))) == "1000 0 0, 600 600 600");
  CHECK(colors(obj.frame(joined({"o a\n", kThree, "f 1 2 3\no b\n", red, "f 4 5 6\n"}))) == "600 600 600, 1000 0 0");
  CHECK(colors(obj.frame(joined({kThree, red, "f 4 5 6\nf 1 2 3\n"}))) == "1000 0 0, 600 600 600");
  // One corner of three.
  const SceneFrame f = obj.frame("v 0 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n");
  CHECK(f.shading[f.triangles[0].shading[0]].color.y == Approx(0.6));
  CHECK(f.shading[f.triangles[0].shading[1]].color == glm::dvec3{0, 1, 0});
  // Times the material's.
  obj.add("m.mtl", "newmtl m\nKd 0.5 1 1\n");
  CHECK(colors(obj.frame(joined({"mtllib m.mtl\nusemtl m\n", kThree, red, "f 1 2 3\nf 4 5 6\n"}))) ==
        "500 1000 1000, 500 0 0");
  CHECK(obj.notes(red + "f 1 2 3\n").empty());
  CHECK(obj.notes("v 0 0 0 1 1 1 0.5\nv 1 0 0 1 1 1 1\nv 0 1 0 1 1 1 1\nf 1 2 3\n") ==
        "1 colour has alpha of their own, which is ignored: the material's is used\n");
  CHECK(obj.notes("v 0 0 0 255 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") ==
        "1 vertex has a colour above 1, which is taken as 1\n");
  CHECK(obj.notes("v 0 0 0 -1 0 0\nv 1 0 0 0 0 -0.5\nv 0 1 0 0 0 0\nf 1 2 3\n") ==
        "2 vertices have a colour below 0, which is taken as 0\n");
}

TEST_CASE("the weight of an OBJ file's vertex concerns curves alone") {
  const PlainFiles obj(".obj");
  const std::string text = "v 2 0 0 2\nv 0 2 0 1\nv 0 0 2 0\nf 1 2 3\n";
  CHECK(obj.frame(text).vertices[0] == glm::dvec3{2, 0, 0});
  CHECK(obj.notes(text) == "2 vertices have a weight (w) that is not 1, which concerns curves alone and is ignored\n");
}

TEST_CASE("corners: all forms, and a face is not lost for texture coordinates or normals that are not there") {
  const PlainFiles obj(".obj");
  for (const char* face :
       {"f 1 2 3", "f 1/1 2/2 3/3", "f 1/1/1 2/2/1 3/3/1", "f 1//1 2//1 3//1", "f -3 -2 -1",
        "f -3/-3/-1 -2/-2/-1 -1/-1/-1", "f 1/ 2/ 3/", "f 1// 2// 3//", "f 1/9/1 2/9/1 3/9/1", "f\t1\t2\t3\r",
        "  f 1 2 3", "fo 1 2 3", "f 1 2 3 # 4", "f +1 +2 +3", "f 1 2\\\n 3", "f 1 2 3\\# 4"}) {
    CAPTURE(face);
    const std::string text = kThree + "vn 0 0 1\n" + face + "\n";
    CHECK(obj.frame(text).triangles.size() == 1);
    CHECK(obj.notes(text).empty());
  }
  CHECK(obj.notes(kThree + "f 1//1 2//1 3//1\n") == "3 corners name a normal that is not there: the face's is taken\n");
  CHECK(obj.notes(kThree + "vn 0 0 1\nf 1//1 2//2 3//-9\n").find("2 corners name a normal that is not there") == 0);
  for (const char* face : {"f 1 2 x", "f 1 2 3.0", "f 1 2 3/1/1/1", "f 1/x 2 3", "f 1//y 2 3", "f 0 1 2", "f 1/0 2 3",
                           "f 1 2 /3", "f 1 2 3,", "l 1 2/1/1", "p 1/1"}) {
    CAPTURE(face);
    CHECK(obj.refusal(kThree + "vn 0 0 1\n" + face + "\nf 1 2 3\n").find("line 5: ") == 0);
    CHECK(obj.refusal(kThree + "vn 0 0 1\n" + face + "\nf 1 2 3\n").find("is no vertex's number") != std::string::npos);
  }
}

TEST_CASE("faces of many corners are cut, concave ones too") {
  const PlainFiles obj(".obj");
  CHECK(area(obj.frame("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n")) == Approx(20));
  CHECK(area(obj.frame("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 5 4 3 2 1\n")) == Approx(20));
  CHECK(area(obj.frame(kThree + "v 1 1 0\nf 1 2 4 3\n")) == Approx(2));
}

TEST_CASE("faces that cross themselves are told") {
  const PlainFiles obj(".obj");
  const std::string square = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n";
  const std::string one = "1 face crosses itself, and is drawn as some triangles between its corners\n";
  CHECK(obj.notes(square + "f 1 2 3 4\nf 4 3 2 1\n").empty());
  CHECK(obj.notes(square + "f 1 3 2 4\n") == one);
  CHECK(obj.notes(square + "f 1 3 2 4\nf 1 2 4 3\n") ==
        "2 faces cross themselves, and are drawn as some triangles between their corners\n");
  CHECK(obj.notes("v 1 0 0\nv -0.809017 0.587785 0\nv 0.309017 -0.951057 0\nv 0.309017 0.951057 0\n"
                  "v -0.809017 -0.587785 0\nf 1 2 3 4 5\n") == one);
}

TEST_CASE("an OBJ file's normals are drawn, whichever faces have them") {
  const PlainFiles obj(".obj");
  const SceneFrame f = obj.frame(kThree + "v 1 1 0\nvn 1 0 1\nf 1//1 2//1 3//1\nf 2 4 3\n");
  CHECK(f.shading[f.triangles[0].shading[0]].normal.x == Approx(std::sqrt(0.5)));
  CHECK(f.shading[f.triangles[1].shading[0]].normal == glm::dvec3{0, 0, 1});
  CHECK(obj.notes(kThree + "vn nan 0 0\nf 1//1 2//1 3//1\n").find("a normal that is 0 or not finite") !=
        std::string::npos);
}

TEST_CASE("objects are those of o and g; points, lines, curves and what is not known are told") {
  const PlainFiles obj(".obj");
  const auto objects = [&obj](const std::string& text) {
    std::string all;
    const Scene scene = obj.load(text);
    for (const std::string& name : scene.objects()) all += name + ";";
    return all;
  };
  CHECK(objects(joined({"o first one\n", kTriangle, "g part # 2\n", kTriangle, "o last\n", kTriangle})) ==
        "first one;part # 2;last;");
  CHECK(objects(joined({"g a\n", kTriangle, "g b\n", kTriangle, "g a\n", kTriangle})) == "a;b;");
  CHECK(obj.notes(kTriangle + "p 1 2\nl 1 2 3\nf 1 2\n") == "4 points or lines are ignored\n");
  CHECK(obj.notes(kTriangle + "s 1\nf 1 2 3\ns off\nf 1 2 3\n") ==
        "1 face of a smoothing group has no normals, and no smooth shading\n");
  CHECK(obj.notes(kTriangle + "vp 1 2\ncstype bezier\ncurv 0 1 1 2\nend\n") ==
        "4 statements of curves and surfaces from line 5 on are ignored\n");
  CHECK(obj.notes(kTriangle + "wobble 3\nlod 2\nwobble 4\n") ==
        "2 words of t.obj are ignored: wobble (line 5), lod (line 6)\n");
  CHECK(obj.notes("# 1\n\n \t\n" + kTriangle + "vt 0 0\nvt 0 0 0\ns off\n").empty());
  CHECK(obj.refusal(kThree + "p 1 2 3\n") == "no faces");
  CHECK(obj.refusal("\xFF\xFEv") == "its text is UTF-16, which is not read (UTF-8 is)");
}

TEST_CASE("a backslash joins the next line at the end of one, and neither in a comment nor before one") {
  const PlainFiles obj(".obj");
  const auto last = [&obj](const std::string& text) {
    const SceneFrame f = obj.frame(text + "\nv 7 7 7\nf 1 2 3\n");
    return f.vertices[2];
  };
  for (const char* text :
       {"v 0 0 0\nv 1 0 0\nv 0 1 0\\# c", "v 0 0 0\nv 1 0 0\nv 0 1 0 # c\\", "v 0 0 0\\# c\nv 1 0 0\nv 0 1 0",
        "v 0 0 0\n# c \\\nv 1 0 0\nv 0 1 0", "v 0 0 0\nv 1 0 0 \\#\\\nv 0 1 0", "v 0 0 \\\n0\nv 1 0 0\nv 0\\\n 1\\\n 0",
        "o a\\\nb\nv 0 0 0\nv 1 0 0\nv 0 1 0", "o a # b \\\nv 0 0 0\nv 1 0 0\nv 0 1 0"}) {
    CAPTURE(text);
    CHECK(last(text) == glm::dvec3{0, 1, 0});
  }
  CHECK(obj.refusal("v 0 0 0\nv 1 0 0\nv 0 1 \\0\nf 1 2 3\n") == "line 3: \\0 is not a number");
  CHECK(obj.refusal("v 0 0 0\nv 1 \\\n 0 x\n") == "line 2: x is not a number");  // the statement's first line
  CHECK(obj.frame(kThree + "f 1 2 3\\").triangles.size() == 1);
}
