// SPDX-License-Identifier: Apache-2.0
// OFF files: kinds of headers, colours, what is said, what is refused.
#include "plain_outcome.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::area;
using test::colors;
using test::PlainFiles;

namespace {

const std::string kFour = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";

/// Two triangles with what stands behind their corners.
std::string pair(const std::string& first, const std::string& second) {
  return "OFF\n4 2 0\n" + kFour + "3 0 1 2 " + first + "\n3 1 3 2 " + second + "\n";
}

}  // namespace

TEST_CASE("OFF: headers with and without the word, on one line or more, with comments") {
  const PlainFiles off(".off");
  const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const char* head : {"OFF\n3 1 0\n", "OFF 3 1 0\n", "3 1 0\n", "OFF\n3 1\n", "OFF # c\n# c\n\n  \n3 1 0 # c\n\n",
                           "\xEF\xBB\xBFOFF\r\n3 1 0\r\n", "# c\nOFF\n3 1 0\n", "OFF\t3\t1\t0\n"}) {
    CAPTURE(head);
    CHECK(off.frame(head + body).triangles.size() == 1);
    CHECK(off.notes(head + body).empty());
  }
  CHECK(off.frame("OFF\n3 1 0\n0 0 0 # a\n\n1 0 0\n# b\n0 1 0\n3  0 1 2 # c").triangles.size() == 1);
}

TEST_CASE("OFF: vertices with normals, colours and places of textures") {
  const PlainFiles off(".off");
  const auto of = [&off](const std::string& head, const std::string& rest) {
    return off.frame(head + "\n3 1 0\n0 0 0 " + rest + "\n1 0 0 " + rest + "\n0 1 0 " + rest + "\n3 0 1 2\n");
  };
  CHECK(of("NOFF", "1 0 1").shading[0].normal.x == Approx(std::sqrt(0.5)));
  CHECK(colors(of("COFF", "1 0.5 0 1")) == "1000 500 0");
  CHECK(colors(of("COFF", "1.0 0.5 0")) == "1000 500 0");
  CHECK(colors(of("COFF", "255 51 0 255")) == "1000 200 0");
  CHECK(colors(of("COFF", "255 51 0")) == "1000 200 0");
  CHECK(colors(of("CNOFF", "1 0 1 255 51 0")) == "1000 200 0");
  CHECK(of("CNOFF", "1 0 1 255 51 0").shading[0].normal.x == Approx(std::sqrt(0.5)));
  CHECK(colors(of("STOFF", "0.25 0.75")) == "600 600 600");
  CHECK(colors(of("STCNOFF", "1 0 1 255 51 0 255 0.25 0.75")) == "1000 200 0");
}

TEST_CASE("OFF: colours of faces: whole numbers, others, none, and places in a list that is not there") {
  const PlainFiles off(".off");
  CHECK(colors(off.frame(pair("255 0 0", "0 51 255"))) == "1000 0 0, 0 200 1000");
  CHECK(colors(off.frame(pair("255 0 0 255", ""))) == "1000 0 0, 600 600 600");
  CHECK(colors(off.frame(pair("1.0 0 0", "0.0 0.2 1"))) == "1000 0 0, 0 200 1000");
  CHECK(colors(off.frame(pair("1.0 0.5 0.0 1.0", "0 51 255"))) == "1000 500 0, 0 200 1000");
  CHECK(colors(off.frame(pair("1 0 0", "0 0 1"))) == "1000 0 0, 0 0 1000");
  CHECK(off.notes(pair("255 0 0 255", "1.0 0.5 0.0 1.0")).empty());
  CHECK(off.notes(pair("7", "")) ==
        "1 face has the number of a colour in a list that is not in the file: drawn grey\n");
  CHECK(off.notes(pair("255 0 0 128", "0.0 0.5 0.0 0.5")) ==
        "2 colours have alpha of their own, which is ignored: the material's is used\n");
  CHECK(off.notes(pair("1.5 0 0", "")) == "1 colour is above 1, and taken as 1\n");
  CHECK(off.notes(pair("-5 0 0", "")) == "1 colour is below 0, and taken as 0\n");
  CHECK(off.notes(pair("-0.5 0 2.5", "0 0 1")) ==
        "1 colour is above 1, and taken as 1\n1 colour is below 0, and taken as 0\n");
  CHECK(off.frame(pair("255 0 0", "0 51 255")).vertices.size() == 4);  // the parts still hang together
  CHECK(off.notes("COFF\n3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2 0 0 255\n") ==
        "the faces' colours are ignored: the vertices' are drawn\n");
}

TEST_CASE("OFF: faces of any number of corners; what is not drawn is told") {
  const PlainFiles off(".off");
  CHECK(area(off.frame("OFF\n5 1 0\n0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n5 0 1 2 3 4\n")) == Approx(20));
  CHECK(off.notes("OFF\n4 3 0\n" + kFour + "3 0 1 2\n2 0 1\n1 3 255 0 0\n") == "2 points or lines are ignored\n");
  CHECK(off.notes("OFF\n4 1 0\n" + kFour + "4 0 3 1 2\n") ==
        "1 face crosses itself, and is drawn as some triangles between its corners\n");
  CHECK(off.notes("OFF\n4 1 0\n" + kFour + "3 0 1 2\n3 1 3 2\n") ==
        "what stands behind the last face, from line 8 on, is ignored\n");
}

TEST_CASE("OFF: what cannot be read is refused with its place") {
  const PlainFiles off(".off");
  const auto of = [&](const std::string& text) { return off.refusal(text); };
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 1,5\n0 1 0\n3 0 1 2\n") == "line 4: 1,5 is not a number");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 1.0D+01\n0 1 0\n3 0 1 2\n") == "line 4: 1.0D+01 is not a number");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n") == "line 4: the line's end is not a number");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n") == "line 4: inf is not finite");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 0 0.5 1\n0 1 0\n3 0 1 2\n") ==
        "line 4: a vertex has 2 numbers more than its place, not 0");
  CHECK(of("COFF\n3 1 0\n0 0 0 1 1\n1 0 0\n0 1 0\n3 0 1 2\n") ==
        "line 3: a vertex has 2 numbers more than its place, not 3 or 4");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n") == "line 6: vertex 3 of 3 is named (they count from 0)");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n") == "line 6: -1 is no vertex's number");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n") == "line 6: the line's end is no vertex's number");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0\n") == "line 6: a colour has two numbers");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1 2 3 4 5\n") == "line 6: '5' is too much for a colour");
  CHECK(of("OFF\n3 1 0\n0 0 0\n1 0 0\n") == "line 4: the file ends behind 2 of 3 vertices");
  CHECK(of("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n") == "line 6: the file ends behind 1 of 2 faces");
  CHECK(of("OFF\n4000000000 1 0\n0 0 0\n") == "line 3: the file ends behind 1 of 4000000000 vertices");
  CHECK(of("OFF\n353535235358 6 0\n") == "line 2: 353535235358 is no count of vertices");
  CHECK(of("OFF\n3 1 0 9\n") == "line 2: '9' stands behind the counts of vertices, faces and edges");
  CHECK(of("OFF BINARY\n") == "line 1: binary OFF is not read");
  CHECK(of("4OFF\n") == "line 1: 4OFF: vertices of other than three coordinates are not read");
  CHECK(of("STCN4OFF\n") == "line 1: STCN4OFF: vertices of other than three coordinates are not read");
  CHECK(of("nOFF\n5\n") == "line 1: nOFF: vertices of other than three coordinates are not read");
  CHECK(of("XOFF\n") == "line 1: 'XOFF' is none of OFF, COFF, NOFF, CNOFF and these with ST before");
  CHECK(of("# c\n") == "line 1: there is nothing in it");
  CHECK(of("hello\n") == "line 1: hello is no count of vertices");
}
