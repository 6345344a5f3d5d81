// SPDX-License-Identifier: Apache-2.0
// Where tokens come from, as the front end says: drawn faces have their number as colour here, and a shadow span lies
// on the face of the volume that it is said to be of.
#include "kage/config.hpp"
#include "kage/frontend.hpp"
#include "kage/scene.hpp"
#include "kage/stream.hpp"
#include "oracle/oracle.hpp"
#include "test/support/catch.hpp"

namespace kage {
namespace {

struct Counted {
  std::size_t opaque = 0;
  std::size_t shadow = 0;
  std::size_t translucent = 0;
};

/// The tokens of a frame against its origins.
Counted check_frame(const FrameGeometry& g, const Config& c) {
  std::vector<std::uint32_t> all;
  FrameOrigins from;
  make_frame(g, c, 0, [&](std::span<const std::uint32_t> w) { all.insert(all.end(), w.begin(), w.end()); },
             {.threads = 2, .origins = &from, .all_spans = true});
  const Layout layout(c);
  Counted n;
  int y = 0;
  std::size_t wrong = 0;
  const auto number = [](const SpanToken& s) {
    return static_cast<std::uint32_t>(s.color[0] | s.color[1] << 8 | s.color[2] << 16);
  };
  for (auto words = std::span<const std::uint32_t>(all).subspan(kHeaderWords); !words.empty();) {
    const Token t = decode(c, layout, words);
    words = words.subspan(layout.words[static_cast<std::size_t>(t.kind)]);
    const bool shadow = t.kind == Kind::SP || t.kind == Kind::NC || t.kind == Kind::IF || t.kind == Kind::EV;
    if (t.kind == Kind::EOL) ++y;
    if (t.kind == Kind::OP) wrong += from.opaque.at(n.opaque++).polygon == number(t.span) ? 0 : 1;
    if (t.kind == Kind::TP) wrong += from.translucent.at(n.translucent++).polygon == number(t.span) ? 0 : 1;
    if (!shadow) continue;
    const TokenOrigin o = from.shadow.at(n.shadow++);
    const ShadowVolume& v = g.volumes.at(o.volume);
    if (t.kind != Kind::SP) continue;
    const auto faces = std::span(g.volume_faces).subspan(v.first_face, v.face_count);
    const bool of_volume =
        std::any_of(faces.begin(), faces.end(), [&](const VolumeFace& f) { return f.polygon == o.polygon; });
    const bool covers = Oracle::winding(g.outline(g.polygons.at(o.polygon)), t.span.xl, y) != 0;
    wrong += of_volume && covers ? 0 : 1;
  }
  CHECK(wrong == 0);
  CHECK(n.opaque == from.opaque.size());
  CHECK(n.shadow == from.shadow.size());
  CHECK(n.translucent == from.translucent.size());
  return n;
}

TEST_CASE("every span says which polygon it is of, and every shadow token which volume") {
  Counted all;
  for (const auto* name : {"courtyard", "inside", "glass", "cutaway", "three-lights"}) {
    CAPTURE(name);
    const Scene scene = Scene::load(name);
    Config c = load_config(std::string(name) == "glass" ? "glass" : "default").config;
    if (std::string(name) == "three-lights") c.count_bits = 4, c.lights = 4, c.class_bits = 8;
    for (int i = 0; i < 2; ++i) {
      FrameGeometry g = make_geometry(scene.frame(i, 8), c, 320, 240);
      for (std::uint32_t k = 0; k < g.polygons.size(); ++k)
        for (unsigned channel = 0; channel < 3; ++channel)
          g.polygons[k].color[channel] = static_cast<std::uint8_t>(k >> 8 * channel);
      const Counted n = check_frame(g, c);
      all.opaque += n.opaque;
      all.shadow += n.shadow;
      all.translucent += n.translucent;
    }
  }
  CHECK(all.opaque > 1000);
  CHECK(all.shadow > 1000);
  CHECK(all.translucent > 1000);
}

}  // namespace
}  // namespace kage
