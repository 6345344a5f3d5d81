// SPDX-License-Identifier: Apache-2.0
#include "ci.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "kage/error.hpp"
#include "options.hpp"
#include "results.hpp"

namespace kage::cli {
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

/// Of the stage that differs first; else of the assertion that failed.
Place place_of(const Json& difference) {
  if (!difference["divergence"].is_null()) return {difference["divergence"]["file"].get<std::string>(), ""};
  if (difference["assertion"].is_null()) return {};
  const std::string at = difference["assertion"].get<std::string>();
  const std::size_t colon = at.rfind(':');
  return {at.substr(0, colon), colon == std::string::npos ? "" : at.substr(colon + 1)};
}

/// First difference and first divergence, a line each.
std::string text_of(const Json& difference) {
  std::string text = difference["text"].get<std::string>();
  if (!difference["divergence"].is_null())
    text += "\nfirst divergence: " + difference["divergence"]["text"].get<std::string>();
  return text;
}

}  // namespace

void option_shard(CLI::App& command, Shard& shard) {
  command
      .add_option_function<std::string>(
          "--shard",
          [&shard](const std::string& text) {
            const char* const end = text.data() + text.size();
            Shard s;
            s.given = true;
            const auto i = std::from_chars(text.data(), end, s.index);
            const bool slash = i.ec == std::errc{} && i.ptr != end && *i.ptr == '/';
            const auto n = slash ? std::from_chars(i.ptr + 1, end, s.count) : i;
            if (!slash || n.ec != std::errc{} || n.ptr != end || s.count < 1 || s.count > kMostFrames || s.index < 1 ||
                s.index > s.count)
              throw CLI::ValidationError("--shard", text + " is not I/N with I from 1 to N, like 2/4");
            shard = s;
          },
          "run the Ith of N parts of the frames of all scenes: frame I - 1 and every Nth after it. kage merge joins "
          "the "
          "reports")
      ->type_name("I/N");
}

void option_junit(CLI::App& command, std::string& path, const std::string& each) {
  command.add_option("--junit", path, "write JUnit XML: a test case for each " + each)->type_name("FILE");
}

void option_annotate(CLI::App& command, std::string& annotate) {
  command
      .add_option("--annotate", annotate,
                  "github: print a difference so that GitHub shows it at the RTL's file, default where GITHUB_ACTIONS "
                  "is true; none: never")
      ->option_text("github|none")
      ->check(CLI::IsMember({"github", "none"}))
      ->type_name("WHERE");
}

void describe_run(Json& report, const std::string& scene, int total, const Shard& shard, cosim::FrameSteps steps,
                  Json options) {
  report["scene"] = scene;
  report["total_frames"] = total;
  report["first_frame"] = steps.first;
  report["frame_step"] = steps.step;
  report["shard"] = shard.given ? Json{{"index", shard.index}, {"count", shard.count}} : Json(nullptr);
  report["options"] = std::move(options);
}

Json no_frames(const std::string& scene, int total) {
  return {{"same", nullptr}, {"frames", 0}, {"scene", scene}, {"total_frames", total}};
}

bool has_frames(const Json& report) { return report["frames"] != 0; }

Json all_verdicts(const std::vector<const Json*>& parts) {
  bool cached = false;
  std::uint64_t taken = 0, kept = 0;
  Json trouble = nullptr;
  for (const Json* p : parts) {
    cached = cached || p->at("cached").get<bool>();
    taken += p->at("taken").get<std::uint64_t>();
    kept += p->at("kept").get<std::uint64_t>();
    if (trouble.is_null()) trouble = p->at("trouble");
  }
  return {{"cached", cached}, {"taken", taken}, {"kept", kept}, {"trouble", trouble}};
}

std::uint64_t taken_of(const Json& report) { return report["verdicts"]["taken"].get<std::uint64_t>(); }

Json all_scenes(std::vector<Json> scenes) {
  Json j;
  bool same = true;
  Json first = nullptr;
  for (const Json& r : scenes) {
    if (!has_frames(r)) continue;
    same = same && r["same"].get<bool>();
    if (!first.is_null() || r["first_difference"].is_null()) continue;
    first = {{"scene", r["scene"]}};
    first.update(r["first_difference"]);
  }
  const auto sum = [&](const Json::json_pointer& at, auto total) {
    for (const Json& r : scenes)
      if (has_frames(r)) total += r.at(at).get<decltype(total)>();
    return total;
  };
  const auto count = [&](const char* at) { return sum(Json::json_pointer(at), std::uint64_t{0}); };
  const auto seconds = [&](const char* at) { return sum(Json::json_pointer(at), 0.0); };
  const Json& any = *std::find_if(scenes.begin(), scenes.end(), has_frames);
  j["same"] = same;
  for (const char* key : {"frames", "pixels_compared", "spans", "span_pixels", "segments", "cycles"})
    j[key] = count((std::string("/") + key).c_str());
  j["stalled"] = {{"input_starved", count("/stalled/input_starved")},
                  {"output_blocked", count("/stalled/output_blocked")}};
  std::uint64_t total = 0;
  for (const Json& r : scenes) total += r["total_frames"].get<std::uint64_t>();
  j["total_frames"] = total;
  j["shard"] = any["shard"];
  std::vector<const Json*> verdicts;
  for (const Json& r : scenes)
    if (has_frames(r)) verdicts.push_back(&r["verdicts"]);
  j["verdicts"] = all_verdicts(verdicts);
  for (const char* key : {"golden_seconds", "rtl_seconds", "build_seconds"})
    j[key] = seconds((std::string("/") + key).c_str());
  j["seed"] = any["seed"];
  j["first_difference"] = first;
  j["scenes"] = std::move(scenes);
  return j;
}

void junit_frames(JUnitWriter& junit, const std::vector<const Json*>& shards) {
  junit.group(shards.front()->at("scene").get<std::string>());
  const int total = shards.front()->at("total_frames").get<int>();
  std::map<int, const Json*> by_first;
  std::set<int> taken;
  for (const Json* shard : shards) {
    by_first[shard->at("first_frame").get<int>()] = shard;
    for (const Json& frame : shard->at("verdicts").at("taken_frames")) taken.insert(frame.get<int>());
  }
  const int step = shards.front()->at("frame_step").get<int>();
  for (int frame = 0; frame < total; ++frame) {
    const auto found = by_first.find(frame % step);
    if (found == by_first.end()) continue;  // a single report may be that of one shard: it tells of its own frames
    const Json& shard = *found->second;
    const auto place = static_cast<std::size_t>(frame / step);
    const Json& seconds = shard["frame_seconds"];
    const std::string name = fmt::format("frame {}", frame);
    const Json& difference = shard["first_difference"];
    if (place >= seconds.size())
      junit.skip(name, fmt::format("not compared: frame {} is different", difference["frame"].get<int>()));
    else if (!difference.is_null() && place + 1 == seconds.size())
      junit_difference(junit, name, seconds[place].get<double>(), difference);
    else
      junit.pass(name, seconds[place].get<double>(),
                 taken.count(frame) == 0 ? "" : "the verdict of the RTL is taken from an earlier run");
  }
}

void junit_difference(JUnitWriter& junit, const std::string& name, double seconds, const Json& difference,
                      const std::string& again) {
  const std::string details = again.empty() ? text_of(difference) : text_of(difference) + "\nagain: " + again;
  junit.fail(name, seconds, difference["text"].get<std::string>(), details, place_of(difference).file);
}

void annotate_difference(const std::string& annotate, const Json& report, std::FILE* to) {
  const Json& difference = report["first_difference"];
  if (difference.is_null() || !wants_github(annotate)) return;
  const auto [file, line] = place_of(difference);
  const std::string title = fmt::format("kage cosim {}: frame {} is different", report["scene"].get<std::string>(),
                                        difference["frame"].get<int>());
  const auto property = [](const char* name, const std::string& value) {
    return value.empty() ? "" : fmt::format("{}={},", name, for_github(value, true));
  };
  fmt::print(to, "::error {}{}title={}::{}\n", property("file", file), property("line", line), for_github(title, true),
             for_github(text_of(difference), false));
}

}  // namespace kage::cli
