// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/component_ways.hpp"

#include <fmt/format.h>

#include <cstdint>

#include "json/foreign_json.hpp"
#include "kage/error.hpp"
#include "kage/geometry.hpp"

namespace kage::cosim {
namespace {

/// Why a component became spans before any unit was asked for.
std::string why_spans(SpanReason reason, const std::string& component) {
  switch (reason) {
    case SpanReason::not_closed:
    case SpanReason::not_convex:
      return component;
    case SpanReason::cut:
      return "it reaches nearer to the eye than anything that is seen, or past the guard band";
    case SpanReason::translucent:
      return "it is translucent";
    case SpanReason::culled:
      return "--cull leaves out faces that the eye would see";
    default:
      return "a face has more than one colour";
  }
}

/// Why the units had no room for more polyhedra.
std::string why_stopped(PolyhedraReport::Stop stop, int units) {
  using Stop = PolyhedraReport::Stop;
  return stop == Stop::no_unit ? fmt::format("no unit of {} has room for it", units)
         : stop == Stop::depth ? "its depth does not go on by a step that segments have"
                               : "ORDER_BITS holds no draw index for it";
}

}  // namespace

std::optional<ComponentWays::LeftOut> ComponentWays::add(const Scene& scene, const FrameParts& parts, int units) {
  const SceneFrame& frame = parts.scene;
  const auto object = [&](std::size_t c) { return scene.objects()[frame.triangles[frame.components[c].first].object]; };
  if (ways_.empty())
    for (std::size_t c = 0; c < frame.components.size(); ++c) ways_.push_back({object(c), 0, 0, SpanReason::none, {}});
  for (std::size_t c = 0; c < frame.components.size(); ++c) {
    const SpanReason reason = parts.geometry.span_reasons[c];
    if (reason == SpanReason::none) continue;  // add_polyhedra()
    ++ways_[c].span_frames;
    ways_[c].reason = reason;
    ways_[c].why = why_spans(reason, frame.components[c].reason);
  }
  return add_polyhedra(parts, units);
}

std::optional<ComponentWays::LeftOut> ComponentWays::add_polyhedra(const FrameParts& parts, int units) {
  const PolyhedraReport& report = parts.polyhedra;
  const std::string cause = why_stopped(report.stop, units);
  std::optional<LeftOut> first;
  const Way* stopped = nullptr;
  for (std::size_t i = 0; i < parts.geometry.polyhedra.size(); ++i) {
    const auto component = static_cast<std::size_t>(parts.geometry.polyhedra[i].component);
    Way& way = ways_[component];
    if (report.unit_of[i] == PolyhedraReport::kUnseen) continue;
    if (report.unit_of[i] != PolyhedraReport::kSpans) {
      ++way.unit_frames;
      continue;
    }
    ++way.span_frames;
    // The first one stopped the assignment; the others went with it.
    if (stopped == nullptr) stopped = &way;
    way.why = stopped == &way ? cause : fmt::format("behind '{}' in draw order: {}", stopped->object, cause);
    if (!first) first = {.object = way.object, .component = component, .cause = cause};
  }
  return first;
}

void ComponentWays::absorb(const ComponentWays& later) {
  if (ways_.empty()) ways_.resize(later.ways_.size());
  for (std::size_t c = 0; c < later.ways_.size(); ++c) {
    const Way& way = later.ways_[c];
    ways_[c].object = way.object;
    ways_[c].unit_frames += way.unit_frames;
    if (way.span_frames == 0) continue;
    ways_[c].span_frames += way.span_frames;
    ways_[c].reason = way.reason;
    ways_[c].why = way.why;
  }
}

std::vector<report::WayRecord> ComponentWays::records() const {
  std::vector<report::WayRecord> list;
  for (std::size_t c = 0; c < ways_.size();) {
    const Way& w = ways_[c];
    std::size_t end = c + 1;
    while (w.reason != SpanReason::none && w.unit_frames == 0 && end < ways_.size() && ways_[end].is_like(w)) ++end;
    list.push_back({.object = w.object,
                    .component = c,
                    .components = end - c,
                    .unit_frames = static_cast<std::uint64_t>(w.unit_frames),
                    .span_frames = static_cast<std::uint64_t>(w.span_frames),
                    .why = w.why.empty() ? std::nullopt : std::optional(w.why)});
    c = end;
  }
  return list;
}

report::WayRecords ways_of(const StreamFile& file, const std::string& name) {
  if (file.origin().empty()) return std::nullopt;
  const auto origin = parse_json<report::Json>(file.origin(), name + ": section ORIG");
  // Whoever wrote the file: what is JSON and not of this form is not taken.
  try {
    if (!origin.is_object() || !origin.contains("polyhedra")) return std::nullopt;
    report::WayRecords ways = report::ways_from_json(origin["polyhedra"]);
    const auto frames = static_cast<std::uint64_t>(file.frame_count());
    for (const report::WayRecord& w : ways.value_or(std::vector<report::WayRecord>()))
      if (w.component > ~0U || w.components > ~0U || w.unit_frames > frames || w.span_frames > frames)
        return std::nullopt;
    return ways;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace kage::cosim
