// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/polygon_ways.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>
#include <vector>

#include "number/counted.hpp"

namespace kage::cosim {
namespace {

/// Names in JSON and causes, by PolygonWay.
struct WayText {
  std::string_view name;
  std::string_view cause;
};
constexpr std::array<WayText, kPolygonWays> kTexts{{
    {"polygon", ""},
    {"crossings", "more than one span on a line"},
    {"wide", "too steep for a field"},
    {"rounded", "clamped depth or colour"},
    {"cut", "parted by other translucent faces or by dicing"},
    {"words", "no fewer words"},
    {"active", "more at once than ACTIVE"},
    {"place", "too many in a volume"},
}};

double share(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

void PolygonWays::add(const PolygonReport& frame) {
  sum_ += frame;
  whole_ += frame.polygons ? 0 : 1;
}

void PolygonWays::absorb(const PolygonWays& later) {
  sum_ += later.sum_;
  whole_ += later.whole_;
}

std::string PolygonWays::text() const {
  const PolygonReport::Way all = sum_.all();
  const PolygonReport::Way& made = sum_.made();
  std::string text = fmt::format(
      "front end makes {:.1f} % of the spans ({:.1f} % of those of polygons of three lines or more), of {} at once at "
      "most\n",
      100 * share(made.spans, all.spans), 100 * share(made.tall_spans, all.tall_spans),
      counted(static_cast<std::uint64_t>(sum_.active), "polygon"));
  std::vector<std::string> rest;
  for (std::size_t i = 1; i < kPolygonWays; ++i) {
    const PolygonReport::Way& way = sum_.ways[i];
    if (way.polygons > 0)
      rest.push_back(fmt::format("{} {:.1f} % ({})", kTexts[i].cause, 100 * share(way.spans, all.spans),
                                 counted(way.polygons, "polygon")));
  }
  if (!rest.empty()) text += fmt::format("spans in the stream: {}\n", fmt::join(rest, ", "));
  if (whole_ > 0)
    text += fmt::format("{} at the span level: more light samples or volumes than places count\n",
                        counted(static_cast<std::uint64_t>(whole_), "frame"));
  return text;
}

report::Json PolygonWays::json() const {
  const PolygonReport::Way all = sum_.all();
  report::Json j;
  j["share"] = share(sum_.made().spans, all.spans);
  j["tall_share"] = share(sum_.made().tall_spans, all.tall_spans);
  j["active"] = sum_.active;
  j["span_level_frames"] = whole_;
  for (std::size_t i = 0; i < kPolygonWays; ++i) {
    const PolygonReport::Way& way = sum_.ways[i];
    j["ways"][std::string(kTexts[i].name)] = {{"polygons", way.polygons},
                                              {"spans", way.spans},
                                              {"tall_polygons", way.tall_polygons},
                                              {"tall_spans", way.tall_spans}};
  }
  return j;
}

}  // namespace kage::cosim
