// SPDX-License-Identifier: Apache-2.0
// How well the sample points of an area light stand for the light. Edges of all directions and places are held against
// the exact share, for kage's points and other choices of points, with what is left to gain. Then a ball seen by near
// receivers. Then pictures: their steps, and one pattern of samples against a pattern with its own seed for each
// caster, by FLIP. docs/lights.md, "Samples".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "image/flip_metric.hpp"
#include "number/mixed.hpp"
#include "oracle/directions.hpp"
#include "oracle/light_truth.hpp"
#include "oracle/penumbra_truth.hpp"
#include "stimulus/random.hpp"
#include "stimulus/shapes.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

constexpr std::array kCounts{4, 8, 15, 16, 31, 32, 63, 64, 127, 255};
constexpr std::array kShapes{LightShape::disc, LightShape::rectangle, LightShape::sphere};
constexpr int kSeeds = 8;
using Points = std::vector<glm::dvec3>;

const char* name_of(LightShape shape) {
  return shape == LightShape::disc ? "disc" : shape == LightShape::rectangle ? "rectangle" : "ball";
}

Light unit_light(LightShape shape) {
  Light l;
  l.directional = false;
  l.shape = shape;
  l.axis_u = {1, 0, 0};
  l.axis_v = {0, 1, 0};
  return l;
}

Points kage_points(LightShape shape, int n, std::uint64_t seed) {
  const Light l = unit_light(shape);
  return unit_points(l, light_points(l, n, seed));
}

double length_of(const glm::dvec3& v) { return std::sqrt(glm::dot(v, v)); }

double part(double x) { return x - std::floor(x); }

const double kGolden = (std::sqrt(5) - 1) / 2;

Points golden_lattice(int n) {
  Points points;
  for (int i = 0; i < n; ++i) points.emplace_back(2 * (i + 0.5) / n - 1, 2 * part(i * kGolden + 0.37) - 1, 0);
  return points;
}

// Sobol's first two dimensions: the van der Corput sequence against equal steps (Hammersley's set).
Points hammersley(int n) {
  Points points;
  for (int i = 0; i < n; ++i) {
    double v = 0;
    for (int bit = 0; bit < 8; ++bit) v += (i >> bit & 1) != 0 ? std::ldexp(1, -bit - 1) : 0;
    points.emplace_back(2 * (i + 0.5) / n - 1, 2 * v + 1.0 / n - 1, 0);
  }
  return points;
}

Points in_ball(int n, double turn, double half_turn, double start) {
  Points points;
  for (int i = 0; i < n; ++i) {
    const double u = (i + 0.5) / n;
    const double a = 2 * M_PI * i * turn;
    const double b = M_PI * part(start + i * half_turn);
    points.emplace_back(std::sqrt(u) * std::cos(a), std::sqrt(u) * std::sin(a), std::sqrt(1 - u) * std::cos(b));
  }
  return points;
}

// A disc of the ball's size that faces the middle of the scene, as somebody sees it who looks at it from `aside` of
// that way, in radians: what lies across is narrower.
Points facing_disc(int n, double aside) {
  Points points = kage_points(LightShape::disc, n, 1);
  for (glm::dvec3& p : points) p.x *= std::cos(aside);
  return points;
}

// Points moved until edges are off by as little as they come to: a place of a point that is the k-th before an edge
// should have k + 1/2 shares of the light before it.
Points descended(LightShape shape, Points points) {
  const bool square = shape == LightShape::rectangle;
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 120; ++i) {
    const double angle = M_PI * (i + 0.5) / 120;
    directions.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  if (shape == LightShape::sphere) directions = even_directions(240);
  const auto n = static_cast<double>(points.size());
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (int step = 0; step < 400; ++step) {
    Points moves(points.size(), glm::dvec3(0, 0, 0));
    for (const glm::dvec3& d : directions) {
      std::sort(order.begin(), order.end(),
                [&](std::size_t a, std::size_t b) { return glm::dot(points[a], d) < glm::dot(points[b], d); });
      for (std::size_t k = 0; k < order.size(); ++k) {
        const double h = glm::dot(points[order[k]], d);
        const double truth = square ? share_of_square(d.x, d.y, h) : share_of_disc(h);
        moves[order[k]] += d * ((static_cast<double>(k) + 0.5) / n - truth);
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i] += moves[i] * ((step < 300 ? 1.0 : 0.3) / static_cast<double>(directions.size()));
  }
  return points;
}

struct Mean {
  double rms = 0;
  double worst = 0;
};

// Over seeds the mean of the errors, and the worst.
Mean over_seeds(LightShape shape, int n) {
  Mean m;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const EdgeErrors e = edge_errors(shape, kage_points(shape, n, seed));
    m.rms += e.rms() / kSeeds;
    m.worst = std::max(m.worst, e.worst * n);
  }
  return m;
}

double along_axes(const Points& points) {
  EdgeErrors e;
  add_edges(points, {1, 0, 0}, true, e);
  add_edges(points, {0, 1, 0}, true, e);
  return e.rms();
}

void edges() {
  fmt::print("edges of 360 directions at 400 places: rms of the share that is off; worst in samples; {} seeds\n",
             kSeeds);
  for (const LightShape shape : kShapes)
    for (const int n : kCounts) {
      const Mean m = over_seeds(shape, n);
      const Points own = kage_points(shape, n, 1);
      std::string others;
      const auto other = [&](const char* name, const Points& points) {
        const EdgeErrors e = edge_errors(shape, points);
        others += fmt::format(", {} {:.4f} {:.1f}", name, e.rms(), e.worst * n);
      };
      if (shape == LightShape::rectangle) {
        other("golden", golden_lattice(n));
        other("Hammersley", hammersley(n));
      }
      if (shape == LightShape::sphere) {
        other("surface", even_directions(n));
        other("R2", in_ball(n, 1 / 1.32471795724474602596, 2 / 1.75487766624669276, 0.25));
        other("facing disc 30 degrees aside", facing_disc(n, M_PI / 6));
      }
      other("descended", descended(shape, own));
      fmt::print("{:>9} {:3} samples: rms {:.4f}, worst {:4.1f}{}{}\n", name_of(shape), n, m.rms, m.worst,
                 shape == LightShape::rectangle
                     ? fmt::format(", edges along its sides {:.4f} (golden {:.4f}, descended {:.4f})", along_axes(own),
                                   along_axes(golden_lattice(n)), along_axes(descended(shape, own)))
                     : "",
                 others);
    }
}

// Whether other constants than those of light.cpp would do better for the ball: the mean factor over these counts.
void ball_constants() {
  constexpr std::array kTried{8, 15, 31, 64, 127};
  constexpr int kTriples = 2000;
  const auto factor = [&](const std::function<Points(int)>& points) {
    double logs = 0;
    for (const int n : kTried)
      logs += std::log(edge_errors(LightShape::sphere, points(n)).rms() * std::pow(n, 2.0 / 3));
    return std::exp(logs / kTried.size());
  };
  const double own = factor([](int n) { return kage_points(LightShape::sphere, n, 1); });
  Random random(1);
  std::vector<double> others;
  for (int i = 0; i < kTriples; ++i) {
    const double turn = random.real(0, 0.5);
    const double half_turn = random.real(0, 1);
    const double start = random.real(0, 1);
    others.push_back(factor([&](int n) { return in_ball(n, turn, half_turn, start); }));
  }
  std::sort(others.begin(), others.end());
  fmt::print(
      "ball: of {} other turns, half turns and starts {} are better, the best one has {:.3f} of kage's error, the "
      "middle one {:.3f}\n",
      kTriples, std::lower_bound(others.begin(), others.end(), own) - others.begin(), others.front() / own,
      others[kTriples / 2] / own);
}

// The light of a ball of radius 1 and even radiance, as it arrives on a surface that faces the ball from distance d:
// the share beyond an edge. It is held against share_of_disc(), the limit of the samples from every distance, because
// an edge and the receiver make a plane.
void near_receivers() {
  for (const double d : {1.1, 1.5, 2.0, 4.0, 10.0}) {
    const double cone = std::asin(1 / d);
    double worst = 0;
    for (int e = 0; e < 200; ++e) {
      const double h = (e + 0.5) / 200;  // the plane's distance from the ball's middle
      const double tangent = std::tan(std::asin(h / d));
      double within = 0;
      double all = 0;
      constexpr int kRings = 2000;
      for (int k = 0; k < kRings; ++k) {
        const double a = cone * (k + 0.5) / kRings;
        const double weight = std::sin(a) * std::cos(a);
        within += weight * (1 - std::acos(std::clamp(tangent / std::tan(a), -1.0, 1.0)) / M_PI);
        all += weight;
      }
      worst = std::max(worst, std::abs(within / all - share_of_disc(h)));
    }
    fmt::print("ball from {:4.1f} radii off: endless samples are off by at most {:.4f} of the light\n", d, worst);
  }
}

SceneFrame penumbra_with(LightShape shape) {
  const Scene scene = Scene::load("penumbra");
  SceneFrame f = scene.frame(0, scene.frame_count());
  Light& l = f.lights[0];
  if (shape == LightShape::disc) l.axis_v *= length_of(l.axis_u) / length_of(l.axis_v);
  if (shape == LightShape::sphere) l.axis_u = {length_of(l.axis_u), 0, 0};
  l.shape = shape;
  return f;
}

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// A picture, and the most that a sample takes of white.
struct Sampled {
  Image image;
  double step;
};

Sampled picture_of(const SceneFrame& f, int samples, std::uint64_t seed) {
  Config c;
  c.smooth = 1;
  c.color_frac = 8;
  c.class_bits = 4;
  c = config_for_lights(f, 255, c);
  Look look;
  look.samples = samples;
  look.seed = seed;
  const FrameGeometry g = make_geometry(f, c, kWidth, kHeight, {.look = look});
  Image image(kWidth, kHeight, 3);
  std::size_t at = 0;
  for (const std::uint32_t p : draw(g, c))
    for (unsigned k = 0; k < 24; k += 8) image.data[at++] = static_cast<std::uint8_t>(p >> k);
  std::uint32_t most = 0;
  for (const auto& entry : g.shares) most = std::max(most, entry[1]);
  return {std::move(image), std::ldexp(255.0 * most, -c.shade_frac)};
}

// The mean of pictures of 255 samples with 8 seeds.
Image true_picture(const SceneFrame& f) {
  constexpr int kPictures = 8;
  Image image = picture_of(f, 255, 100).image;
  std::vector<int> sums(image.data.size(), kPictures / 2);
  for (int i = 0; i < kPictures; ++i) {
    const Image one = picture_of(f, 255, 100 + static_cast<std::uint64_t>(i)).image;
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += one.data[k];
  }
  for (std::size_t k = 0; k < sums.size(); ++k) image.data[k] = static_cast<std::uint8_t>(sums[k] / kPictures);
  return image;
}

void steps() {
  fmt::print("penumbra, frame 0, {}x{}, against the mean of 8 pictures of 255 samples; 2 seeds\n", kWidth, kHeight);
  for (const LightShape shape : {LightShape::rectangle, LightShape::disc, LightShape::sphere}) {
    const SceneFrame f = penumbra_with(shape);
    const Image truth = true_picture(f);
    for (const int n : {1, 4, 8, 15, 20, 31, 63, 127, 141, 255}) {
      FlipNumbers flip;
      double squares = 0;
      double step = 0;
      int most = 0;
      std::size_t soft = 0;
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const auto [image, of_white] = picture_of(f, n, seed);
        step += of_white / 2;
        const FlipNumbers one = flip_metric(image, truth);
        flip.mean += one.mean / 2;
        flip.most = std::max(flip.most, one.most);
        for (std::size_t k = 0; k < truth.data.size(); ++k) {
          const int off = std::abs(image.data[k] - truth.data[k]);
          squares += off * off;
          most = std::max(most, off);
          soft += off > 0 ? 1 : 0;
        }
      }
      fmt::print(
          "{:>9} {:3} samples: steps of {:5.2f} LSB, off by {:5.2f} LSB rms, {:3} at most; FLIP mean {:.5f}, most "
          "{:.3f}\n",
          name_of(shape), n, step, std::sqrt(squares / static_cast<double>(soft)), most, flip.mean, flip.most);
    }
  }
}

// Boxes on a floor before a disc of light: side by side without a gap, or well apart.
SceneFrame boxes_before_a_disc(bool closed) {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -0.1, 0}, {8, 0.1, 8}, Turn{}, {0.8, 0.8, 0.8});
  for (int i = -2; i <= 1; ++i)
    add_solid(f, box_solid(), {i + 0.5, 1, 0}, {closed ? 0.5 : 0.2, 1, 0.1}, Turn{}, {0.8, 0.8, 0.8});
  f.lights[0].directional = false;
  f.lights[0].position = {0.3, 4, -4};
  f.lights[0].shape = LightShape::disc;
  f.lights[0].axis_u = {0.8, 0, 0};
  f.lights[0].axis_v = {0, 0.57, 0.57};
  look_at(f.camera, {0.5, 5, 7}, {0, 0, 1});
  f.camera.half_height = 0.4;
  f.camera.near = 0.5;
  return f;
}

// Share of the light that is kept out at each pixel, with the points of component k chosen by seed_of(k).
std::vector<double> kept_out(const SceneFrame& f, int samples,
                             const std::function<std::uint64_t(std::uint32_t)>& seed_of) {
  const Config c = config_for_lights(f, 255);
  std::vector<std::vector<std::uint8_t>> blocked(static_cast<std::size_t>(samples));
  for (std::uint32_t k = 0; k < f.components.size(); ++k) {
    Look look;
    look.samples = samples;
    look.seed = seed_of(k);
    FrameGeometry g = make_geometry(f, c, kWidth / 2, kHeight / 2, {.look = look});
    std::erase_if(g.volumes, [&](const ShadowVolume& v) { return v.component != k; });
    for (std::uint32_t s = 0; s < blocked.size(); ++s) {
      const auto one = sample_shadow(g, c, s);
      if (blocked[s].empty()) blocked[s].resize(one.size(), 0);
      for (std::size_t i = 0; i < one.size(); ++i) blocked[s][i] |= one[i];
    }
  }
  std::vector<double> share(blocked[0].size(), 0);
  for (const auto& b : blocked)
    for (std::size_t i = 0; i < b.size(); ++i) share[i] += b[i] / static_cast<double>(samples);
  return share;
}

void casters_of_their_own() {
  for (const bool closed : {false, true}) {
    const SceneFrame f = boxes_before_a_disc(closed);
    std::vector<double> truth;
    constexpr int kPatterns = 4;
    for (std::uint64_t seed = 1; seed <= kPatterns; ++seed) {
      const auto one = kept_out(f, 255, [&](std::uint32_t) { return 100 + seed; });
      truth.resize(one.size(), 0);
      for (std::size_t i = 0; i < one.size(); ++i) truth[i] += one[i] / kPatterns;
    }
    fmt::print("four boxes {}, a disc of light: rms of its share over pixels in its shadow\n",
               closed ? "side by side, one wall" : "apart");
    for (const int n : {15, 31, 63}) {
      const auto rms = [&](const std::function<std::uint64_t(std::uint32_t)>& seed_of) {
        const auto share = kept_out(f, n, seed_of);
        double squares = 0;
        double most = 0;
        int count = 0;
        for (std::size_t i = 0; i < share.size(); ++i) {
          if (truth[i] == 0 && share[i] == 0) continue;
          squares += (share[i] - truth[i]) * (share[i] - truth[i]);
          most = std::max(most, std::abs(share[i] - truth[i]));
          ++count;
        }
        return std::pair(std::sqrt(squares / count), most);
      };
      const auto [one, one_most] = rms([](std::uint32_t) { return 1; });
      const auto [own, own_most] = rms([](std::uint32_t k) { return 1 + k; });
      fmt::print("{:3} samples: one pattern {:.4f}, at most {:.2f}; one for each caster {:.4f}, at most {:.2f}\n", n,
                 one, one_most, own, own_most);
    }
  }
}

}  // namespace

int main() {
  edges();
  ball_constants();
  near_receivers();
  casters_of_their_own();
  steps();
  return 0;
}
