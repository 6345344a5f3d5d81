// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace kage::report {
namespace {

/// As GitHub reads it: a message may hold no line break, a property no colon or comma besides.
std::string for_github(std::string_view text, bool property) {
  std::string out;
  for (const char c : text) {
    if (c == '%' || c == '\r' || c == '\n' || (property && (c == ':' || c == ',')))
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out;
}

bool wants_github(const std::string& annotate) {
  if (!annotate.empty()) return annotate == "github";
  const char* const actions = std::getenv("GITHUB_ACTIONS");
  return actions != nullptr && std::string_view(actions) == "true";
}

/// A place in the RTL.
struct Place {
  std::string file;  // or "": none is known
  std::string line;  // or ""
};

/// The place of the stage that differs first; else of the assertion that failed.
Place place_of(const DifferenceRecord& difference) {
  if (difference.divergence) return {difference.divergence->file(), ""};
  if (!difference.assertion) return {};
  const std::string& at = *difference.assertion;
  const std::size_t colon = at.rfind(':');
  return {at.substr(0, colon), colon == std::string::npos ? "" : at.substr(colon + 1)};
}

/// First difference and first divergence, a line each.
std::string text_of(const DifferenceRecord& difference) {
  return difference.divergence ? difference.text + "\nfirst divergence: " + difference.divergence->text
                               : difference.text;
}

}  // namespace

void junit_frames(JUnitWriter& junit, const std::vector<const SceneRecord*>& shards) {
  junit.group(shards.front()->scene);
  std::map<int, const SceneRecord*> by_first;
  std::set<int> taken;
  for (const SceneRecord* shard : shards) {
    by_first[shard->first_frame] = shard;
    taken.insert(shard->verdicts.taken_frames.begin(), shard->verdicts.taken_frames.end());
  }
  const int step = shards.front()->frame_step;
  for (int frame = 0; frame < shards.front()->total_frames; ++frame) {
    const auto found = by_first.find(frame % step);
    if (found == by_first.end()) continue;  // a single record may be that of one shard: it tells of its own frames
    const auto& seconds = found->second->frame_seconds;
    const auto& difference = found->second->first_difference;
    const auto place = static_cast<std::size_t>(frame / step);
    const std::string name = fmt::format("frame {}", frame);
    if (place >= seconds.size())
      junit.skip(name, difference && difference->frame
                           ? fmt::format("not compared: frame {} is different", *difference->frame)
                           : "not compared");
    else if (difference && difference->frame == frame)
      junit_difference(junit, name, seconds[place].value_or(0), *difference);
    else
      junit.pass(name, seconds[place].value_or(0),
                 taken.count(frame) == 0 ? "" : "the verdict of the RTL is taken from an earlier run");
  }
  // The register check comes behind the frames, and has a case of its own where it fails.
  for (const SceneRecord* shard : shards) {
    const auto& difference = shard->first_difference;
    if (!difference || difference->frame) continue;
    const std::string of = shards.size() > 1 && shard->shard ? fmt::format(" of shard {}", shard->shard->index) : "";
    junit_difference(junit, "registers" + of, 0, *difference, shard->again);
  }
}

void junit_difference(JUnitWriter& junit, const std::string& name, double seconds, const DifferenceRecord& difference,
                      const std::string& again) {
  const std::string details = again.empty() ? text_of(difference) : text_of(difference) + "\nagain: " + again;
  junit.fail(name, seconds, difference.text, details, place_of(difference).file);
}

void annotate_difference(const std::string& annotate, const SceneRecord& scene, std::FILE* to) {
  const auto& difference = scene.first_difference;
  if (!difference || !wants_github(annotate)) return;
  const auto [file, line] = place_of(*difference);
  const std::string what = difference->frame ? fmt::format("frame {} is", *difference->frame) : "registers are";
  const std::string title = fmt::format("kage cosim {}: {} different", scene.scene, what);
  const auto property = [](const char* name, const std::string& value) {
    return value.empty() ? "" : fmt::format("{}={},", name, for_github(value, true));
  };
  fmt::print(to, "::error {}{}title={}::{}\n", property("file", file), property("line", line), for_github(title, true),
             for_github(text_of(*difference), false));
}

}  // namespace kage::report
