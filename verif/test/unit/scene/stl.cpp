// SPDX-License-Identifier: Apache-2.0
// STL files, text and binary: which is which, what is drawn, what is said, what is refused.
#include "plain_outcome.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::area;
using test::bytes_of;
using test::colors;
using test::PlainFiles;

namespace {

std::string facet(const std::string& vertices, const std::string& normal = "0 0 1") {
  return "facet normal " + normal + "\nouter loop\n" + vertices + "endloop\nendfacet\n";
}
const std::string kThree = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";

/// A triangle at height z, with its two own bytes.
std::string triangle(float z, std::uint16_t own = 0, float normal = 1) {
  return bytes_of(std::vector<float>{0, 0, normal, 0, 0, z, 1, 0, z, 0, 1, z}) +
         bytes_of(std::vector<std::uint16_t>{own});
}
std::string binary(std::string header, std::uint32_t count, const std::string& triangles) {
  header.resize(80, ' ');
  return header + bytes_of(std::vector<std::uint32_t>{count}) + triangles;
}

}  // namespace

TEST_CASE("STL: text in any case and with any blanks, several solids, names with blanks") {
  const PlainFiles stl(".stl");
  const std::string text = "solid first part\n" + facet(kThree) + "endsolid first part\nsolid\n" + facet(kThree) +
                           facet(kThree) + "endsolid\nsolid empty\nendsolid empty\n";
  const Scene s = stl.load(text);
  REQUIRE(s.objects().size() == 2);
  CHECK(s.objects()[0] == "first part");
  CHECK(s.frame(0, 1).triangles.size() == 3);
  std::string upper;
  for (const char c : "solid x\n" + facet(kThree) + "endsolid x\n")
    upper += c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  CHECK(stl.frame(upper).triangles.size() == 1);
  CHECK(stl.frame("\xEF\xBB\xBF \r\n\tsolid a\r\n  facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 "
                  "0 endloop endfacet\rendsolid\r\n")
            .triangles.size() == 1);
}

TEST_CASE("STL: facets of more than three corners are drawn whole") {
  const PlainFiles stl(".stl");
  const auto solid = [](const std::string& vertices) { return "solid\n" + facet(vertices, "0 0 0") + "endsolid\n"; };
  CHECK(area(stl.frame(solid("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n"))) == Approx(2));
  CHECK(area(stl.frame(solid("vertex 0 0 0\nvertex 4 0 0\nvertex 4 4 0\nvertex 2 1 0\nvertex 0 4 0\n"))) == Approx(20));
  CHECK(stl.notes("solid\n" + facet(kThree) + facet("vertex 0 0 0\nvertex 1 0 0\n") + "endsolid\n") ==
        "1 point or line is ignored\n");
}

TEST_CASE("STL: normals that are 0 or no numbers are replaced by those of faces") {
  const PlainFiles stl(".stl");
  for (const char* normal : {"0 0 0", "nan nan nan", "-nan 0 0", "inf 0 0", "0 0 0.5"}) {
    CAPTURE(normal);
    CHECK(stl.frame("solid\n" + facet(kThree, normal) + "endsolid\n").shading[0].normal == glm::dvec3{0, 0, 1});
  }
  CHECK(stl.notes("solid\n" + facet(kThree, "0 0 0") + "endsolid\n").empty());
  CHECK(stl.notes(binary("", 1, triangle(0, 0, 0))).empty());
  CHECK(stl.notes("solid\n" + facet(kThree, "nan 0 0") + "endsolid\n").find("normal that is 0 or not finite") !=
        std::string::npos);
}

TEST_CASE("STL: a binary file is one, whatever its header begins with") {
  const PlainFiles stl(".stl");
  for (const char* header : {"", "solid", "solid made by a program that does not know better", "SOLID x\n", "facet"}) {
    CAPTURE(header);
    CHECK(stl.frame(binary(header, 2, triangle(0) + triangle(1))).triangles.size() == 2);
  }
  // With bytes behind, so that its size does not tell.
  std::string zeros = binary("solid", 2, triangle(0) + triangle(1)) + "tail";
  zeros[70] = '\0';
  CHECK(stl.frame(zeros).triangles.size() == 2);
  CHECK(stl.notes(zeros) == "4 bytes behind the last triangle are ignored\n");
}

TEST_CASE("STL: colours of facets, in two programs' ways") {
  const PlainFiles stl(".stl");
  constexpr std::uint16_t kHigh = 0x8000;
  // VisCAM: bit 15 says that there is one, red is highest.
  CHECK(colors(stl.frame(binary("", 3, triangle(0, kHigh | 31U << 10) + triangle(1, kHigh | 31) + triangle(2)))) ==
        "1000 0 0, 0 0 1000, 1000 1000 1000");
  CHECK(stl.notes(binary("", 2, triangle(0, kHigh | 31) + triangle(1))).empty());
  CHECK(stl.notes(binary("", 2, triangle(0, 1) + triangle(1))) ==
        "1 triangle has bytes of a program's own that are no colour, and ignored\n");
  // Magics: bit 15 says that the body's counts, red is lowest.
  const std::string header = std::string("COLOR=") + std::string("\x00\xff\x00\xff", 4);
  CHECK(colors(stl.frame(binary(header, 3, triangle(0, kHigh) + triangle(1, 31) + triangle(2, 31U << 10)))) ==
        "0 1000 0, 1000 0 0, 0 0 1000");
  CHECK(stl.notes(binary(std::string("COLOR=") + std::string("\x00\xff\x00\x80", 4), 1, triangle(0, kHigh)))
            .find("alpha") != std::string::npos);
}

TEST_CASE("STL: what cannot be read is refused with its place") {
  const PlainFiles stl(".stl");
  const auto of = [&](const std::string& text) { return stl.refusal(text); };
  CHECK(of("solid\n" + facet("vertex 0 0 0\nvertex 1 0 x\nvertex 0 1 0\n") + "endsolid\n") ==
        "line 5: x is not a number");
  CHECK(of("solid\n" + facet("vertex 0 0 0\nvertex 1 0\nvertex 0 1 0\n") + "endsolid\n") ==
        "line 6: vertex is not a number");
  CHECK(of("solid\n" + facet("vertex 0 0 0\nvertex 1 0 1.0D+01\nvertex 0 1 0\n") + "endsolid\n") ==
        "line 5: 1.0D+01 is not a number");
  CHECK(of("solid\n" + facet("vertex 0 0 0\nvertex 1 0 nan\nvertex 0 1 0\n") + "endsolid\n") ==
        "line 5: nan is not finite");
  CHECK(of("solid\n" + facet(kThree, "0 0") + "endsolid\n") == "line 3: outer is not a number");
  CHECK(of("solid\nfacet\nouter loop\n") == "line 3: 'outer' stands where normal is to come");
  CHECK(of("solid\n" + facet(kThree + "color 1 0 0\n") + "endsolid\n") ==
        "line 7: 'color' stands where vertex or endloop is to come");
  CHECK(of("solid\n" + facet(kThree)) == "line 8: the file ends, and facet or endsolid is to come");
  CHECK(of("solid\n" + facet(kThree) + "solid\n") == "line 9: 'solid' stands where facet or endsolid is to come");
  CHECK(of("solid\n" + facet(kThree) + "endsolid\nfacet\n") == "line 10: 'facet' stands where solid is to come");
  const std::string text = "solid x\n" + facet(kThree) + "endsolid";
  for (std::size_t cut = 6; cut < text.size(); ++cut) CHECK(of(text.substr(0, cut)) != "loaded");
  CHECK(of("solid\nendsolid\n") == "no faces");
  const std::string whole = binary("", 1, triangle(0));
  for (std::size_t cut = 1; cut < whole.size(); ++cut) CHECK(of(whole.substr(0, cut)) != "loaded");
  CHECK(of(binary("", 0xffffffff, triangle(0))) == "says 4294967295 triangles, and has bytes for 1");
  CHECK(of("x") == "begins without 'solid', and has 1 byte, too few for a binary file");
  CHECK(of(binary("", 2, triangle(0) + triangle(INFINITY))) == "triangle 1: a position is not finite");
}
