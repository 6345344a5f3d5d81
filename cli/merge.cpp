// SPDX-License-Identifier: Apache-2.0
// kage merge REPORT...: the reports of all shards of a kage cosim as one.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "ci.hpp"
#include "command.hpp"
#include "cosim/recall.hpp"
#include "joined.hpp"
#include "junit.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "results.hpp"
#include "shards.hpp"
#include "signals.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

struct MergeCommand : Options {
  std::vector<std::string> inputs;
  std::string junit;
};

/// What a shard has of a scene.
struct Part {
  const ShardFile* shard;
  const Json& report;
};

/// Those that have frames of it.
std::vector<Part> parts_of(const std::vector<ShardFile>& shards, std::size_t scene) {
  std::vector<Part> parts;
  for (const ShardFile& s : shards)
    if (has_frames(s.scene(scene))) parts.push_back({&s, s.scene(scene)});
  return parts;
}

std::uint64_t sum(const std::vector<Part>& parts, const char* key) {
  std::uint64_t total = 0;
  for (const Part& p : parts) total += p.report[key].get<std::uint64_t>();
  return total;
}

double sum_seconds(const std::vector<Part>& parts, const char* key) {
  double total = 0;
  for (const Part& p : parts) total += p.report[key].get<double>();
  return total;
}

/// The texts of all lists, each once.
Json united(const std::vector<Part>& parts, const char* key) {
  Json all = Json::array();
  std::set<std::string> seen;
  for (const Part& p : parts)
    for (const Json& text : p.report[key])
      if (seen.insert(text.get<std::string>()).second) all.push_back(text);
  return all;
}

/// In the order of frames; null for those that were not compared.
Json frame_seconds(const std::vector<Part>& parts) {
  const auto total = parts.front().report["total_frames"].get<std::size_t>();
  Json all = Json::array();
  all.get_ref<Json::array_t&>().resize(total);
  for (const Part& p : parts) {
    auto frame = p.report["first_frame"].get<std::size_t>();
    for (const Json& seconds : p.report["frame_seconds"]) {
      all[frame] = seconds;
      frame += p.report["frame_step"].get<std::size_t>();
    }
  }
  return all;
}

/// What is known of single frames, in their order.
Json each(const std::vector<Part>& parts) {
  std::map<std::uint64_t, const Json*> frames;
  for (const Part& p : parts)
    for (const Json& frame : p.report["each"]) frames[frame["frame"].get<std::uint64_t>()] = &frame;
  Json all = Json::array();
  for (const auto& [number, frame] : frames) all.push_back(*frame);
  return all;
}

/// Those of all shards, and which frames they are of.
Json verdicts(const std::vector<Part>& parts) {
  std::vector<const Json*> all;
  std::set<std::uint64_t> frames;
  for (const Part& p : parts) {
    all.push_back(&p.report["verdicts"]);
    for (const Json& frame : p.report["verdicts"]["taken_frames"]) frames.insert(frame.get<std::uint64_t>());
  }
  Json j = all_verdicts(all);
  j["taken_frames"] = frames;
  return j;
}

/// All shards' reports of a scene as the report of one run. Polyhedra, which each shard tells of in its own frames,
/// stay with it, in `shards`.
Json merged(const std::vector<Part>& parts) {
  const Json& any = parts.front().report;
  Json j;
  Json first = nullptr, shards = Json::array();
  bool same = true;
  std::uint64_t units = 0, starved = 0, blocked = 0;
  for (const Part& p : parts) {
    const Json& r = p.report;
    same = same && r["same"].get<bool>();
    const Json& d = r["first_difference"];
    if (!d.is_null() && (first.is_null() || d["frame"] < first["frame"])) first = d;
    units = std::max(units, r["units"].get<std::uint64_t>());
    starved += r["stalled"]["input_starved"].get<std::uint64_t>();
    blocked += r["stalled"]["output_blocked"].get<std::uint64_t>();
    Json shard{{"index", p.shard->index}, {"count", p.shard->count}, {"file", p.shard->file}};
    for (const char* key : {"same", "frames", "first_frame", "frame_step", "golden_seconds", "rtl_seconds", "again",
                            "folder", "rtl", "versions", "report", "report_crc32", "polyhedra", "first_difference"})
      shard[key] = r[key];
    shards.push_back(std::move(shard));
  }
  j["same"] = same;
  j["frames"] = sum(parts, "frames");
  j["width"] = any["width"];
  j["height"] = any["height"];
  for (const char* key : {"pixels_compared", "spans", "span_pixels", "segments"}) j[key] = sum(parts, key);
  j["units"] = units;
  j["polyhedra"] = nullptr;
  j["cycles"] = sum(parts, "cycles");
  j["stalled"] = {{"input_starved", starved}, {"output_blocked", blocked}};
  j["scene"] = any["scene"];
  j["total_frames"] = any["total_frames"];
  j["first_frame"] = 0;
  j["frame_step"] = 1;
  j["shard"] = nullptr;
  j["options"] = any["options"];
  j["frame_seconds"] = frame_seconds(parts);
  j["each"] = each(parts);
  j["verdicts"] = verdicts(parts);
  for (const char* key : {"golden_seconds", "rtl_seconds", "build_seconds"}) j[key] = sum_seconds(parts, key);
  j["config_name"] = any["config_name"];
  j["config"] = any["config"];
  j["seed"] = any["seed"];
  j["versions"] = united(parts, "versions");
  j["degraded"] = any["degraded"];
  j["pictures"] = united(parts, "pictures");
  j["first_difference"] = first;
  j["notes"] = united(parts, "notes");
  j["shards"] = shards;
  return j;
}

void print_shards(const Json& report, const std::string& who) {
  for (const Json& shard : report["shards"]) {
    const Json& d = shard["first_difference"];
    if (d.is_null()) continue;
    const std::string begin =
        fmt::format("{}shard {}/{}, first ", who, shard["index"].get<int>(), shard["count"].get<int>());
    fmt::print("{}difference: {}\n", begin, d["text"].get<std::string>());
    if (!d["divergence"].is_null()) fmt::print("{}divergence: {}\n", begin, d["divergence"]["text"].get<std::string>());
  }
}

int run(const MergeCommand& o) {
  std::optional<OutFolder> folder;
  if (!o.out.empty()) folder.emplace(o.out);
  check_json(o);
  for (const std::string& input : o.inputs)
    for (const std::string* output : {&o.json, &o.junit})
      if (!output->empty() && *output != "-" && resolved(*output) == resolved(input))
        throw Error(fmt::format("{}: is one of those joined: it is not written over", input));
  refuse_twice({o.json == "-" ? "" : o.json, o.junit,
                o.out.empty() ? "" : (std::filesystem::path(o.out) / "report.html").string()});
  TempFiles files;
  const std::vector<ShardFile> shards = read_shards(o.inputs);
  const std::size_t count = shards.front().scenes();
  const bool several = shards.front().report.contains("scenes");
  JUnitWriter junit(files, o.junit, "kage cosim");
  std::vector<Json> scenes;
  for (std::size_t i = 0; i < count; ++i) {
    check_interrupt();
    const std::vector<Part> parts = parts_of(shards, i);
    scenes.push_back(merged(parts));
    std::vector<const Json*> reports;
    reports.reserve(parts.size());
    for (const Part& p : parts) reports.push_back(&p.report);
    junit_frames(junit, reports);
  }
  junit.close();
  Json j = several ? all_scenes(scenes) : scenes.front();
  std::string page;
  if (!o.out.empty()) {
    page = (std::filesystem::path(o.out) / "report.html").string();
    for (const ShardFile& s : shards) keep_page(page, s.file, s.report);
    write_joined_page(files, page, j);
  }
  j["report"] = page.empty() ? Json(nullptr) : Json(page);
  write_json(o, j, files);
  const bool same = j["same"].get<bool>();
  if (json_only(o)) return same ? kSame : kDifferent;
  fmt::print("{}: {}{} of {} in {}{}, {}{} compared, {}, seed {}\n", same ? "same" : "different",
             several ? counted(count, "scene") + ", " : "", counted(j["frames"].get<std::uint64_t>(), "frame"),
             j["total_frames"].get<std::uint64_t>(), counted(shards.size(), "shard"), cosim::taken_text(taken_of(j)),
             several ? "" : fmt::format("{}x{}, ", j["width"].get<int>(), j["height"].get<int>()),
             counted(j["pixels_compared"].get<std::uint64_t>(), "pixel"),
             counted(j["cycles"].get<std::uint64_t>(), "cycle"), j["seed"].get<std::uint64_t>());
  for (const Json& scene : scenes) print_shards(scene, several ? scene["scene"].get<std::string>() + ", " : "");
  if (!page.empty()) fmt::print("report: {}\n", page);
  return same ? kSame : kDifferent;
}

}  // namespace

void add_merge(CLI::App& app, Action& action) {
  CLI::App* c = add_command(
      app, "merge", "Join the reports of all shards of a co-simulation into one",
      "  kage cosim courtyard --shard 1/2 --json 1/cosim.json --out 1\n"
      "  kage cosim courtyard --shard 2/2 --json 2/cosim.json --out 2\n"
      "  kage merge 1/cosim.json 2/cosim.json --json cosim.json --junit cosim.xml --out joined\n"
      "The reports must be all shards of one run: the same scenes, size, configuration, seed and options.\n"
      "joined/report.html has verdict, scenes, frames and shards, with links to the shards' own pages where those\n"
      "lie beside their reports or where they were written.\n"
      "Exit code 0: all the same. 1: some different. 2: trouble.");
  const auto o = std::make_shared<MergeCommand>();
  c->add_option("REPORT", o->inputs, "what kage cosim --shard wrote by --json, of each shard")->required();
  option_json(*c, *o);
  option_junit(*c, o->junit);
  c->add_option("--out", o->out, "folder for report.html, the page of the joined run; without it none is written")
      ->type_name("DIR");
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
