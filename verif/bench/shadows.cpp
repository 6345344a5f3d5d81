// SPDX-License-Identifier: Apache-2.0
// Cost of shadow volumes by the way they are made: a volume per face, patches, and counting with 2, 3, 4 and 8 bits.
// Meshes stand on a floor; the sun is high (steep) or low (flat); 640x480, views round the mesh, all sums per frame.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>

#include "bench/timer.hpp"
#include "kage/core.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"
#include "scene/space.hpp"
#include "stimulus/shapes.hpp"

namespace {

using namespace kage;

constexpr int kFrames = 4;

/// A square under the scene, twice as wide.
void add_floor(SceneFrame& f) {
  SpaceBox box;
  for (const glm::dvec3& v : f.vertices) box.add(v);
  const glm::dvec3 size = box.high - box.low;
  const glm::dvec3 middle{box.low.x + size.x / 2, box.low.y - 0.01 * size.y, box.low.z + size.z / 2};
  const double half = std::max(size.x, size.z);
  const verif::Solid floor{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}}, {{0, 1, 2}, {0, 2, 3}}};
  verif::add_solid(f, floor, middle, {half, 1, half}, verif::Turn{}, {0.6, 0.6, 0.6}, false, false);
}

struct Sum {
  std::uint64_t volumes = 0;
  std::uint64_t sides = 0;
  std::uint64_t spans = 0;
  std::uint64_t pixels = 0;
  std::uint64_t ends = 0;
  std::uint64_t end_pixels = 0;
  double geometry = 0;
  double again = 0;
  double front_end = 0;
  double core = 0;
};

/// Unlike count_tokens(), spans of shadows alone, and the pixels of volume ends.
void count_shadow_tokens(const Config& config, std::span<const std::uint32_t> words, Sum& sum) {
  const Layout layout(config);
  TokenWalk walk(layout, words);
  for (auto token = walk.next(); !token.empty(); token = walk.next()) {
    const Token t = decode(config, layout, token);
    const auto pixels = static_cast<std::uint64_t>(t.span.xr - t.span.xl);
    if (t.kind == Kind::SP || t.kind == Kind::NC) {
      ++sum.spans;
      sum.pixels += pixels;
    } else if (t.kind == Kind::EV) {
      ++sum.ends;
      sum.end_pixels += pixels;
    }
  }
}

void measure(const Scene& scene, const glm::dvec3& sun, const char* called, int bits, VolumeWay way) {
  Config config;
  config.dsf_bits = bits;
  Look look;
  look.volumes = way;
  Sum sum;
  for (int i = 0; i < kFrames; ++i) {
    SceneFrame f = scene.frame(i, kFrames);
    f.lights.resize(1);
    f.lights[0] = {};
    f.lights[0].direction = sun;
    add_floor(f);
    bench::Timer timer;
    const FrameGeometry g = make_geometry(f, config, 640, 480, {.look = look});
    sum.geometry += timer.seconds();
    // The next frame's, with casters and light where they are.
    ShadowCache kept;
    (void)make_geometry(f, config, 640, 480, {.look = look, .shadows = &kept});
    timer = {};
    (void)make_geometry(f, config, 640, 480, {.look = look, .shadows = &kept});
    sum.again += timer.seconds();
    sum.volumes += g.volumes.size();
    for (const VolumeFace& face : g.volume_faces) sum.sides += g.polygons[face.polygon].source == ~0U ? 1 : 0;
    std::vector<std::uint32_t> words;
    timer = {};
    make_frame(g, config, 0, words, {.threads = 1});
    sum.front_end += timer.seconds();
    count_shadow_tokens(config, words, sum);
    GoldenCore core(config);
    timer = {};
    (void)core.frame(words, [](int, std::span<const std::uint8_t>) {});
    sum.core += timer.seconds();
  }
  fmt::print("  {:<16}{:>8}{:>8}{:>9}{:>11}{:>8}{:>10}{:>10.1f}{:>7.1f}{:>11.1f}{:>9.1f}\n", called,
             sum.volumes / kFrames, sum.sides / kFrames, sum.spans / kFrames, sum.pixels / kFrames, sum.ends / kFrames,
             sum.end_pixels / kFrames, 1e3 * sum.geometry / kFrames, 1e3 * sum.again / kFrames,
             1e3 * sum.front_end / kFrames, 1e3 * sum.core / kFrames);
}

void compare(const std::string& name) {
  const Scene scene = Scene::load(name);
  for (const auto& [sun, height] : {std::pair{glm::dvec3(0.3, -1, 0.2), "high"}, {glm::dvec3(-1, -0.3, 0.3), "low"}}) {
    fmt::print("{}, {} faces, sun {}\n", std::filesystem::path(name).filename().string(),
               scene.frame(0, kFrames).polygons.size(), height);
    fmt::print("  {:<16}{:>8}{:>8}{:>9}{:>11}{:>8}{:>10}{:>10}{:>7}{:>11}{:>9}\n", "", "volumes", "sides", "SP, NC",
               "pixels", "EV", "pixels", "geometry", "kept", "front end", "core ms");
    const glm::dvec3 direction = glm::normalize(sun);
    measure(scene, direction, "volume per face", 1, VolumeWay::per_face);
    measure(scene, direction, "patches", 1, VolumeWay::fewest);
    for (const int bits : {2, 3, 4, 8})
      measure(scene, direction, fmt::format("{} bits", bits).c_str(), bits, VolumeWay::fewest);
  }
}

}  // namespace

int main() {
  compare("knot");
  for (const char* mesh : {"horse.3ds", "cat.3ds", "bunny.obj"})
    if (const std::string path = std::string("/usr/share/glmark2/models/") + mesh; std::filesystem::exists(path))
      compare(path);
  return 0;
}
