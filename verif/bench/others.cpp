// SPDX-License-Identifier: Apache-2.0
// Frames with hard shadows of one light by kage's golden model, by rays of Embree and by stencil shadow volumes of
// OpenGL (Mesa's llvmpipe), all on one thread, from SceneFrame to pixels. Times are the process's processor time, all
// threads together: what else runs on the machine adds little, and a renderer with more threads would gain nothing.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "bench/others/packets.hpp"
#include "bench/others/stencil.hpp"
#include "contract/derived.hpp"
#include "direct/draw.hpp"
#include "geometry/view.hpp"
#include "stimulus/on_ground.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

constexpr int kRuns = 11;
constexpr int kZBits = 24;

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double wall_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The parts of one run, in the order in which they are first timed.
class Parts {
 public:
  void begin() { last_ = cpu_ms(); }
  void end(const char* name) {
    const double now = cpu_ms();
    ms.emplace_back(name, now - last_);
    last_ = cpu_ms();
  }
  std::vector<std::pair<const char*, double>> ms;

 private:
  double last_ = 0;
};

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

struct Setting {
  SceneFrame frame;
  int width = 0;
  int height = 0;
  Look look;

  [[nodiscard]] double far() const {
    double far = 0;
    for (const glm::dvec3& p : frame.vertices)
      far = std::max(far, glm::dot(p - frame.camera.eye, frame.camera.forward));
    return std::max(far * (1 + 1e-6), frame.camera.near * (1 + 1e-3));
  }
  [[nodiscard]] ShadowCaster caster() const {
    const View view(frame.camera, width, height, kZBits, {frame.camera.near, far()});
    return {frame, frame.lights[0], view.near_corners(), 1};
  }
  [[nodiscard]] std::array<std::uint8_t, 3> background(Shown shown) const {
    return shown == Shown::shadow ? kShadowBackground : look.background;
  }
};

/// A way to render, and what came of it.
struct Renderer {
  std::string name;
  std::function<void(Shown, Parts&, Picture&)> render;
  std::vector<std::vector<double>> times;  // by part
  std::vector<const char*> part_names;
  std::vector<double> sums;
  Picture picture;
  Picture shadow;
};

Renderer kage_renderer(const Setting& s, const std::string& name, int dsf_bits) {
  Config config;
  config.z_bits = kZBits;
  config.dsf_bits = dsf_bits;
  config.max_width = s.width;
  Renderer r;
  r.name = name;
  r.render = [&s, config](Shown shown, Parts& parts, Picture& out) {
    parts.begin();
    FrameGeometry g = make_geometry(s.frame, config, s.width, s.height, {.look = s.look});
    parts.end("geometry");
    if (shown == Shown::shadow) {
      g.shade = derived::whole_share(config);
      g.background = 0x808080;
      for (std::uint32_t i = 0; i < g.drawn; ++i) g.polygons[i].color = {255, 255, 255};
    }
    parts.begin();
    out.clear();
    draw_frame(
        g, config, 1, [] {},
        [&](int, std::span<const std::uint8_t> line) { out.insert(out.end(), line.begin(), line.end()); });
    parts.end("drawing");
  };
  return r;
}

template <int N>
Renderer embree_renderer(const Setting& s, const EmbreeScene& scene, float offset) {
  Renderer r;
  r.name = N == 1 ? "Embree, single rays" : fmt::format("Embree, packets of {}", N);
  r.render = [&s, &scene, offset](Shown shown, Parts& parts, Picture& out) {
    parts.begin();
    const ShadowCaster caster = s.caster();
    Looks looks(s.frame, caster, shown);
    const unsigned shade = shown == Shown::shadow ? 256 : static_cast<unsigned>(to_fixed(256 * *s.look.darkening, 0));
    Tracer<N>(s.frame, scene, looks, {s.width, s.height, s.background(shown), shade, offset}).run(out);
    parts.end("rays");
  };
  return r;
}

Renderer stencil_renderer(const Setting& s, StencilRenderer& gl, StencilWay way) {
  auto mesh = std::make_shared<StencilMesh>();
  auto pixels = std::make_shared<std::vector<std::uint8_t>>();
  Renderer r;
  r.name = way == StencilWay::depth_fail ? "stencil, depth fail" : "stencil, depth pass";
  r.render = [&s, &gl, way, mesh, pixels](Shown shown, Parts& parts, Picture& out) {
    parts.begin();
    const ShadowCaster caster = s.caster();
    Looks looks(s.frame, caster, shown);
    add_faces(s.frame, looks, shown == Shown::shadow ? 1 : *s.look.darkening, *mesh);
    parts.end("faces");
    add_volumes(s.frame, caster, way, *mesh);
    parts.end("volumes");
    gl.upload(*mesh);
    parts.end("upload");
    gl.draw(s.frame.camera, s.far(), s.background(shown), way, *pixels);
    parts.end("draw and read");
    out.resize(pixels->size() / 4 * 3);
    for (std::size_t i = 0; i < out.size() / 3; ++i)
      for (std::size_t c = 0; c < 3; ++c) out[3 * i + c] = (*pixels)[4 * i + c];
  };
  return r;
}

void run_once(Renderer& r) {
  Parts parts;
  r.render(Shown::picture, parts, r.picture);
  r.times.resize(parts.ms.size());
  r.part_names.resize(parts.ms.size());
  double sum = 0;
  for (std::size_t i = 0; i < parts.ms.size(); ++i) {
    r.part_names[i] = parts.ms[i].first;
    r.times[i].push_back(parts.ms[i].second);
    sum += parts.ms[i].second;
  }
  r.sums.push_back(sum);
}

/// Pixels that differ by more than `allowed` in some channel.
std::size_t differing(const Picture& a, const Picture& b, int allowed) {
  if (a.size() != b.size()) throw std::runtime_error("pictures of different sizes");
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    bool differs = false;
    for (std::size_t c = 0; c < 3; ++c) differs |= std::abs(a[i + c] - b[i + c]) > allowed;
    n += differs ? 1 : 0;
  }
  return n;
}

struct Outcome {
  bool same = true;          ///< all shadows are kage's, but for one pixel in a thousand
  std::string names;         ///< of the renderers: cells of a table
  std::string milliseconds;  ///< theirs, and how many times kage's that is
};

/// Milliseconds for Embree's BVH, which no renderer's time holds.
double build_ms(const SceneFrame& frame) {
  std::vector<double> builds;
  for (int i = 0; i < 5; ++i) {
    const double start = cpu_ms();
    const EmbreeScene built(frame, EmbreeUse::speed);
    builds.push_back(cpu_ms() - start);
  }
  return median(builds);
}

/// All ways to render, kage's two first; without stencils where there is no OpenGL.
std::vector<Renderer> renderers(const Setting& s, const EmbreeScene& scene, std::optional<StencilRenderer>& gl) {
  SpaceBox box;
  for (const glm::dvec3& v : s.frame.vertices) box.add(v);
  const auto offset = static_cast<float>(1e-5 * box.diagonal());
  std::vector<Renderer> all;
  all.push_back(kage_renderer(s, "kage, parity", 1));
  all.push_back(kage_renderer(s, "kage, 4 bits", 4));
  all.push_back(embree_renderer<1>(s, scene, offset));
  all.push_back(embree_renderer<8>(s, scene, offset));
  all.push_back(embree_renderer<16>(s, scene, offset));
  if (gl) {
    all.push_back(stencil_renderer(s, *gl, StencilWay::depth_fail));
    all.push_back(stencil_renderer(s, *gl, StencilWay::depth_pass));
  }
  return all;
}

/// Runs all in turn, and says how many times the processor's time the wall clock's was.
double run_all(std::vector<Renderer>& all) {
  // Shadows first, which warms up as well.
  for (Renderer& r : all) {
    Parts unused;
    r.render(Shown::shadow, unused, r.shadow);
    r.render(Shown::picture, unused, r.picture);
  }
  const double wall = wall_ms();
  const double cpu = cpu_ms();
  for (int i = 0; i < kRuns; ++i)
    for (Renderer& r : all) run_once(r);
  return (wall_ms() - wall) / (cpu_ms() - cpu);
}

/// Prints a row for each renderer.
Outcome print_rows(const std::vector<Renderer>& all) {
  const double parity = median(all[0].sums);
  const double counting = median(all[1].sums);
  Outcome outcome;
  for (const Renderer& r : all) {
    const double sum = median(r.sums);
    std::string parts;
    for (std::size_t i = 0; i < r.times.size() && r.times.size() > 1; ++i)
      parts += fmt::format("{}{} {:.2f}", i == 0 ? "  " : ", ", r.part_names[i], median(r.times[i]));
    const std::size_t shadows = differing(r.shadow, all[0].shadow, 0);
    outcome.same &= 1000 * shadows <= r.shadow.size() / 3;
    fmt::print("  {:<22}{:>8.2f}{:>10.2f}{:>10.2f}{:>9}{:>9}{}\n", r.name, sum, sum / parity, sum / counting,
               differing(r.picture, all[0].picture, 2), shadows, parts);
    outcome.names += fmt::format(" {} |", r.name);
    outcome.milliseconds += &r < &all[2] ? fmt::format(" {:.1f} |", sum)
                                         : fmt::format(" {:.1f}: {:.2f}, {:.2f} |", sum, sum / parity, sum / counting);
  }
  return outcome;
}

Outcome compare(const std::string& name, const SceneFrame& frame, int width, int height) {
  Setting s;
  s.frame = frame;
  s.frame.lights.resize(1);
  s.width = width;
  s.height = height;
  const double build = build_ms(s.frame);
  const EmbreeScene scene(s.frame, EmbreeUse::speed);
  std::optional<StencilRenderer> gl;
  try {
    gl.emplace(width, height);
  } catch (const std::runtime_error&) {  // main() has said so
  }
  std::vector<Renderer> all = renderers(s, scene, gl);
  const double busy = run_all(all);

  std::size_t dark = 0;
  for (std::size_t i = 0; i < all[0].shadow.size(); i += 3) dark += all[0].shadow[i] == 0 ? 1 : 0;
  fmt::print("{}, {}x{}: {} faces, {} pixels in shadow; wall clock {:.2f} of processor time\n", name, width, height,
             s.frame.polygons.size(), dark, busy);
  fmt::print("  {:<22}{:>8}{:>10}{:>10}{:>9}{:>9}  parts\n", "", "ms", "/ parity", "/ 4 bits", "colours", "shadows");
  Outcome outcome = print_rows(all);
  fmt::print("  {:<22}{:>8.2f}   not in the above\n", "Embree's BVH", build);
  outcome.names += " Embree's BVH, apart |";
  outcome.milliseconds += fmt::format(" {:.1f} |", build);
  if (!outcome.same) fmt::print("  these do not draw the same shadows\n");
  std::fflush(stdout);
  return outcome;
}

}  // namespace

int main() {
  try {
    fmt::print("Embree {}; {}\n", RTC_VERSION_STRING, StencilRenderer(16, 16).name());
  } catch (const std::runtime_error& e) {
    fmt::print("Embree {}; no stencil volumes: {}\n", RTC_VERSION_STRING, e.what());
  }
  std::vector<std::pair<std::string, SceneFrame>> frames;
  for (const char* name : {"courtyard", "knot"}) {
    const Scene scene = Scene::load(name);
    frames.emplace_back(name, scene.frame(0, scene.frame_count()));
  }
  for (const char* mesh : {"horse.3ds", "bunny.obj"})
    if (const std::string path = std::string("/usr/share/glmark2/models/") + mesh; std::filesystem::exists(path)) {
      const Scene scene = Scene::load(path);
      frames.emplace_back(mesh, on_ground(scene.frame(0, scene.frame_count()), 35));
    }
  bool same = true;
  std::string table;
  for (const auto& [name, frame] : frames)
    for (const auto& [width, height] : {std::pair{640, 480}, {1280, 720}}) {
      const Outcome o = compare(name, frame, width, height);
      same &= o.same;
      if (table.empty()) {
        table = fmt::format("| milliseconds: / parity, / 4 bits |{}\n|---|", o.names);
        for (const char c : o.names) table += c == '|' ? "---|" : "";
        table += '\n';
      }
      table += fmt::format("| {}, {}x{} |{}\n", name, width, height, o.milliseconds);
    }
  fmt::print("\n{}", table);
  return same ? 0 : 1;
}
