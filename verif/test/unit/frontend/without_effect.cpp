// SPDX-License-Identifier: Apache-2.0
// Frames without the tokens that have no effect: each token that is left has one. Depths and counts are worked out here
// pixel by pixel. test/support/polygon_level.hpp holds the pixels against those of all tokens.
#include <algorithm>
#include <map>
#include <vector>

#include "contract/derived.hpp"
#include "kage/frontend.hpp"
#include "kage/scene.hpp"
#include "kage/stream.hpp"
#include "kernels/span_value.hpp"
#include "oracle/light_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

/// Tokens of a frame, and those of them that do nothing to a pixel on which something opaque is drawn.
class Idle {
 public:
  explicit Idle(const Config& c) : c_(c) {}

  void frame(std::span<const std::uint32_t> words) {
    const Layout layout(c_);
    TokenWalk walk(layout, words);
    width_ = static_cast<std::size_t>(FrameHeader::read(words).width);
    std::vector<Token> line;
    for (auto of = walk.next(); !of.empty(); of = walk.next()) {
      line.push_back(decode(c_, layout, of));
      if (line.back().kind != Kind::EOL) continue;
      judge(line);
      line.clear();
    }
  }

  std::map<Kind, int> tokens;
  std::map<Kind, int> idle;

 private:
  static constexpr std::size_t kNobody = ~std::size_t{0};

  template <class Use>
  void each_before(const SpanToken& s, Use use) const {
    for (int x = s.xl; x < s.xr; ++x)
      if (const auto at = static_cast<std::size_t>(x); span_depth(c_, s, x) < z_[at]) use(at, span_depth(c_, s, x));
  }

  void note(Kind kind, bool does) {
    ++tokens[kind];
    idle[kind] += does ? 0 : 1;
  }

  void judge(const std::vector<Token>& line) {
    z_.assign(width_, derived::clear_depth(c_));
    shown_.assign(width_, kNobody);
    std::size_t first_other = 0;  // the OPs of light after light, which come again, are not judged here
    for (; first_other < line.size() && !is_behind_opaque(line[first_other].kind); ++first_other)
      if (line[first_other].kind == Kind::OP)
        each_before(line[first_other].span, [&](std::size_t x, std::uint32_t z) {
          z_[x] = z;
          shown_[x] = first_other;
        });
    for (std::size_t i = 0; i < first_other; ++i)
      if (line[i].kind == Kind::OP) note(Kind::OP, std::count(shown_.begin(), shown_.end(), i) > 0);
    shadows(line);
  }

  static bool is_behind_opaque(Kind k) {
    return k == Kind::SP || k == Kind::NC || k == Kind::IF || k == Kind::RESOLVE || k == Kind::TP;
  }

  void shadows(const std::vector<Token>& line) {
    std::vector<int> sum(width_, 0);
    std::vector<bool> flags(width_, false);
    bool any_flag = false;
    for (const Token& t : line) {
      const bool all = t.kind == Kind::IF;
      if (t.kind == Kind::SP || t.kind == Kind::TP) {
        bool does = false;
        each_before(t.span, [&](std::size_t x, std::uint32_t) {
          does |= z_[x] != derived::clear_depth(c_) || t.kind == Kind::TP;
          if (t.kind == Kind::SP) sum[x] += t.span.w;
        });
        note(t.kind, does);
      } else if (t.kind == Kind::NC || all) {
        for (int x = all ? 0 : t.span.xl; x < (all ? static_cast<int>(width_) : t.span.xr); ++x)
          sum[static_cast<std::size_t>(x)] += t.span.w;
      } else if (t.kind == Kind::EV) {
        bool does = false;
        for (std::size_t x = 0; x < width_; ++x) {
          const bool in = (static_cast<unsigned>(sum[x]) & derived::most_dsf(c_)) != 0;
          does |= in && !flags[x] && z_[x] != derived::clear_depth(c_);
          flags[x] = flags[x] || in;
          sum[x] = 0;
        }
        note(Kind::EV, does);
        any_flag |= does;
      } else if (t.kind == Kind::ES || (t.kind == Kind::RESOLVE && c_.linear_bits == 0 && c_.count_bits == 0)) {
        if (c_.fsf != 0) note(t.kind, any_flag);
        any_flag = false;
        flags.assign(width_, false);
      } else if (t.kind == Kind::RESOLVE) {
        flags.assign(width_, false);
      }
    }
  }

  Config c_;
  std::size_t width_ = 0;
  std::vector<std::uint32_t> z_;
  std::vector<std::size_t> shown_;
};

void check(const SceneFrame& f, Config c, std::map<Kind, int>& sum) {
  c.max_width = 2047;
  const FrameGeometry g = make_geometry(f, c, 160, 120);
  std::vector<std::uint32_t> all;
  std::vector<std::uint32_t> words;
  make_frame(g, c, 0, all, {.threads = 1, .all_spans = true});
  make_frame(g, c, 0, words, {.threads = 1});
  Idle left(c);
  left.frame(words);
  for (const auto& [kind, count] : left.idle) {
    CAPTURE(kKindNames[static_cast<std::size_t>(kind)]);
    CHECK(count == 0);
  }
  Idle with(c);
  with.frame(all);
  for (const auto& [kind, count] : with.idle) sum[kind] += count;
  CHECK(words.size() <= all.size());
}

}  // namespace

TEST_CASE("of tokens without effect none is left") {
  std::map<Kind, int> idle;
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    for (int way = 0; way < 5; ++way) {
      CAPTURE(name, way);
      const SceneFrame f = scene.frame(way, 5);
      Config c;
      c.dsf_bits = way == 0 ? 1 : way;
      c.smooth = way % 2;
      c.color_frac = 8 * c.smooth;
      c.translucency = 1;
      if (way < 4)
        c = config_for_lights(f, Look{}.samples, c);
      else
        c = load_config("linear").config;
      check(f, c, idle);
    }
  }
  // All of them are there where all spans are written.
  for (const Kind kind : {Kind::OP, Kind::SP, Kind::TP, Kind::EV, Kind::ES, Kind::RESOLVE}) {
    CAPTURE(kKindNames[static_cast<std::size_t>(kind)], idle[kind]);
    UNSCOPED_INFO(kKindNames[static_cast<std::size_t>(kind)] << ": " << idle[kind] << " without effect");
    CHECK(idle[kind] > 30);
  }
}

}  // namespace kage::verif
