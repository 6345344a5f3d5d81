// SPDX-License-Identifier: Apache-2.0
// Random screen polygons at the polygon level: the front end makes the very tokens of the span level of them. Slivers,
// bent outlines, huge coordinates, polygons of one line and of none, planes of any slope, volumes with near caps,
// fragments with cuts, pictures of any width, and any configuration.
#include "test/support/polygon_level.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "extremes/screen.hpp"
#include "kage/error.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"
#include "test/support/configs.hpp"

namespace kage::verif {
namespace {

/// Makes frames of one configuration.
class FrameMaker {
 public:
  FrameMaker(Random& random, const Config& c, int width, int height) : r_(random), c_(c) {
    g_.width = width;
    g_.height = height;
  }

  FrameGeometry make() {
    // Shadows take anything from nothing to all of a colour.
    const auto share = [&] {
      const auto whole = static_cast<int>(derived::whole_share(c_));
      return static_cast<std::uint32_t>(r_.chance(0.3) ? whole * r_.in(0, 1) : r_.in(0, whole));
    };
    g_.shade = share();
    if (derived::has_table(c_)) {
      classes_ = 2;
      g_.shares.resize(std::size_t{2} * static_cast<std::size_t>(c_.lights));
      for (auto& entry : g_.shares)
        if (!r_.chance(0.3)) entry = {share(), share(), share()};
    }
    if (c_.linear_bits > 0)
      for (int n = r_.in(1, 3); n > 0; --n) g_.passes.push_back(r_.in(1, (1 << std::max(c_.count_bits, 1)) - 1));
    const int opaque = r_.in(0, 12);
    for (int i = 0; i < opaque; ++i) polygon();
    g_.drawn = static_cast<std::uint32_t>(g_.polygons.size());
    if (c_.dsf_bits > 0) volumes();
    if (c_.translucency > 0) fragments();
    return std::move(g_);
  }

 private:
  int coordinate(int size) {
    const int most = kGuard * 256;
    switch (r_.in(0, 4)) {
      case 0:
        return r_.in(-most, most);
      case 1:  // right at a pixel's centre
        return std::clamp((r_.in(-2, size + 2) * 256) + 128 + r_.in(-1, 1), -most, most);
      default:
        return std::clamp(r_.in(-size * 100, size * 356), -most, most);
    }
  }
  ScreenVertex vertex() { return {coordinate(g_.width), coordinate(g_.height)}; }

  Outline outline() {
    const int most = kGuard * 256;
    const auto near = [&](ScreenVertex v, int by) {
      return ScreenVertex{std::clamp(v.x + r_.in(-by, by), -most, most), std::clamp(v.y + r_.in(-by, by), -most, most)};
    };
    Outline o;
    switch (r_.in(0, 5)) {
      case 0:  // any, bent and crossing itself
        for (int n = r_.in(3, 8); n > 0; --n) o.push_back(vertex());
        break;
      case 1: {  // a sliver
        const ScreenVertex a = vertex();
        o = {a, vertex(), near(a, 40)};
        break;
      }
      case 2: {  // about a line high
        const ScreenVertex a = vertex();
        o = {a, {std::clamp(a.x + r_.in(-9000, 9000), -most, most), a.y}, near(a, 200)};
        break;
      }
      case 3: {  // edges of many lines, with corners between them
        const int x = coordinate(g_.width);
        const int y = r_.in(-600, 100);
        int at = y;
        for (int n = r_.in(1, 5); n > 0; --n, at += r_.in(1, 100 * g_.height)) {
          if (at < most) o.push_back({std::clamp(x + r_.in(-300, 300), -most, most), at});
        }
        const int right = r_.in(0, 256 * 40);
        for (int n = r_.in(2, 5); n > 0; --n, at -= r_.in(1, 100 * g_.height)) {
          if (at > -most) o.push_back({std::clamp(x + right + r_.in(-300, 300), -most, most), std::min(at, most)});
        }
        while (o.size() < 3) o.push_back(vertex());
        break;
      }
      default:
        o = {vertex(), vertex(), vertex()};
    }
    return o;
  }

  /// Mostly as pictures have them: in range on the screen.
  ScreenPlane plane(int bits) {
    const auto of = [&](int log) {
      return static_cast<std::int64_t>(r_.real(-1, 1) * static_cast<double>(std::int64_t{1} << r_.in(0, log)));
    };
    ScreenPlane p;
    p.x0 = r_.in(-kGuard, kGuard);
    p.y0 = r_.in(-kGuard, kGuard);
    if (r_.chance(0.85)) {
      p.x0 = r_.in(0, g_.width - 1);
      p.y0 = r_.in(0, g_.height - 1);
      p.a = of(kPlaneFrac + bits - 8);
      p.b = of(kPlaneFrac + bits - 4);
      p.c = static_cast<std::int64_t>(r_.real(0, 1) * static_cast<double>(std::int64_t{1} << (kPlaneFrac + bits)));
    } else {
      p.a = of(60);
      p.b = of(60);
      p.c = of(62);
    }
    return p;
  }

  std::uint32_t polygon(std::uint8_t alpha = 255) {
    const Outline o = outline();
    ScreenPolygon p;
    p.first_vertex = static_cast<std::uint32_t>(g_.vertices.size());
    p.vertex_count = static_cast<std::uint32_t>(o.size());
    g_.vertices.insert(g_.vertices.end(), o.begin(), o.end());
    p.depth = plane(c_.z_bits);
    for (auto& c : p.color) c = static_cast<std::uint8_t>(r_.in(0, 255));
    if (c_.smooth != 0 && r_.chance(0.7)) {
      p.color_planes = static_cast<std::int32_t>(g_.color_planes.size());
      for (int c = 0; c < 3; ++c) g_.color_planes.push_back(plane(8));
    }
    if (alpha == 255 && !g_.passes.empty()) {
      p.light_planes = static_cast<std::int32_t>(g_.color_planes.size());
      for (std::size_t k = 0; k < 3 * (1 + g_.passes.size()); ++k) g_.color_planes.push_back(plane(8));
    }
    p.lit = c_.dsf_bits > 0 && r_.chance(0.5);
    p.normal_class = p.lit && classes_ > 0 ? static_cast<std::uint32_t>(r_.in(0, classes_)) : 0;
    p.alpha = alpha;
    g_.polygons.push_back(p);
    return static_cast<std::uint32_t>(g_.polygons.size() - 1);
  }

  void volumes() {
    const int lights = g_.passes.empty() ? c_.lights : static_cast<int>(g_.passes.size());
    const int samples = c_.count_bits > 0 || !g_.passes.empty() ? r_.in(0, 4) : r_.in(0, 1);
    for (int s = 0; s < samples; ++s) {
      g_.sample_light.push_back(static_cast<std::uint8_t>(r_.in(s == 0 ? 0 : g_.sample_light.back(), lights - 1)));
      for (int n = c_.fsf != 0 ? r_.in(0, 4) : r_.in(0, 1); n > 0; --n) {
        ShadowVolume v;
        v.sample = static_cast<std::uint32_t>(s);
        v.first_face = static_cast<std::uint32_t>(g_.volume_faces.size());
        v.face_count = static_cast<std::uint32_t>(r_.in(1, 7));
        for (std::uint32_t k = 0; k < v.face_count; ++k) {
          const bool cap = g_.drawn > 0 && r_.chance(0.3);
          const auto drawn = static_cast<int>(g_.drawn);
          const std::uint32_t of = cap ? static_cast<std::uint32_t>(r_.in(0, drawn - 1)) : polygon();
          g_.volume_faces.push_back({of, r_.chance(0.8) ? r_.in(0, 1) * 2 - 1 : r_.in(-300, 300)});
        }
        v.first_near = static_cast<std::uint32_t>(g_.near_edges.size());
        for (int caps = r_.chance(0.6) ? 0 : r_.in(1, 2); caps > 0; --caps) near_cap();
        v.near_count = static_cast<std::uint32_t>(g_.near_edges.size()) - v.first_near;
        g_.volumes.push_back(v);
      }
    }
  }

  void near_cap() {
    const int w = r_.in(-2, 2);
    const Outline o = r_.chance(0.4) ? rectangle(-1, -2, g_.width + 1, r_.in(1, g_.height + 2)) : outline();
    for (std::size_t i = 0; i < o.size(); ++i) g_.near_edges.push_back({o[i], o[(i + 1) % o.size()], w});
  }

  void fragments() {
    for (int n = r_.in(0, 5); n > 0; --n) {
      ScreenFragment f;
      f.first_polygon = static_cast<std::uint32_t>(g_.polygons.size());
      f.polygon_count = static_cast<std::uint32_t>(r_.in(1, 2));
      const auto alpha = static_cast<std::uint8_t>(r_.in(0, 254));
      for (std::uint32_t k = 0; k < f.polygon_count; ++k) polygon(alpha);
      f.first_line = g_.height;
      for (std::uint32_t k = 0; k < f.polygon_count; ++k) {
        const LineRange lines = lines_of(g_.outline(g_.polygons[f.first_polygon + k]));
        f.first_line = std::min(f.first_line, std::max(lines.first, 0));
        f.end_line = std::max(f.end_line, std::min(lines.end, g_.height));
      }
      if (r_.chance(0.1)) ++f.first_line;
      const int cuts = r_.chance(0.6) ? 0 : r_.in(1, 2);
      f.first_cut = static_cast<std::uint32_t>(g_.cuts.size());
      f.cut_count = static_cast<std::uint32_t>(cuts);
      for (int k = 0; k < cuts; ++k) {
        g_.cuts.push_back({static_cast<std::uint32_t>(g_.cut_lines.size()), r_.chance(0.5)});
        CutLine line;
        line.a = r_.in(-100, 100);
        line.b = r_.in(-100, 100);
        line.c = -line.a * r_.in(0, g_.width) - line.b * r_.in(0, g_.height);
        g_.cut_lines.push_back(line);
      }
      g_.fragments.push_back(f);
    }
  }

  Random& r_;
  const Config& c_;
  int classes_ = 0;
  FrameGeometry g_;
};

}  // namespace

TEST_CASE("random polygons at the polygon level give the tokens of the span level, in any configuration") {
  Random random(test_seed());
  CAPTURE(test_seed());
  PolygonReport sum;
  std::uint64_t made[3]{};
  int shadowed = 0;  // frames whose picture shadows change
  for (int round = 0; round < 3000; ++round) {
    Config c = random_config(random, kMaxSize);
    c.units = 0;
    constexpr std::array kActive{1, 4, 4, 32, 512, 512, 4096};
    c.active = kActive[static_cast<std::size_t>(random.in(0, 6))];
    const int widest = std::min(c.max_width, kMaxSize);
    const int width = random.chance(0.1) ? 1 : random.chance(0.05) ? widest : random.in(1, std::min(widest, 90));
    const int height = random.chance(0.1) ? random.in(1, 3) : random.in(1, 70);
    const FrameGeometry g = FrameMaker(random, c, width, height).make();
    const BothLevels both = both_levels(g, c);
    CAPTURE(round, width, height, c.active);
    INFO(both.fault);
    REQUIRE(both.fault.empty());
    sum += both.report;
    FrameGeometry bare = g;
    bare.volumes.clear();
    bare.volume_faces.clear();
    bare.near_edges.clear();
    std::vector<std::uint32_t> without;
    make_frame(bare, c, 7, without, {.threads = 1});
    shadowed += drawn(c, without).pixels != drawn(c, both.spans).pixels ? 1 : 0;
    const Layout layout(c);
    TokenWalk walk(layout, both.polygons);
    int layer = 0;
    for (auto words = walk.next(); !words.empty(); words = walk.next()) {
      const Token t = decode(c, layout, words, Level::polygons);
      if (t.kind == Kind::AT) layer = t.polygon.layer;
      if (t.kind == Kind::POLYGON) ++made[layer];
    }
  }
  for (const std::uint64_t n : made) CHECK(n > 300);
  CAPTURE(shadowed);
  CHECK(shadowed > 300);
  for (const PolygonWay way : {PolygonWay::polygon, PolygonWay::crossings, PolygonWay::wide, PolygonWay::rounded,
                               PolygonWay::cut, PolygonWay::words, PolygonWay::active}) {
    CAPTURE(static_cast<int>(way));
    CHECK(sum.ways[static_cast<std::size_t>(way)].polygons > 20);
    CHECK(sum.ways[static_cast<std::size_t>(way)].spans > 20);
  }
}

namespace {

/// A picture with volumes whose faces are ten lines high, face i of n at line i * tall / n.
FrameGeometry frame_with_faces(std::uint32_t count, int tall) {
  FrameBuilder b(16, tall);
  for (int y = 0; y < tall; y += 10) b.add(rectangle(2, y, 9, y + 10), plane(900));
  FrameGeometry g = b.frame();
  g.drawn = 0;
  for (std::uint32_t i = 0; i < count; ++i)
    g.volume_faces.push_back({static_cast<std::uint32_t>(std::uint64_t{i} * g.polygons.size() / count), 1});
  g.sample_light = {0};
  return g;
}

}  // namespace

TEST_CASE("a volume with more faces than places count has the rest as spans") {
  Config c;
  c.active = kGreatest.active;
  FrameGeometry g = frame_with_faces(20'000, 60);
  g.volumes.push_back({.first_face = 0, .face_count = 20'000});
  const BothLevels both = both_levels(g, c);
  INFO(both.fault);
  CHECK(both.fault.empty());
  CHECK(both.report.made().polygons == (1U << kRankBits) - 1);
  CHECK(both.report.ways[static_cast<std::size_t>(PolygonWay::place)].polygons == 20'000 - (1U << kRankBits) + 1);
}

TEST_CASE("a frame with more samples, or volumes of one, than places count is at the span level") {
  Config c;
  c.active = 512;
  c.count_bits = 8;
  for (const auto& [samples, volumes, fits] : {std::tuple{1U << kSampleBits, 1U, true},
                                               {(1U << kSampleBits) + 1, 1U, false},
                                               {1U, 1U << kVolumeBits, true},
                                               {1U, (1U << kVolumeBits) + 1, false}}) {
    const std::uint32_t all = samples * volumes;
    FrameGeometry g = frame_with_faces(all, 10);
    g.sample_light.resize(samples, 0);
    for (std::uint32_t v = 0; v < all; ++v)
      g.volumes.push_back({.first_face = v, .face_count = 1, .sample = v / volumes});
    CAPTURE(samples, volumes);
    std::vector<std::uint32_t> spans;
    make_frame(g, c, 0, spans, {.threads = 1, .all_spans = true});
    std::vector<std::uint32_t> words;
    PolygonReport r;
    make_frame(g, c, 0, words, {.threads = 1, .level = Level::polygons, .polygons = &r, .all_spans = true});
    CHECK(r.polygons == fits);
    CHECK(r.words == words.size());
    CHECK((words == spans) == !fits);
    if (fits) CHECK(expanded(c, words) == spans);
  }
}

TEST_CASE("the polygon level is refused for a core without front end") {
  std::vector<std::uint32_t> words;
  CHECK_THROWS_AS(make_frame(frame_with_faces(1, 10), Config{}, 0, words, {.level = Level::polygons}), Error);
}

}  // namespace kage::verif
