// SPDX-License-Identifier: Apache-2.0
// The co-simulation can say no, and at the right pixel: frames made by hand, in which each defect of verif/faults can
// show first in one known place, go through RTL with the defect. The sound RTL passes the same frames.
#include <functional>
#include <vector>

#include "catch.hpp"
#include "cosim/model.hpp"
#include "cosim/rtl.hpp"
#include "cosim/run.hpp"
#include "kage/config.hpp"
#include "kage/stream.hpp"

using namespace kage;
using namespace kage::cosim;

namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 8;
constexpr int kFrames = 2;

const Config& config() {
  static const Config c = load_config("default").config;
  return c;
}

SpanToken span(int xl, int xr, std::int64_t z, int grey) {
  SpanToken s;
  s.xl = xl;
  s.xr = xr;
  s.z = z << config().z_frac;
  s.normal_class = 1;
  s.color = {grey, grey, grey};
  return s;
}

SpanToken volume(int xl, int xr, int w) {
  SpanToken s = span(xl, xr, 500, 0);
  s.w = w;
  return s;
}

using LineMaker = std::function<void(TokenWriter& out, int frame, int line)>;

/// On each line what `opaque` and `volumes` write.
std::vector<std::uint32_t> make(int frame, const LineMaker& opaque, const LineMaker& volumes) {
  std::vector<std::uint32_t> words;
  TokenWriter out(config(), words);
  out.header({kWidth, kHeight, 0, static_cast<std::uint32_t>(frame)});
  out.shade(1U << (config().shade_frac - 1));
  for (int y = 0; y < kHeight; ++y) {
    opaque(out, frame, y);
    if (volumes) {
      volumes(out, frame, y);
      out.ev(0, kWidth);
      out.resolve();
    }
    out.eol(y);
  }
  out.end();
  return words;
}

Report compare(const std::string& fault, const LineMaker& opaque, const LineMaker& volumes, int backpressure = 0) {
  const Model model = find_model(config(), {.fault = fault});
  const auto golden = make_golden(config());
  RtlOptions options;
  options.backpressure_percent = backpressure;
  const auto rtl = make_rtl(model.library, config(), options);
  const auto feed = [&](int frame, const WordSink& sink) {
    sink(make(frame, opaque, volumes));
    return TokenCounts{};
  };
  return run(kFrames, feed, *golden, *rtl, {});
}

void check(const std::string& fault, const LineMaker& opaque, const LineMaker& volumes, int line, int x, int expected,
           int actual) {
  CHECK(compare("", opaque, volumes).same);
  CHECK(compare("", opaque, volumes, 50).same);
  const Report r = compare(fault, opaque, volumes);
  CHECK_FALSE(r.same);
  REQUIRE(r.first_difference);
  CHECK(r.first_difference->frame == 1);
  CHECK(r.first_difference->line == line);
  CHECK(r.first_difference->x == x);
  CHECK(r.first_difference->field == "red");
  CHECK(r.first_difference->expected == expected);
  CHECK(r.first_difference->actual == actual);
}

void wall(TokenWriter& out) { out.op(span(0, kWidth, 1000, 100)); }

}  // namespace

TEST_CASE("a wrong comparison shows where two spans tie, and nowhere before") {
  const LineMaker opaque = [](TokenWriter& out, int frame, int line) {
    wall(out);
    out.op(span(50, 60, 1001, 200));                                // behind the wall: no tie
    if (frame == 1 && line == 5) out.op(span(137, 139, 1000, 30));  // a tie: the wall stays
  };
  check("wrong_compare", opaque, {}, 5, 137, 100, 30);
}

TEST_CASE("a swallowed toggle shows where a second face of the volume is crossed") {
  const LineMaker opaque = [](TokenWriter& out, int, int) { wall(out); };
  const LineMaker volumes = [](TokenWriter& out, int frame, int line) {
    out.sp(volume(10, 20, 1));
    if (frame == 1 && line == 3) {
      out.sp(volume(30, 90, 1));
      out.sp(volume(41, 90, -1));
    }
  };
  check("swallowed_toggle", opaque, volumes, 3, 41, 100, 50);
}

TEST_CASE("a token lost in a stall shows at its own pixels") {
  // A wall takes as many clocks as the line has groups; the second and third change nothing, and what follows finds the
  // core busy.
  const LineMaker opaque = [](TokenWriter& out, int frame, int line) {
    if (frame != 1 || line != 4) return;
    for (int i = 0; i < 3; ++i) wall(out);
    out.op(span(203, 204, 900, 20));
  };
  check("lost_token", opaque, {}, 4, 203, 20, 100);
}
