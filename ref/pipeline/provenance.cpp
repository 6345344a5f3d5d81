// SPDX-License-Identifier: Apache-2.0
#include "kage/provenance.hpp"

#include <fmt/format.h>

#include "contract/kinds.hpp"
#include "kage/stream.hpp"
#include "polygon/span_tokens.hpp"

namespace kage {

std::string TokenSource::text() const {
  const bool of_shadow = role != "face" && role != "polyhedron";
  std::string t = of_shadow ? fmt::format("the {} of the shadow of {}", role, object) : fmt::format("{}", object);
  if (face >= 0) t += fmt::format(", face {}", face);
  if (role == "polyhedron") t += fmt::format(", component {}, by segments", component);
  if (light >= 0) t += fmt::format(", light {}", light);
  if (sample >= 0) t += fmt::format(" sample {}", sample);
  return t;
}

std::string Provenance::object_of(std::uint32_t component) const {
  return objects_[frame_.triangles[frame_.components[component].first].object];
}

TokenSource Provenance::of_face(std::uint32_t polygon) const {
  const Polygon& face = frame_.polygons[geometry_.polygons[polygon].source];
  const Triangle& t = frame_.triangles[face.triangle];
  TokenSource s;
  s.role = "face";
  s.object = objects_[t.object];
  s.face = static_cast<int>(t.face);
  for (std::size_t c = 0; c < frame_.components.size(); ++c)
    if (face.triangle - frame_.components[c].first < frame_.components[c].count) s.component = static_cast<int>(c);
  return s;
}

TokenSource Provenance::of_volume(const TokenOrigin& origin, Kind kind) const {
  const ShadowVolume& volume = geometry_.volumes[origin.volume];
  TokenSource s;
  if (kind == Kind::SP) {
    const bool cap = geometry_.polygons[origin.polygon].source != ~0U;
    if (cap) s = of_face(origin.polygon);
    s.role = cap ? "cap" : "side";
  } else {
    s.role = kind == Kind::EV ? "end" : "front";
  }
  if (s.object.empty()) {
    s.component = static_cast<int>(volume.component);
    s.object = object_of(volume.component);
  }
  s.volume = static_cast<int>(origin.volume);
  s.light = geometry_.sample_light.empty() ? 0 : geometry_.sample_light[volume.sample];
  if (geometry_.sample_light.empty()) return s;
  s.sample = 0;
  for (std::uint32_t i = 0; i < volume.sample; ++i)
    if (geometry_.sample_light[i] == geometry_.sample_light[volume.sample]) ++s.sample;
  return s;
}

TokenSource Provenance::of_polyhedron(std::uint32_t index) const {
  TokenSource s;
  s.role = "polyhedron";
  if (index >= geometry_.polyhedra.size()) return s;
  s.component = static_cast<int>(geometry_.polyhedra[index].component);
  s.object = object_of(geometry_.polyhedra[index].component);
  return s;
}

std::map<std::uint32_t, TokenSource> Provenance::of_tokens(const Config& config, std::span<const std::uint32_t> words,
                                                           const std::set<std::uint32_t>& wanted) const {
  std::map<std::uint32_t, TokenSource> all;
  std::uint32_t nth = 0;
  std::size_t opaque = 0;
  std::size_t shadow = 0;
  std::size_t translucent = 0;
  const auto count = [&](Kind kind) {
    const bool is_wanted = wanted.count(++nth) != 0;
    switch (kind) {
      case Kind::OP:
        if (is_wanted) all[nth] = of_face(origins_.opaque[opaque].polygon);
        ++opaque;
        break;
      case Kind::TP:
        if (is_wanted) all[nth] = of_face(origins_.translucent[translucent].polygon);
        ++translucent;
        break;
      default:
        if (!info_of(kind).volume) break;
        if (is_wanted) all[nth] = of_volume(origins_.shadow[shadow], kind);
        ++shadow;
    }
  };
  // Origins are those of spans, whoever makes them.
  const Layout layout(config);
  TokenWalk walk(layout, words);
  SpanTokens spans(config);
  spans.start(FrameHeader::read(words));
  Token t;
  while (!walk.peek().empty()) {
    decode(config, layout, walk.next(), t, walk.level());
    const ErrorCode error = spans.add(t, [&count](const Token& span, bool /*made*/) { count(span.kind); });
    if (error != ErrorCode::NONE) break;
  }
  return all;
}

std::map<std::uint32_t, TokenSource> Provenance::of_history(const Config& config, std::span<const std::uint32_t> words,
                                                            const PixelHistory& history) const {
  std::set<std::uint32_t> wanted;
  for (const PixelTouch& t : history.touches) wanted.insert(t.nth);
  auto all = of_tokens(config, words, wanted);
  for (const PixelTouch& t : history.touches)
    if (t.what.kind == Kind::TREE && t.polyhedron) all[t.nth] = of_polyhedron(*t.polyhedron);
  return all;
}

}  // namespace kage
