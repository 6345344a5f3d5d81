// SPDX-License-Identifier: Apache-2.0
// kage merge REPORT...: the reports of all shards of a kage cosim as one.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ci.hpp"
#include "common.hpp"
#include "junit.hpp"
#include "kage/error.hpp"

namespace kage::cli {
namespace {

struct MergeCommand : Options {
  std::vector<std::string> inputs;
  std::string junit;
};

struct Part {
  std::string file;
  Json report;
  int index = 0;  // of its shard, from 1
};

/// A whole number within limits; whoever wrote the file.
int number(const Part& part, const Json& in, const char* key, int least, int most) {
  const auto found = in.find(key);
  if (found == in.end() || !found->is_number_integer() || *found < least || *found > most)
    throw Error(fmt::format("{}: no report of kage cosim: {} is not what it should be", part.file, key));
  return found->get<int>();
}

/// Throws Error unless the report has all that is taken of it, in the types that kage cosim gives it.
void check(const Part& part) {
  const Json& r = part.report;
  const auto need = [&](const Json& in, const char* key, auto&& is) {
    if (!in.contains(key) || !is(in[key]))
      throw Error(fmt::format("{}: no report of kage cosim: {} is not what it should be", part.file, key));
  };
  const auto count = [](const Json& v) { return v.is_number_unsigned(); };
  const auto real = [](const Json& v) { return v.is_number(); };
  const auto text = [](const Json& v) { return v.is_string(); };
  const auto texts = [](const Json& v) {
    return v.is_array() && std::all_of(v.begin(), v.end(), [](const Json& e) { return e.is_string(); });
  };
  if (!r.is_object()) throw Error(fmt::format("{}: no report of kage cosim", part.file));
  need(r, "same", [](const Json& v) { return v.is_boolean(); });
  for (const char* key : {"frames", "width", "height", "pixels_compared", "spans", "span_pixels", "segments", "units",
                          "cycles", "seed", "total_frames"})
    need(r, key, count);
  for (const char* key : {"golden_seconds", "rtl_seconds", "build_seconds"}) need(r, key, real);
  need(r, "scene", text);
  for (const char* key : {"config", "options", "stalled"}) need(r, key, [](const Json& v) { return v.is_object(); });
  for (const char* key : {"input_starved", "output_blocked"}) need(r["stalled"], key, count);
  for (const char* key : {"degraded", "pictures", "notes"}) need(r, key, texts);
  need(r, "polyhedra", [](const Json& v) { return v.is_array() || v.is_null(); });
  need(r, "frame_seconds", [&](const Json& v) { return v.is_array() && std::all_of(v.begin(), v.end(), real); });
  need(r, "shard", [](const Json& v) { return v.is_object() || v.is_null(); });
  need(r, "first_difference", [&](const Json& v) { return r["same"].get<bool>() ? v.is_null() : v.is_object(); });
  if (r["same"].get<bool>()) return;
  const Json& d = r["first_difference"];
  need(d, "frame", count);
  need(d, "text", text);
  need(d, "divergence", [](const Json& v) { return v.is_object() || v.is_null(); });
  if (d["divergence"].is_null()) return;
  need(d["divergence"], "file", text);
  need(d["divergence"], "text", text);
}

Part read(const std::string& file) {
  Part part;
  part.file = file;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(fmt::format("{}: cannot be read", file));
  part.report = Json::parse(in, nullptr, false);
  if (part.report.is_discarded()) throw Error(fmt::format("{}: not JSON", file));
  check(part);
  const Json& r = part.report;
  if (r["shard"].is_null()) throw Error(fmt::format("{}: the report of all frames, not of a shard (--shard)", file));
  const int count = number(part, r["shard"], "count", 1, 1000000);
  part.index = number(part, r["shard"], "index", 1, count);
  // A shard is whole, or ends with the frame that differs.
  const Shard shard{part.index, count, true};
  const int own = shard.frames(number(part, r, "total_frames", 1, 1000000));
  const int frames = number(part, r, "frames", 1, 1000000);
  const bool same = r["same"].get<bool>();
  if (frames > own || (same && frames < own) || r["frame_seconds"].size() != static_cast<std::size_t>(frames) ||
      (!same && r["first_difference"]["frame"] != part.index - 1 + (frames - 1) * count))
    throw Error(fmt::format("{}: shard {}/{} of {} frames cannot have the {} that it tells of", file, part.index, count,
                            r["total_frames"].get<int>(), frames));
  return part;
}

/// The parts in the order of their shards. Throws Error unless they are all shards of one run, each once.
std::vector<Part> read_all(const std::vector<std::string>& files) {
  std::vector<Part> parts;
  for (const std::string& file : files) {
    check_interrupt();
    parts.push_back(read(file));
    const Part& first = parts.front();
    const Part& part = parts.back();
    for (const char* key : {"scene", "width", "height", "config", "seed", "total_frames", "options", "degraded"})
      if (part.report[key] != first.report[key])
        throw Error(fmt::format("{}: its {} is not that of {}", part.file, key, first.file));
    if (part.report["shard"]["count"] != first.report["shard"]["count"])
      throw Error(fmt::format("{}: one of {} shards, {} one of {}", part.file, part.report["shard"]["count"].dump(),
                              first.file, first.report["shard"]["count"].dump()));
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.index < b.index; });
  const int count = parts.front().report["shard"]["count"].get<int>();
  for (std::size_t i = 1; i < parts.size(); ++i)
    if (parts[i].index == parts[i - 1].index)
      throw Error(
          fmt::format("{}: shard {}/{} once more, as {}", parts[i].file, parts[i].index, count, parts[i - 1].file));
  for (int i = 1; i <= count; ++i)
    if (i > static_cast<int>(parts.size()) || parts[static_cast<std::size_t>(i) - 1].index != i)
      throw Error(fmt::format("shard {}/{} is missing", i, count));
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
Json frame_seconds(const std::vector<Part>& parts, int total) {
  Json all = Json::array();
  for (int frame = 0; frame < total; ++frame) {
    const auto count = static_cast<int>(parts.size());
    const Json& of = parts[static_cast<std::size_t>(frame % count)].report["frame_seconds"];
    const auto place = static_cast<std::size_t>(frame / count);
    all.push_back(place < of.size() ? of[place] : Json(nullptr));
  }
  return all;
}

/// All shards' reports as the report of one run. Polyhedra, which each shard tells of in its own frames, stay with
/// it, in `shards`.
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
    shards.push_back({{"index", p.index},
                      {"file", p.file},
                      {"same", r["same"]},
                      {"frames", r["frames"]},
                      {"polyhedra", r["polyhedra"]},
                      {"first_difference", d}});
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
  j["shard"] = nullptr;
  j["options"] = any["options"];
  j["frame_seconds"] = frame_seconds(parts, any["total_frames"].get<int>());
  for (const char* key : {"golden_seconds", "rtl_seconds", "build_seconds"}) j[key] = sum_seconds(parts, key);
  j["config"] = any["config"];
  j["seed"] = any["seed"];
  j["degraded"] = any["degraded"];
  j["pictures"] = united(parts, "pictures");
  j["first_difference"] = first;
  j["notes"] = united(parts, "notes");
  j["shards"] = shards;
  return j;
}

int run(const MergeCommand& o) {
  check_json(o);
  for (const std::string& input : o.inputs)
    for (const std::string* output : {&o.json, &o.junit})
      if (*output == input) throw Error(fmt::format("{}: is one of those joined: it is not written over", input));
  if (!o.junit.empty() && o.junit == o.json) throw Error(fmt::format("{}: is to be written twice", o.json));
  TempFiles files;
  const std::vector<Part> parts = read_all(o.inputs);
  const Json j = merged(parts);
  JUnitWriter junit(files, o.junit, "kage cosim " + j["scene"].get<std::string>());
  std::vector<const Json*> reports;
  reports.reserve(parts.size());
  for (const Part& p : parts) reports.push_back(&p.report);
  junit_frames(junit, reports);
  junit.close();
  write_json(o, j, files);
  const bool same = j["same"].get<bool>();
  if (json_only(o)) return same ? kSame : kDifferent;
  fmt::print("{}: {} of {} in {}, {}x{}, {} compared, {}, seed {}\n", same ? "same" : "different",
             counted(j["frames"].get<std::uint64_t>(), "frame"), j["total_frames"].get<int>(),
             counted(parts.size(), "shard"), j["width"].get<int>(), j["height"].get<int>(),
             counted(j["pixels_compared"].get<std::uint64_t>(), "pixel"),
             counted(j["cycles"].get<std::uint64_t>(), "cycle"), j["seed"].get<std::uint64_t>());
  for (const Part& p : parts) {
    const Json& d = p.report["first_difference"];
    if (d.is_null()) continue;
    fmt::print("shard {}/{}, first difference: {}\n", p.index, parts.size(), d["text"].get<std::string>());
    if (!d["divergence"].is_null())
      fmt::print("shard {}/{}, first divergence: {}\n", p.index, parts.size(),
                 d["divergence"]["text"].get<std::string>());
  }
  return same ? kSame : kDifferent;
}

}  // namespace

void add_merge(CLI::App& app, Action& action) {
  CLI::App* c = add_command(app, "merge", "Join the reports of all shards of a co-simulation into one",
                            "  kage cosim courtyard --shard 1/2 --json 1.json\n"
                            "  kage cosim courtyard --shard 2/2 --json 2.json\n"
                            "  kage merge 1.json 2.json --json cosim.json --junit cosim.xml\n"
                            "The reports must be all shards of one run: the same scene, size, configuration, seed and "
                            "options.\n"
                            "Exit code 0: all the same. 1: some different. 2: trouble.");
  const auto o = std::make_shared<MergeCommand>();
  c->add_option("REPORT", o->inputs, "what kage cosim --shard wrote by --json, of each shard")->required();
  option_json(*c, *o);
  option_junit(*c, o->junit);
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
