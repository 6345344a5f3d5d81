// SPDX-License-Identifier: Apache-2.0
// The strict check of frames: what comes out of order or range is refused, with its place.
#include <fmt/format.h>

#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

using Catch::Matchers::ContainsSubstring;
using W = TokenWriter;

std::string cause(const Config& c, const std::vector<std::uint32_t>& words) {
  try {
    check_frame(c, words, "f", 0);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

/// The same of a frame of a line of 8 pixels, with what `write` writes behind its header.
template <class Write>
std::string cause_of(const Config& c, Write write) {
  std::vector<std::uint32_t> words;
  W t(c, words);
  t.header({8, 1, 0, 0});
  write(t);
  return cause(c, words);
}

}  // namespace

TEST_CASE("the table comes in order, and no class is used before it is whole") {
  Config c;
  c.count_bits = 2;
  c.class_bits = 2;
  c.lights = 2;
  const auto said = [&](auto write) { return cause_of(c, write); };
  const auto entries = [](W& t, int count) {
    for (int i = 0; i < count; ++i) t.table({i / 2 + 1, i % 2, {256, 0, 7}});
  };
  const auto op = [](W& t, int normal_class) {
    SpanToken s;
    s.xr = 8;
    s.normal_class = normal_class;
    t.op(s);
  };
  const auto rest = [](W& t) {
    t.eol(0);
    t.end();
  };
  CHECK(said([&](W& t) { entries(t, 2), op(t, 1), op(t, 0), rest(t); }).empty());
  CHECK(said([&](W& t) { entries(t, 6), op(t, 3), rest(t); }).empty());
  CHECK(said([&](W& t) { op(t, 0), rest(t); }).empty());
  CHECK_THAT(said([&](W& t) { entries(t, 2), op(t, 2); }),
             ContainsSubstring("token 3") && ContainsSubstring("(RANGE)"));
  CHECK_THAT(said([&](W& t) { entries(t, 3), op(t, 2); }),
             ContainsSubstring("token 4") && ContainsSubstring("(RANGE)"));
  // A core would take it.
  for (const int count : {1, 3, 5})
    CHECK_THAT(said([&](W& t) { entries(t, count), op(t, 0), rest(t); }),
               ContainsSubstring(fmt::format("token {}", count + 1)) && ContainsSubstring("ends within a class"));
  CHECK_THAT(said([&](W& t) { op(t, 1); }), ContainsSubstring("(RANGE)"));
  CHECK_THAT(said([&](W& t) { t.table({1, 1, {}}); }), ContainsSubstring("(RANGE)"));
  CHECK_THAT(said([&](W& t) { t.table({0, 0, {}}); }), ContainsSubstring("(RANGE)"));
  CHECK_THAT(said([&](W& t) { entries(t, 2), t.table({1, 0, {}}); }), ContainsSubstring("(RANGE)"));
  CHECK_THAT(said([&](W& t) { entries(t, 1), t.table({1, 1, {0, 257, 0}}); }), ContainsSubstring("(RANGE)"));
  CHECK_THAT(said([&](W& t) { entries(t, 2), op(t, 1), t.table({2, 0, {}}); }), ContainsSubstring("(ORDER)"));
  CHECK_THAT(said([&](W& t) { t.shade(1); }), ContainsSubstring("(KIND)"));
  // Past the last class there is no number to say.
  CHECK_THAT(said([&](W& t) { entries(t, 6), t.table({3, 0, {}}); }), ContainsSubstring("(RANGE)"));
}

TEST_CASE("a pad is zero in every bit") {
  Config c;
  c.units = 2;
  c.z_bits = 15;
  c.z_frac = 0;
  c.classic = 1;
  std::vector<std::uint32_t> words;
  W t(c, words);
  t.header({8, 1, 0, 0});
  std::size_t seg = 0;
  for (int unit = 0; unit < c.units; ++unit) {
    SegmentToken s;
    s.unit = unit;
    s.face = (1 << c.face_bits) - 1;
    s.dx = 8;
    s.sync = true;
    seg = words.size();
    t.seg(s);
  }
  t.tree();
  t.eol(0);
  t.end();
  REQUIRE(cause(c, words).empty());
  const Field pad = Layout(c).seg_pad;
  REQUIRE(pad.bits > 0);
  for (unsigned bit = pad.lsb; bit < pad.lsb + pad.bits; ++bit) {
    std::vector<std::uint32_t> bad = words;
    bad[seg + bit / 32] |= 1U << bit % 32;
    CHECK_THAT(cause(c, bad), ContainsSubstring("token 2") && ContainsSubstring("SEG's pad is not zero"));
  }
}

TEST_CASE("a sample is ended once, and RESOLVE waits for that") {
  Config c;
  c.count_bits = 2;
  const auto said = [&](auto write) { return cause_of(c, [&](W& t) { write(t), t.eol(0), t.end(); }); };
  for (const int fsf : {0, 1}) {
    c.fsf = fsf;
    const auto volume = [&](W& t) {
      t.inside(1);
      if (fsf != 0) t.ev(0, 8);
    };
    CHECK(said([&](W& t) { volume(t), t.es(0, 8, 0), volume(t), t.es(1, 1, 0), t.resolve(); }).empty());
    CHECK_THAT(said([&](W& t) { t.es(0, 8, 0); }), ContainsSubstring("token 1,") && ContainsSubstring("(ORDER)"));
    CHECK_THAT(said([&](W& t) { volume(t), t.es(0, 8, 0), t.es(0, 8, 0); }), ContainsSubstring("(ORDER)"));
    CHECK_THAT(said([&](W& t) { volume(t), t.resolve(); }), ContainsSubstring("(ORDER)"));
    CHECK_THAT(said([&](W& t) { volume(t), t.es(0, 8, 0); }), ContainsSubstring("(ORDER)"));
    CHECK_THAT(said([&](W& t) { volume(t), t.es(0, 9, 0); }), ContainsSubstring("(RANGE)"));
    CHECK_THAT(said([&](W& t) { volume(t), t.es(3, 2, 0); }), ContainsSubstring("(RANGE)"));
    CHECK_THAT(said([&](W& t) { volume(t), t.es(0, 8, 1); }), ContainsSubstring("(RANGE)"));
    CHECK_THAT(said([&](W& t) { volume(t), t.es(0, 8, 0), t.resolve(), t.es(0, 8, 0); }), ContainsSubstring("(ORDER)"));
  }
  c.fsf = 1;
  CHECK_THAT(said([&](W& t) { t.inside(1), t.es(0, 8, 0); }), ContainsSubstring("(ORDER)"));
  c.count_bits = 0;
  CHECK_THAT(said([&](W& t) { t.inside(1), t.ev(0, 8), t.es(0, 8, 0); }), ContainsSubstring("(KIND)"));
}

TEST_CASE("faults are named with frame, line, token and byte") {
  const Config c;
  std::vector<std::uint32_t> words;
  TokenWriter w(c, words);
  w.header({8, 2, 0, 77});
  w.eol(0);
  SpanToken s;
  s.xl = 3;
  s.xr = 9;
  w.op(s);
  w.eol(1);
  w.end();
  CHECK(
      cause(c, words) ==
      "f: frame 77, line 1, token 2, byte 24: xl > xr, xr > width, shade or share > 2^SHADE_FRAC, a unit or light that "
      "the core lacks, a face or table entry out of turn, or a class that the table lacks (RANGE)");

  const auto said = [&](auto write) { return cause_of(c, write); };
  const auto with = [&](auto change) {
    std::vector<std::uint32_t> v;
    TokenWriter t(c, v);
    change(t, v);
    return cause(c, v);
  };
  using V = std::vector<std::uint32_t>;
  CHECK_THAT(said([](W& t) { t.eol(1); }), ContainsSubstring("(LINE)"));
  CHECK_THAT(said([](W& t) { t.end(); }), ContainsSubstring("(LINE)"));
  CHECK_THAT(said([](W& t) { t.eol(0), t.eol(1); }), ContainsSubstring("(ORDER)"));
  CHECK_THAT(said([](W& t) { t.eol(0); }), ContainsSubstring("(LAST_EARLY)"));
  CHECK_THAT(with([](W& t, V& v) {
               t.header({8, 1, 0, 0});
               v.push_back(0);
             }),
             ContainsSubstring("(KIND)"));
  CHECK_THAT(with([](W& t, V& v) {
               t.header({8, 1, 0, 0});
               v.push_back(13);
             }),
             ContainsSubstring("(KIND)"));
  CHECK_THAT(said([](W& t) { t.ev(0, 1); }), ContainsSubstring("(ORDER)"));
  CHECK_THAT(said([](W& t) { t.resolve(); }), ContainsSubstring("(ORDER)"));
  CHECK_THAT(said([](W& t) { t.inside(1), t.resolve(); }), ContainsSubstring("(ORDER)"));
  CHECK_THAT(said([](W& t) { t.inside(1), t.ev(0, 8), t.eol(0); }), ContainsSubstring("(ORDER)"));
  CHECK_THAT(said([](W& t) { t.shade(0), t.shade(0); }), ContainsSubstring("(ORDER)"));
  CHECK_THAT(said([](W& t) { t.shade(257); }), ContainsSubstring("(RANGE)"));
  CHECK_THAT(with([](W& t, V& v) {
               t.header({8, 1, 0, 0});
               t.eol(0);
               v.back() |= 1U << 31;
             }),
             ContainsSubstring("not zero"));
  CHECK_THAT(with([](W& t, V& v) {
               t.header({8, 1, 0, 0});
               t.eol(0);
               t.end();
               v.push_back(0);
             }),
             ContainsSubstring("words after END"));
  CHECK_THAT(with([](W& t, V&) { t.header({0, 1, 0, 0}); }), ContainsSubstring("(SIZE)"));
  CHECK_THAT(with([](W& t, V& v) {
               t.header({8, 1, 0, 0});
               v[0] ^= 1;
             }),
             ContainsSubstring("(HEADER)"));
  CHECK_THAT(with([](W& t, V& v) {
               t.header({8, 1, 0, 0});
               v[2] ^= 1;
             }),
             ContainsSubstring("(PARAMS)"));
  CHECK_THAT(with([](W&, V& v) { v.push_back(kStreamMagic << 16 | kStreamVersion); }),
             ContainsSubstring("the header is cut"));
  CHECK_THAT(with([](W& t, V&) {
               t.header({8, 1, 0, 0});
               SpanToken steep;
               steep.xr = 8;
               steep.z = (std::int64_t{1} << 36) - 8;
               steep.dz = 1 << 20;
               t.op(steep);
             }),
             ContainsSubstring("depth overflows"));
}

}  // namespace kage::verif
