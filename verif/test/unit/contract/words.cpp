// SPDX-License-Identifier: Apache-2.0
// Tokens to words and back.
#include <fmt/format.h>

#include <algorithm>

#include "contract/fields.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"
#include "number/bits.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"
#include "test/support/configs.hpp"

namespace kage::verif {
TEST_CASE("every field of every token survives its way through the words, at its extremes too") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 3000; ++round) {
    const Config c = random_config(random);
    const Layout l(c);
    const auto pick = [&random](Field f) {
      const std::int64_t low = f.is_signed ? -(std::int64_t{1} << (f.bits - 1)) : 0;
      const std::int64_t high = low + static_cast<std::int64_t>((std::uint64_t{1} << f.bits) - 1);
      return random.chance(0.2) ? low : random.chance(0.2) ? high : random.integer(low, high);
    };
    SpanToken s;
    s.xl = static_cast<int>(pick(l.op_xl));
    s.xr = std::max(s.xl, static_cast<int>(pick(l.op_xr)));
    s.z = pick(l.op_z);
    s.dz = pick(l.op_dz);
    s.normal_class = c.dsf_bits == 0 ? 0 : static_cast<int>(pick(l.op_class));
    s.w = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i) {
      s.color[i] = static_cast<std::int32_t>(pick(l.op_color[i]));
      if (c.smooth != 0) s.dcolor[i] = static_cast<std::int32_t>(pick(l.op_dcolor[i]));
    }
    const auto same = [](const SpanToken& a, const SpanToken& b) {
      return a.xl == b.xl && a.xr == b.xr && a.z == b.z && a.dz == b.dz && a.normal_class == b.normal_class &&
             a.w == b.w && a.color == b.color && a.dcolor == b.dcolor;
    };
    std::vector<std::uint32_t> words;
    TokenWriter w(c, words);
    w.op(s);
    REQUIRE(words.size() == l.words[6]);
    REQUIRE(decode(c, l, words).kind == Kind::OP);
    REQUIRE(same(decode(c, l, words).span, s));
    if (c.dsf_bits == 0) continue;
    s.w = static_cast<int>(pick(l.sp_w));
    s.normal_class = 0;
    s.color = s.dcolor = {};
    words.clear();
    w.sp(s);
    REQUIRE(same(decode(c, l, words).span, s));
    words.clear();
    w.nc(s.xl, s.xr, s.w);
    const Token nc = decode(c, l, words);
    REQUIRE((nc.kind == Kind::NC && nc.span.xl == s.xl && nc.span.xr == s.xr && nc.span.w == s.w));
    words.clear();
    const int light = static_cast<int>(pick(l.es_light));
    w.es(s.xl, s.xr, light);
    const Token es = decode(c, l, words);
    REQUIRE((es.kind == Kind::ES && es.span.xl == s.xl && es.span.xr == s.xr && es.table.light == light));
    words.clear();
    TableToken entry{static_cast<int>(pick(l.table_class)), light, {}};
    for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i)
      entry.share[i] = static_cast<std::uint32_t>(pick(l.table_share[i]));
    w.table(entry);
    const Token table = decode(c, l, words);
    REQUIRE((table.kind == Kind::TABLE && table.table.normal_class == entry.normal_class));
    REQUIRE((table.table.light == light && table.table.share == entry.share));
    words.clear();
    w.inside(s.w);
    REQUIRE(decode(c, l, words).span.w == s.w);
  }
}

TEST_CASE("a value that its field does not hold is refused, never cut, and nothing of its token is written") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 300; ++round) {
    Config c = random_config(random);
    c.channels = 3;
    if (c.dsf_bits == 0) c.dsf_bits = 1;
    c.fsf = 1;
    const Layout l(c);
    std::vector<std::uint32_t> words;
    TokenWriter w(c, words);
    // The nearest values outside a field, and one so far outside that its low bits are 0.
    const auto outside = [](Field f, auto write) {
      const std::int64_t low = f.is_signed && f.bits > 0 ? -(std::int64_t{1} << (f.bits - 1)) : 0;
      const std::int64_t high = low + static_cast<std::int64_t>((std::uint64_t{1} << f.bits) - 1);
      for (const std::int64_t v :
           {low - 1, high + 1, low - (std::int64_t{1} << f.bits), high + (std::int64_t{1} << f.bits)})
        write(v);
    };
    const auto refused = [&](Field f, auto write) {
      outside(f, [&](std::int64_t v) {
        if (v < INT32_MIN || v > INT32_MAX) return;  // not of that type to begin with
        CAPTURE(to_yaml(c), v);
        REQUIRE_THROWS_AS(write(static_cast<int>(v)), Error);
        REQUIRE(words.empty());
      });
    };
    const auto refused_span = [&](Field f, auto set, bool opaque) {
      outside(f, [&](std::int64_t v) {
        SpanToken s;
        set(s, v);
        CAPTURE(to_yaml(c), v);
        REQUIRE_THROWS_AS(opaque ? w.op(s) : w.sp(s), Error);
        REQUIRE(words.empty());
      });
    };
    const auto z = [](SpanToken& s, std::int64_t v) { s.z = v; };
    const auto dz = [](SpanToken& s, std::int64_t v) { s.dz = v; };
    const auto xl = [](SpanToken& s, std::int64_t v) { s.xl = static_cast<int>(v); };
    const auto xr = [](SpanToken& s, std::int64_t v) { s.xr = static_cast<int>(v); };
    refused_span(l.op_z, z, true);
    refused_span(l.op_dz, dz, true);
    refused_span(l.op_xl, xl, true);
    refused_span(l.op_xr, xr, true);
    if (l.op_class.bits > 0)
      refused_span(
          l.op_class, [](SpanToken& s, std::int64_t v) { s.normal_class = static_cast<int>(v); }, true);
    refused_span(l.sp_z, z, false);
    refused_span(l.sp_dz, dz, false);
    refused_span(l.sp_xl, xl, false);
    refused_span(l.sp_xr, xr, false);
    refused_span(
        l.sp_w, [](SpanToken& s, std::int64_t v) { s.w = static_cast<int>(v); }, false);
    for (std::size_t i = 0; i < 3; ++i) {
      refused_span(
          l.op_color[i], [i](SpanToken& s, std::int64_t v) { s.color[i] = static_cast<int>(v); }, true);
      refused_span(
          l.op_dcolor[i], [i](SpanToken& s, std::int64_t v) { s.dcolor[i] = static_cast<int>(v); }, true);
    }
    refused(l.nc_xl, [&](int v) { w.nc(v, 0, 0); });
    refused(l.nc_xr, [&](int v) { w.nc(0, v, 0); });
    refused(l.nc_w, [&](int v) { w.nc(0, 0, v); });
    refused(l.if_w, [&](int v) { w.inside(v); });
    refused(l.ev_xl, [&](int v) { w.ev(v, 0); });
    refused(l.ev_xr, [&](int v) { w.ev(0, v); });
    refused(l.es_xl, [&](int v) { w.es(v, 0, 0); });
    refused(l.es_xr, [&](int v) { w.es(0, v, 0); });
    refused(l.es_light, [&](int v) { w.es(0, 0, v); });
    refused(l.table_class, [&](int v) { w.table({v, 0, {}}); });
    refused(l.table_light, [&](int v) { w.table({0, v, {}}); });
    for (std::size_t i = 0; i < 3; ++i)
      refused(l.table_share[i], [&](int v) {
        TableToken entry;
        entry.share[i] = static_cast<std::uint32_t>(v);
        w.table(entry);
      });
    refused(l.eol_y, [&](int v) { w.eol(v); });
    refused(l.shade_shade, [&](int v) { w.shade(static_cast<std::uint32_t>(v)); });
    refused(FrameHeader::kWidth, [&](int v) { w.header({v, 1, 0, 0}); });
    refused(FrameHeader::kHeight, [&](int v) { w.header({1, v, 0, 0}); });
  }
  std::vector<std::uint32_t> words;
  TokenWriter w(Config{}, words);
  SpanToken s;
  s.z = std::int64_t{1} << 36;
  CHECK_THROWS_WITH(w.op(s), "OP: z is 68719476736, which signed 37 bits do not hold");
}

TEST_CASE("a field has its place: what is put there is what the walk over all fields finds, and nothing else changes") {
  Random random(test_seed());
  CAPTURE(test_seed());
  const auto noise = [&random] { return static_cast<std::uint32_t>(random.integer(0, UINT32_MAX)); };
  for (int round = 0; round < 1000; ++round) {
    std::array<Field, 5> fields{};
    unsigned lsb = 0;
    for (Field& f : fields) {
      f = Field{static_cast<std::uint16_t>(lsb), static_cast<std::uint8_t>(random.in(0, kMostFieldBits)), false};
      lsb += f.bits;
    }
    std::vector<std::uint32_t> words(lsb / 32 + 1);
    for (std::uint32_t& word : words) word = noise();
    const auto at = static_cast<std::size_t>(random.in(0, 4));
    const auto value = std::uint64_t{noise()} << 32 | noise();
    std::vector<std::uint32_t> changed = words;
    put_at(changed, fields[at], value);
    CHECK(changed.back() >> lsb % 32 == words.back() >> lsb % 32);
    BitUnpacker before(words);
    BitUnpacker after(changed);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto was = static_cast<std::uint64_t>(before.take(fields[i]));
      const auto is = static_cast<std::uint64_t>(after.take(fields[i]));
      CHECK(is == (i == at ? value & ((std::uint64_t{1} << fields[i].bits) - 1) : was));
      CHECK(is == bits_at(changed, fields[i]));
    }
  }
}

TEST_CASE("no token of any configuration is longer than the longest") {
  Random random(test_seed());
  CAPTURE(test_seed());
  const auto longest = [](const Config& c) {
    const Layout l(c);
    return std::size_t{*std::max_element(l.words.begin(), l.words.end())};
  };
  CHECK(longest(kGreatest) == kMostTokenWords);
  for (int round = 0; round < 3000; ++round) CHECK(longest(random_config(random)) <= kMostTokenWords);
}

TEST_CASE("no field of any configuration has more bits than a BitUnpacker takes") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 300; ++round) {
    const Config c = round == 0 ? kGreatest : random_config(random);
    const Layout layout(c);
    for (std::size_t kind = 0; kind < kKindNames.size(); ++kind)
      each_field(c, layout, static_cast<Kind>(kind), [&](const char* name, int, Field f) {
        CAPTURE(kKindNames[kind], name);
        REQUIRE(f.bits <= kMostFieldBits);
      });
  }
}

TEST_CASE("a header's fields are where it says") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::array<std::uint32_t, kHeaderWords> words{};
  for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random.integer(0, UINT32_MAX));
  const FrameHeader h = FrameHeader::read(words);
  CHECK(static_cast<std::uint64_t>(h.width) == bits_at(words, FrameHeader::kWidth));
  CHECK(static_cast<std::uint64_t>(h.height) == bits_at(words, FrameHeader::kHeight));
  CHECK(h.background == bits_at(words, FrameHeader::kBackground));
  CHECK(h.frame == bits_at(words, FrameHeader::kFrame));
  CHECK(h.magic == bits_at(words, FrameHeader::kMagic));
  CHECK(h.version == bits_at(words, FrameHeader::kVersion));
  CHECK(h.param_hash == bits_at(words, FrameHeader::kParamHash));
}

TEST_CASE("counters need DSF, a table counters, several lights both") {
  Config c;
  c.count_bits = 2;
  c.class_bits = 3;
  c.lights = 4;
  CHECK_NOTHROW(validate(c, "c"));
  c.class_bits = 1;
  CHECK_THROWS_WITH(validate(c, "c"),
                    "c: LIGHTS > 1 needs COUNT_BITS > 0 and CLASS_BITS > 1: lights differ in counter and table "
                    "(COUNT_BITS 2, LIGHTS 4, CLASS_BITS 1)");
  c.class_bits = 2;
  c.count_bits = 0;
  CHECK_THROWS_WITH(
      validate(c, "c"),
      "c: CLASS_BITS > 1 needs COUNT_BITS > 0: the table's shares are for each sample (COUNT_BITS 0, CLASS_BITS 2)");
  c = Config{};
  c.count_bits = 1;
  CHECK_NOTHROW(validate(c, "c"));
  c.dsf_bits = c.fsf = 0;
  CHECK_THROWS_WITH(validate(c, "c"),
                    "c: COUNT_BITS > 0 needs DSF_BITS > 0: it counts samples in shadow (DSF_BITS 0, COUNT_BITS 1)");
}

TEST_CASE("tokens of light say what they are") {
  Config c;
  c.count_bits = 2;
  c.class_bits = 4;
  c.lights = 3;
  const Layout l(c);
  const auto text = [&](auto write) {
    std::vector<std::uint32_t> words;
    TokenWriter w(c, words);
    write(w);
    return to_string(c, decode(c, l, words));
  };
  CHECK(text([](TokenWriter& w) { w.table({9, 2, {0, 256, 7}}); }) == "TABLE class 9 light 2 share 0,256,7/256");
  CHECK(text([](TokenWriter& w) { w.es(3, 40, 1); }) == "ES [3, 40) light 1");
  SpanToken s;
  s.xr = 2;
  s.normal_class = 15;
  CHECK(text([&](TokenWriter& w) { w.op(s); }) == "OP [0, 2) z 0 dz 0 color 0,0,0 class 15");
  c = Config{};
  s.normal_class = 1;
  std::vector<std::uint32_t> words;
  TokenWriter(c, words).op(s);
  CHECK(to_string(c, decode(c, Layout(c), words)) == "OP [0, 2) z 0 dz 0 color 0,0,0 lit");
}

TEST_CASE("the paper's segments need the paper's widths") {
  Config c;
  c.classic = 1;
  c.z_bits = 15;
  c.z_frac = 0;
  CHECK_NOTHROW(validate(c, "c"));
  for (int Config::*member : {&Config::z_bits, &Config::z_frac, &Config::face_bits, &Config::dx_bits}) {
    Config other = c;
    ++(other.*member);
    CHECK_THROWS_WITH(validate(other, "c"),
                      fmt::format("c: CLASSIC needs Z_BITS 15, Z_FRAC 0, FACE_BITS 7 and DX_BITS 9: the paper's "
                                  "segment (Z_BITS {}, Z_FRAC {}, FACE_BITS {}, DX_BITS {}, CLASSIC 1)",
                                  other.z_bits, other.z_frac, other.face_bits, other.dx_bits));
  }
}

TEST_CASE("a valid frame passes; its counts are what was written") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 300; ++round) {
    const Config c = random_config(random);
    std::vector<std::uint32_t> words;
    const auto written = random_frame(random, c, random.in(1, 40), random.in(1, 6), words);
    CAPTURE(to_yaml(c));
    const TokenCounts counts = check_frame(c, words, "test", 0);
    REQUIRE(counts.of_kind == written);
    REQUIRE(counts.words == words.size());
  }
}

}  // namespace kage::verif
