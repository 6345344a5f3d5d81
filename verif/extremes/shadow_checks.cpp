// SPDX-License-Identifier: Apache-2.0
#include "extremes/shadow_checks.hpp"

#include "oracle/ray_truth.hpp"

namespace kage::verif {
namespace {

/// Whether the stated errors leave open what is to be seen at a pixel or whether it lies in shadow.
bool open_to_errors(const FrameGeometry& g, const Config& config, int x, int y) {
  Oracle oracle(g, config);
  oracle.line(y);
  const std::int32_t surface = oracle.at(x).surface;
  if (surface < 0) return false;
  const PossibleShadow p = oracle.possible_shadow(x, static_cast<std::uint32_t>(surface), Errors::depth_and_snap);
  return p.lit && p.shadowed;
}

/// Where it is injected, the last volume has lost its last face.
void lose_face(FrameGeometry& g, const Context& context) {
  if (context.injected(Injection::lost_face) && !g.volumes.empty()) --g.volumes.back().face_count;
}

}  // namespace

SceneFrame box_threes(std::span<const int> order, double aside) {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  for (const int i : order) {
    const int column = i / 3 % 5;
    const int row = i / 15;
    const glm::dvec3 centre{column * 1.5 - 3, 0, row * 1.5 - 3};
    if (i % 3 == 2)
      add_solid(f, box_solid(), centre + glm::dvec3(aside, 0, 0), {0.2, 0.2, 0.2}, Turn{}, {1, 1, 1});
    else
      add_solid(f, box_solid(), centre, glm::dvec3(i % 3 == 0 ? 0.2 : 0.3), Turn{}, {1, 1, 1});
  }
  f.lights[0].direction = glm::normalize(glm::dvec3(0.3, -1, 0.2));
  look_at(f.camera, {5, 6, 7}, {0, -1, 0});
  return f;
}

SceneFrame zigzag_scene(int n) {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {6, 0.2, 6}, Turn{}, {1, 1, 1});
  Solid s;
  for (int i = 0; i <= n; ++i)
    for (const double z : {-1.0, 1.0}) s.vertices.emplace_back(i % 2 == 0 ? -1 : 1, 2.0 * i / n, z);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i) {
    s.faces.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    s.faces.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  add_solid(f, s, {0, -1, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
  look_at(f.camera, {4, 5, 6}, {0, -2, 0});
  f.lights[0].direction = glm::normalize(glm::dvec3(0.05, -1, 0.04));
  return f;
}

Outcome picture_is_the_oracles(const FrameGeometry& g, const Config& config, const Context& context) {
  const Judgement j = judge(g, config, [&](FrameGeometry& drawn) { lose_face(drawn, context); });
  Outcome o;
  o.pixels = j.pixels;
  if (!j.good()) o.fail(j.text());
  return o;
}

Outcome volumes_are_closed(const SceneFrame& f, const Config& config, int width, int height, const Context& context,
                           Look look) {
  look.far_ends = true;
  look.leave_out = false;
  FrameGeometry g = make_geometry(f, config, width, height, {.look = look});
  lose_face(g, context);
  Oracle oracle(g, config);
  Outcome o;
  for (int y = 0; y < height; ++y) {
    oracle.line(y);
    for (std::uint32_t v = 0; v < g.volumes.size(); ++v)
      for (int x = 0; x < width; ++x) {
        const int sum = oracle.sum_of_toggles(v, x);
        if (sum != 0) o.fail(fmt::format("pixel ({}, {}): the toggles of volume {} sum to {}, not 0", x, y, v, sum));
        ++o.items;
      }
  }
  return o;
}

Outcome picture_is_the_rays(const SceneFrame& f, const FrameGeometry& g, const Config& config, const Context& context) {
  FrameGeometry given = g;
  lose_face(given, context);
  const RayCount count = compare_with_rays(f, given, config);
  Outcome o;
  o.pixels = count.pixels;
  if (!count.good()) o.fail(count.text());
  return o;
}

Outcome TwoPictures::outcome() const {
  Outcome o;
  o.items = pixels;
  if (wrong > 0) o.fail(fmt::format("{} pixels differ and are no near ties; first: {}", wrong, first_wrong));
  if (different * 200 >= pixels) o.fail(fmt::format("{} of {} pixels differ", different, pixels));
  return o;
}

TwoPictures same_but_near_ties_count(const FrameGeometry& a, const Config& ca, const FrameGeometry& b,
                                     const Config& cb) {
  const auto p = draw(a, ca);
  const auto q = draw(b, cb);
  TwoPictures two;
  two.pixels = p.size();
  if (q.size() != p.size()) {
    two.wrong = p.size() + 1;
    two.first_wrong = "the sizes";
    return two;
  }
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] == q[i]) continue;
    ++two.different;
    const int x = static_cast<int>(i) % a.width;
    const int y = static_cast<int>(i) / a.width;
    if (open_to_errors(a, ca, x, y) || open_to_errors(b, cb, x, y)) continue;
    if (two.wrong++ == 0) two.first_wrong = fmt::format("({}, {})", x, y);
  }
  return two;
}

Outcome no_acne(const FrameGeometry& g, const Config& config, int sub_bits) {
  const double step = 1 << (kMostSubBits - sub_bits);
  Oracle oracle(g, config);
  Outcome o;
  for (int y = 0; y < g.height; ++y) {
    oracle.line(y);
    for (int x = 0; x < g.width; ++x) {
      const OraclePixel p = oracle.at(x);
      // At the silhouette a side leaves the face in the same point; the snap may put it on either side there. A face
      // that is seen nearly edge-on and steeper than its side leaves the side at the corners' own depths, so that the
      // two may cross further away, within what near ties allow.
      if (p.shadowed && g.polygons[static_cast<std::uint32_t>(p.surface)].lit &&
          !near_volume_edge(g, x, y, 1.5 * step) && (sub_bits == kMostSubBits || !open_to_errors(g, config, x, y)))
        o.fail(fmt::format("pixel ({}, {}): a lit face shadows itself", x, y));
      ++o.items;
    }
  }
  return o;
}

}  // namespace kage::verif
