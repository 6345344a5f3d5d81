// SPDX-License-Identifier: Apache-2.0
// PLY files: the three forms, all types, colours of vertices and faces, strips; what is said, what is refused.
#include <algorithm>
#include <array>

#include "plain_outcome.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::area;
using test::colors;
using test::joined;
using test::PlainFiles;

namespace {

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kList = "property list uchar int vertex_indices\n";
const std::string kFour = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";

std::string ascii(const std::string& elements, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}

/// A square's four corners and one element with vertex_indices.
std::string square(const std::string& element, const std::string& body) {
  return ascii("element vertex 4\n" + kXyz + element, kFour + body);
}

template <typename T>
std::string bytes(T value, bool big) {
  std::string s = test::bytes_of(std::vector<T>{value});
  if (big) std::reverse(s.begin(), s.end());
  return s;
}

/// A value as a file of some type has it.
std::string typed(const std::string& type, double v, bool big) {
  if (type == "char" || type == "int8") return bytes(static_cast<std::int8_t>(v), big);
  if (type == "uchar" || type == "uint8") return bytes(static_cast<std::uint8_t>(v), big);
  if (type == "short" || type == "int16") return bytes(static_cast<std::int16_t>(v), big);
  if (type == "ushort" || type == "uint16") return bytes(static_cast<std::uint16_t>(v), big);
  if (type == "int" || type == "int32") return bytes(static_cast<std::int32_t>(v), big);
  if (type == "uint" || type == "uint32") return bytes(static_cast<std::uint32_t>(v), big);
  if (type == "float" || type == "float32") return bytes(static_cast<float>(v), big);
  return bytes(v, big);
}

const std::vector<std::string> kWhole{"char", "uchar", "short", "ushort", "int",   "uint",
                                      "int8", "uint8", "int16", "uint16", "int32", "uint32"};

}  // namespace

TEST_CASE("PLY: every type for coordinates, lengths of lists and numbers in them, in all three forms") {
  const PlainFiles ply(".ply");
  std::vector<std::string> types = kWhole;
  types.insert(types.end(), {"float", "double", "float32", "float64"});
  for (const std::string& type : types)
    for (const std::string& of_list : kWhole) {
      std::string head = "element vertex 4\n";
      for (const char* axis : {"x", "y", "z"}) head += joined({"property ", type, " ", axis, "\n"});
      head += joined({"element face 2\nproperty list ", of_list, " ", of_list, " vertex_index\n"});
      const std::vector<double> places{0, 0, 0, 100, 0, 0, 100, 50, 0, 0, 50, 7};
      const std::vector<double> lists{3, 0, 1, 2, 3, 0, 2, 3};
      for (const char* form : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        CAPTURE(type, of_list, form);
        std::string text = std::string("ply\nformat ") + form + " 1.0\n" + head + "end_header\n";
        const bool in_text = form[0] == 'a';
        const bool big = std::string(form) == "binary_big_endian";
        for (std::size_t i = 0; i < places.size(); ++i)
          text += in_text ? std::to_string(static_cast<int>(places[i])) + (i % 3 == 2 ? "\n" : " ")
                          : typed(type, places[i], big);
        for (std::size_t i = 0; i < lists.size(); ++i)
          text += in_text ? std::to_string(static_cast<int>(lists[i])) + (i % 4 == 3 ? "\n" : " ")
                          : typed(of_list, lists[i], big);
        const SceneFrame f = ply.frame(text);
        REQUIRE(f.triangles.size() == 2);
        CHECK(f.vertices[1] == glm::dvec3{100, 0, 0});
        CHECK(f.vertices[3] == glm::dvec3{0, 50, 7});
      }
    }
}

TEST_CASE("PLY: lines end in any way, comments and blank lines do not count, CRLF before binary data") {
  const PlainFiles ply(".ply");
  std::string text = square("comment a b\nobj_info c\nelement face 1\n" + kList, "\n4 0 1 3 2\n\n");
  CHECK(ply.frame(text).triangles.size() == 2);
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(ply.frame(crlf).triangles.size() == 2);
  std::replace(text.begin(), text.end(), '\n', '\r');
  CHECK(ply.frame(text).triangles.size() == 2);
  std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + kXyz + "element face 1\n" + kList + "end_header\n";
  std::string binary;
  for (const char c : head) binary += c == '\n' ? std::string("\r\n") : std::string(1, c);
  // The first coordinate's lowest byte is a line feed.
  binary += std::string("\n\0\0\0", 4) + test::bytes_of(std::vector<float>{0, 0, 1, 0, 0, 0, 1, 0});
  binary += bytes<std::uint8_t>(3, false) + test::bytes_of(std::vector<std::int32_t>{0, 1, 2});
  CHECK(ply.frame(binary).triangles.size() == 1);
  CHECK(ply.frame(binary).vertices[0].x < 1e-40);
  // Where lines end at carriage returns alone, a line feed behind the last is data.
  std::replace(head.begin(), head.end(), '\n', '\r');
  binary = head + binary.substr(binary.find("end_header\r\n") + 12);
  CHECK(ply.frame(binary).triangles.size() == 1);
  CHECK(ply.notes(binary).empty());
}

TEST_CASE("PLY: colours of vertices, of each type and name") {
  const PlainFiles ply(".ply");
  const auto of = [&ply](const std::string& type, const std::string& prefix, const std::string& color) {
    std::string head = "element vertex 3\n" + kXyz;
    for (const char* c : {"red", "green", "blue"}) head += joined({"property ", type, " ", prefix, c, "\n"});
    return colors(ply.frame(ascii(head + "element face 1\n" + kList,
                                  "0 0 0 " + color + "\n1 0 0 " + color + "\n0 1 0 " + color + "\n3 0 1 2\n")));
  };
  CHECK(of("uchar", "", "255 51 0") == "1000 200 0");
  CHECK(of("uint8", "diffuse_", "255 51 0") == "1000 200 0");
  CHECK(of("ushort", "", "65535 13107 0") == "1000 200 0");
  CHECK(of("int", "", "255 51 0") == "1000 200 0");
  CHECK(of("float", "", "1 0.2 0") == "1000 200 0");
  CHECK(of("double", "diffuse_", "1.0 2e-1 0") == "1000 200 0");
  const std::string alpha = ascii(
      "element vertex 3\n" + kXyz +
          "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\nelement face 1\n" +
          kList,
      "0 0 0 1 2 3 255\n1 0 0 1 2 3 254\n0 1 0 1 2 3 0\n3 0 1 2\n");
  CHECK(ply.notes(alpha) == "2 colours have alpha of their own, which is ignored: the material's is used\n");
}

TEST_CASE("PLY: colours of faces are drawn, and those of vertices where there are both") {
  const PlainFiles ply(".ply");
  const std::string head =
      "element face 2\n" + kList + "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string text = square(head, "3 0 1 2 255 0 0\n3 1 3 2 0 0 255\n");
  CHECK(colors(ply.frame(text)) == "1000 0 0, 0 0 1000");
  CHECK(ply.frame(text).vertices.size() == 4);  // the parts still hang together
  CHECK(ply.frame(text).components.size() == 1);
  CHECK(ply.notes(text).empty());
  CHECK(
      colors(ply.frame(square("element face 2\nproperty float red\nproperty float green\nproperty float blue\n" + kList,
                              "1 0 0 3 0 1 2\n0 0.5 0 3 1 3 2\n"))) == "1000 0 0, 0 500 0");
  const std::string both = ascii("element vertex 3\n" + kXyz +
                                     "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n" +
                                     kList + "property uchar red\nproperty uchar green\nproperty uchar blue\n",
                                 "0 0 0 0 255 0\n1 0 0 0 255 0\n0 1 0 0 255 0\n3 0 1 2 255 0 0\n");
  CHECK(colors(ply.frame(both)) == "0 1000 0");
  CHECK(ply.notes(both) == "the faces' colours are ignored: the vertices' are drawn\n");
}

TEST_CASE("PLY: strips wind to and fro, -1 begins a new one") {
  const PlainFiles ply(".ply");
  const std::string six = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
  const auto strip = [&](const std::string& numbers, const std::string& type) {
    return ascii("element vertex 6\n" + kXyz + "element tristrips 1\nproperty list int " + type + " vertex_indices\n",
                 six + numbers + "\n");
  };
  const SceneFrame f = ply.frame(strip("6 0 1 2 3 4 5", "int"));
  CHECK(f.triangles.size() == 4);
  CHECK(area(f) == Approx(4));
  CHECK(ply.notes(strip("6 0 1 2 3 4 5", "int")).empty());  // no triangle had to be turned
  for (const ShadingVertex& v : f.shading) CHECK(v.normal == glm::dvec3{0, 0, 1});
  CHECK(ply.frame(strip("9 0 1 2 -1 2 3 4 -1 4", "int")).triangles.size() == 2);
  CHECK(ply.notes(strip("8 0 1 2 3 -1 2 3 4", "int")).empty());
  CHECK(ply.frame(strip("7 0 1 2 4294967295 2 3 4", "uint")).triangles.size() == 2);
  CHECK(ply.frame(strip("8 0 1 2 2 2 3 4 5", "int")).triangles.size() == 3);  // joined by triangles without area
  CHECK(ply.refusal(strip("3 0 1 6", "int")) == "line 16: vertex 6 of 6 is named (they count from 0)");
  CHECK(ply.refusal(strip("3 0 -2 1", "int")) == "line 16: vertex -2 of 6 is named (they count from 0)");
}

TEST_CASE("PLY: strips have colours, and stand before or behind faces") {
  const PlainFiles ply(".ply");
  const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string faces = "element face 1\n" + kList;
  const std::string vertices = "element vertex 4\n" + kXyz;
  // The same square twice: two triangles of a strip, and two corners of it as a face.
  const auto frame = [&](const std::string& elements, const std::string& body) {
    const std::string text = ascii(vertices + elements, kFour + body);
    CHECK(ply.notes(text).empty());
    return colors(ply.frame(text));
  };
  CHECK(frame(strips + rgb, "4 0 1 2 3 255 51 0\n") == "1000 200 0, 1000 200 0");
  CHECK(frame(strips + faces + rgb, "3 0 1 2\n3 1 3 2 255 0 0\n") == "1000 1000 1000, 1000 0 0");
  CHECK(frame(faces + rgb + strips, "3 1 3 2 255 0 0\n3 0 1 2\n") == "1000 0 0, 1000 1000 1000");
  CHECK(frame(strips + rgb + faces, "3 0 1 2 0 0 255\n3 1 3 2\n") == "0 0 1000, 1000 1000 1000");
  CHECK(frame(faces + strips + rgb, "3 1 3 2\n3 0 1 2 0 0 255\n") == "1000 1000 1000, 0 0 1000");
  CHECK(frame(strips + rgb + faces + rgb, "3 0 1 2 0 0 255\n3 1 3 2 255 0 0\n") == "0 0 1000, 1000 0 0");
}

TEST_CASE("PLY: what is ignored may be larger than a float") {
  const PlainFiles ply(".ply");
  const auto text = [](const std::string& x, const std::string& quality) {
    return ascii(
        "element vertex 3\nproperty double x\nproperty float y\nproperty float z\nproperty double quality\n"
        "element face 1\n" +
            kList,
        "0 0 0 0\n" + x + " 0 0 " + quality + "\n0 1 0 0\n3 0 1 2\n");
  };
  CHECK(ply.notes(text("1", "1e300")) == "property quality of element vertex is ignored\n");
  CHECK(ply.refusal(text("1e300", "1")) == "line 12: a position is too large");
  CHECK(ply.refusal(text("1", "1e999")) == "line 12: 1e999 is too large");
}

TEST_CASE("PLY: what is not drawn is told") {
  const PlainFiles ply(".ply");
  CHECK(
      ply.notes(square("element face 1\n" + kList +
                           "property float quality\nelement edge 2\nproperty int vertex1\nproperty int vertex2\n"
                           "element camera 1\nproperty float view_px\nproperty list uchar float rest\nelement none 5\n",
                       "3 0 1 2 0.5\n0 1\n1 2\n7 2 1 nan\n")) ==
      "property quality of element face is ignored\nelement camera is ignored\n2 points or lines are ignored\n");
  CHECK(ply.notes(square("comment TextureFile a.png\nelement face 2\n" + kList + "property list uchar float texcoord\n",
                         "3 0 1 2 0\n2 0 1 1 0.5\n")) == "1 texture is ignored\n1 point or line is ignored\n");
  CHECK(ply.notes(square("element face 1\n" + kList, "3 0 1 2\n3 1 3 2\n")) ==
        "what stands behind the last element is ignored\n");
  CHECK(ply.notes(square("Made by hand\nelement face 1\n" + kList, "3 0 1 2\n")) ==
        "line 7 is ignored: 'Made' is none of format, comment, obj_info, element, property and end_header\n");
  CHECK(ply.refusal(ascii("element vertex 4\n" + kXyz, kFour)) == "no faces");
  // A part of a normal, and alpha of no colour.
  CHECK(ply.notes(ascii("element vertex 3\n" + kXyz + "property float nx\nproperty float nz\nelement face 1\n" + kList +
                            "property uchar alpha\n",
                        "0 0 0 1 0\n1 0 0 1 0\n0 1 0 1 0\n3 0 1 2 7\n")) ==
        "property nx of element vertex is ignored\nproperty nz of element vertex is ignored\n"
        "property alpha of element face is ignored\n");
}

TEST_CASE("PLY: faces may come before their vertices, and may be of many corners") {
  const PlainFiles ply(".ply");
  CHECK(ply.frame(ascii(joined({"element face 1\n", kList, "element vertex 4\n", kXyz}), "4 0 1 3 2\n" + kFour))
            .triangles.size() == 2);
  CHECK(area(ply.frame(ascii(joined({"element vertex 5\n", kXyz, "element face 1\n", kList}),
                             "0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n5 0 1 2 3 4\n"))) == Approx(20));
}

TEST_CASE("PLY: colours outside of 0 to 1 are told") {
  const PlainFiles ply(".ply");
  CHECK(ply.notes(square("element face 2\n" + kList + "property float red\nproperty float green\n",
                         "3 0 1 2 -0.5 2\n3 1 3 2 0 -1\n")) ==
        "1 colour is above 1, and taken as 1\n2 colours are below 0, and taken as 0\n");
}

TEST_CASE("PLY: normals are drawn") {
  const PlainFiles ply(".ply");
  const std::string normals = "element vertex 3\n" + kXyz + "property float nx\nproperty float ny\nproperty float nz\n";
  const SceneFrame f =
      ply.frame(ascii(normals + "element face 1\n" + kList, "0 0 0 1 0 1\n1 0 0 1 0 1\n0 1 0 1 0 1\n3 0 1 2\n"));
  CHECK(f.shading[0].normal.x == Approx(std::sqrt(0.5)));
}

TEST_CASE("PLY: what cannot be read is refused with its place") {
  const PlainFiles ply(".ply");
  const std::string face = "element face 1\n" + kList;
  const auto body = [&](const std::string& text) {
    return ply.refusal(ascii("element vertex 3\n" + kXyz + face, text));
  };
  CHECK(body("0 0 0\n1 0 0\n0 1,5 0\n3 0 1 2\n") == "line 12: 1,5 is not a number");
  CHECK(body("0 0 0\n1 0 0\n0 1.0D+01 0\n3 0 1 2\n") == "line 12: 1.0D+01 is not a number");
  CHECK(body("0 0 0\n1 0\n0 1 0\n3 0 1 2\n") == "line 11: the line has too few numbers for element vertex");
  CHECK(body("0 0 0\n1 0 0 7\n0 1 0\n3 0 1 2\n") == "line 11: '7' is too much for element vertex");
  CHECK(body("0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n") == "line 11: a number is not finite");
  CHECK(body("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n") == "line 13: vertex 3 of 3 is named (they count from 0)");
  CHECK(body("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n") == "line 13: vertex -1 of 3 is named (they count from 0)");
  CHECK(body("0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n") == "line 13: 1.5 is no whole number from -2147483648 to 2147483647");
  CHECK(body("0 0 0\n1 0 0\n0 1 0\n300 0 1 2\n") == "line 13: 300 is no whole number from 0 to 255");
  CHECK(body("0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n") == "line 13: a list of length 4 is longer than what is left");
  CHECK(body("0 0 0\n1 0 0\n") == "line 11: the file ends behind 2 of 3 of element vertex");
  CHECK(body("0 0 0\n1 0 0\n0 1 0\n") == "line 12: the file ends behind 0 of 1 of element face");
  const auto head = [&](const std::string& text) { return ply.refusal(text); };
  CHECK(head("plo\n") == "line 1: does not begin with 'ply'");
  CHECK(head("ply\nformat ascii 1.0\nelement vertex 3\n") == "line 3: the file ends within the header");
  CHECK(head("ply\nelement vertex 3\nend_header\n") == "line 3: the header has no 'format'");
  CHECK(head("ply\nformat ebcdic 1.0\n") == "line 2: format 'ebcdic' is unknown");
  CHECK(head("ply\nformat ascii 2.0\n") == "line 2: version '2.0' is not 1.0");
  CHECK(head(ascii("element vertex -3\n", "")) == "line 3: -3 is no count of elements");
  CHECK(head(ascii("element vertex 3 \nproperty half x\n", "")) == "line 4: type 'half' is unknown");
  CHECK(head(ascii("property float x\n", "")) == "line 3: a property stands before the first element");
  CHECK(head(ascii("element face 1\nproperty list float int vertex_indices\n", "")) ==
        "line 4: 'float' is no type of a list's length");
  CHECK(head(ascii("element vertex 3\n" + kXyz + "element face 1\nproperty list uchar float vertex_indices\n",
                   "0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n"))
            .find("are not whole") != std::string::npos);
  CHECK(head(ascii("element vertex 3\n" + kXyz + "element face 1\nproperty int a\n", "0 0 0\n0 0 0\n0 0 0\n1\n")) ==
        "element face has no list vertex_indices");
  CHECK(head(square("element face 1\n" + kList + "property list uchar int vertex_index\n", "3 0 1 2 3 2 1 0\n")) ==
        "element face has both vertex_indices and vertex_index");
  CHECK(head(ascii("element vertex 1\nproperty float x\nproperty float y\n", "0 0\n")) ==
        "element vertex has no property z");
  CHECK(head(ascii("element vertex 1\nproperty float x\nproperty float x\n", "")) ==
        "line 5: there is a second property 'x'");
  CHECK(head(ascii("element vertex 1\nelement vertex 1\n", "")) == "line 4: there is a second element 'vertex'");
}

TEST_CASE("PLY: a binary file that is cut, or whose counts lie, is refused before memory is asked for") {
  const PlainFiles ply(".ply");
  const auto file = [](const std::string& vertices, const std::string& faces) {
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + vertices + "\n" + kXyz + "element face " + faces +
           "\nproperty list uint uint vertex_indices\nend_header\n";
  };
  const std::string places = test::bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::string list = test::bytes_of(std::vector<std::uint32_t>{3, 0, 1, 2});
  CHECK(ply.refusal(joined({file("3", "1"), places, list})) == "loaded");
  const std::string whole = file("3", "1") + places + list;
  for (std::size_t cut = file("3", "1").size(); cut < whole.size(); ++cut)
    CHECK(ply.refusal(whole.substr(0, cut)) != "loaded");
  CHECK(ply.refusal(joined({file("4000000000", "1"), places, list})) ==
        "4000000000 of element vertex do not fit into the 52 bytes left");
  CHECK(ply.refusal(joined({file("3", "4000000000"), places, list})) ==
        "4000000000 of element face do not fit into the 16 bytes left");
  CHECK(ply.refusal(file("3", "1") + places + test::bytes_of(std::vector<std::uint32_t>{0xffffffff, 0, 1, 2})) ==
        "element face 0: a list of length 4294967295 is longer than what is left");
  CHECK(ply.refusal(file("3", "1") + places + test::bytes_of(std::vector<std::uint32_t>{3, 0, 1, 3})) ==
        "element face 0: vertex 3 of 3 is named (they count from 0)");
  CHECK(ply.notes(whole + "x") == "what stands behind the last element is ignored\n");
  CHECK(ply.refusal("ply\nformat binary_little_endian 1.0\nproperti float x\n")
            .find("line 3: 'properti' is none of format") == 0);
  CHECK(ply.refusal(file("3", "1") + test::bytes_of(std::vector<float>{0, 0, 0, 1, 0, INFINITY, 0, 1, 0}) + list) ==
        "element vertex 1: a number is not finite");
}
