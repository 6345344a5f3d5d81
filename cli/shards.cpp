// SPDX-License-Identifier: Apache-2.0
#include "shards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>

#include "ci.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "results.hpp"
#include "signals.hpp"

namespace kage::cli {
namespace {

[[noreturn]] void refuse(const std::string& file, const char* key) {
  throw Error(fmt::format("{}: no report of kage cosim: {} is not what it should be", file, key));
}

/// A whole number within limits; whoever wrote the file.
int number(const std::string& file, const Json& in, const char* key, int least, int most) {
  const auto found = in.find(key);
  if (found == in.end() || !found->is_number_integer() || *found < least || *found > most) refuse(file, key);
  return found->get<int>();
}

bool is_whole(const Json& v) { return v.is_number_unsigned(); }
/// No run counts so far, and sums over all shards that there can be do not wrap.
bool is_count(const Json& v) { return is_whole(v) && v.get<std::uint64_t>() < std::uint64_t{1} << 43; }
bool is_seconds(const Json& v) { return v.is_number() && v.get<double>() >= 0 && v.get<double>() < 1e9; }
bool is_text(const Json& v) { return v.is_string(); }
bool is_text_or_null(const Json& v) { return v.is_string() || v.is_null(); }
bool is_object(const Json& v) { return v.is_object(); }
bool is_object_or_null(const Json& v) { return v.is_object() || v.is_null(); }

/// What all elements of a list are.
template <class Is>
auto list_of(Is is) {
  return [is](const Json& v) { return v.is_array() && std::all_of(v.begin(), v.end(), is); };
}

template <class Is>
void need(const std::string& file, const Json& in, std::initializer_list<const char*> keys, Is is) {
  for (const char* key : keys)
    if (!in.contains(key) || !is(in[key])) refuse(file, key);
}

void check_difference(const std::string& file, const Json& d) {
  need(file, d, {"frame"}, is_count);
  need(file, d, {"text"}, is_text);
  need(file, d, {"waveform", "assertion", "no_divergence"}, is_text_or_null);
  need(file, d, {"searched"}, [](const Json& v) { return v.is_boolean(); });
  need(file, d, {"divergence"}, is_object_or_null);
  if (d["divergence"].is_null()) return;
  need(file, d["divergence"], {"file", "text"}, is_text);
  need(file, d["divergence"], {"waits", "save_file"}, is_text_or_null);
}

/// Throws Error unless the report of a scene has all that is taken of it, in the types that kage cosim gives it.
void check(const std::string& file, const Json& r) {
  const auto is_bool = [](const Json& v) { return v.is_boolean(); };
  need(file, r, {"same"}, is_bool);
  need(file, r,
       {"frames", "width", "height", "pixels_compared", "spans", "span_pixels", "segments", "units", "cycles",
        "total_frames", "first_frame", "frame_step"},
       is_count);
  need(file, r, {"seed"}, is_whole);
  need(file, r, {"golden_seconds", "rtl_seconds", "build_seconds"}, is_seconds);
  need(file, r, {"scene", "config_name", "again", "folder", "rtl"}, is_text);
  need(file, r, {"report", "report_crc32"}, is_text_or_null);
  need(file, r, {"config", "options", "stalled", "verdicts"}, is_object);
  need(file, r["verdicts"], {"cached"}, is_bool);
  need(file, r["verdicts"], {"taken", "kept"}, is_count);
  need(file, r["verdicts"], {"trouble"}, is_text_or_null);
  need(file, r["verdicts"], {"taken_frames"}, list_of([](const Json& v) { return is_count(v) && v < kMostFrames; }));
  for (const Json& value : r["config"])
    if (!is_count(value)) refuse(file, "config");
  need(file, r["stalled"], {"input_starved", "output_blocked"}, is_count);
  need(file, r, {"degraded", "pictures", "notes", "versions"}, list_of(is_text));
  need(file, r, {"polyhedra"}, [](const Json& v) { return v.is_array() || v.is_null(); });
  need(file, r, {"frame_seconds"}, list_of(is_seconds));
  need(file, r, {"each"}, list_of(is_object));
  for (const Json& frame : r["each"]) {
    need(file, frame, {"same"}, is_bool);
    need(file, frame, {"frame", "cycles", "spans", "span_pixels", "segments", "words"}, is_count);
    need(file, frame, {"stalled"}, is_object);
    need(file, frame["stalled"], {"input_starved", "output_blocked"}, is_count);
  }
  const bool same = r["same"].get<bool>();
  need(file, r, {"first_difference"}, [&](const Json& v) { return same ? v.is_null() : v.is_object(); });
  if (!same) check_difference(file, r["first_difference"]);
}

/// Throws Error unless the report of a scene before which others have so many frames tells of the frames that the shard
/// has of it: all, or those up to the one that differs.
void check_frames(const ShardFile& f, const Json& r, std::int64_t before) {
  const Shard shard{f.index, f.count, true};
  const cosim::FrameSteps steps = shard.steps(before);
  const int total = number(f.file, r, "total_frames", 1, kMostFrames);
  const int own = shard.frames(total, before);
  const int frames = number(f.file, r, "frames", own == 0 ? 0 : 1, kMostFrames);
  const auto wrong = [&] {
    throw Error(fmt::format("{}: shard {}/{} of {} frames cannot have the {} that it tells of", f.file, f.index,
                            f.count, total, frames));
  };
  if (frames > own) wrong();
  if (own == 0) return;
  const bool same = r["same"].get<bool>();
  if (number(f.file, r, "frame_step", 1, kMostFrames) != steps.step ||
      number(f.file, r, "first_frame", 0, kMostFrames) != steps.first || (same && frames < own) ||
      r["frame_seconds"].size() != static_cast<std::size_t>(frames) ||
      (!same && r["first_difference"]["frame"] != steps.first + (frames - 1) * steps.step))
    wrong();
  // Each of them once, in order.
  std::int64_t last = -1;
  for (const Json& frame : r["each"]) {
    const auto n = frame["frame"].get<std::int64_t>();
    if (n <= last || n % steps.step != steps.first || n > steps.first + std::int64_t{frames - 1} * steps.step)
      throw Error(fmt::format("{}: frame {} is there twice or is not of shard {}/{}", f.file, n, f.index, f.count));
    last = n;
  }
}

ShardFile read(const std::string& file) {
  ShardFile f;
  f.file = file;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(fmt::format("{}: cannot be read", file));
  f.report = Json::parse(in, nullptr, false);
  if (f.report.is_discarded()) throw Error(fmt::format("{}: not JSON", file));
  if (!f.report.is_object()) throw Error(fmt::format("{}: no report of kage cosim", file));
  if (f.report.contains("scenes")) {
    need(file, f.report, {"scenes"}, [](const Json& v) { return v.is_array() && !v.empty(); });
    need(file, f.report, {"scenes"}, list_of(is_object));
  }
  need(file, f.report, {"shard"}, is_object_or_null);
  if (f.report["shard"].is_null())
    throw Error(fmt::format("{}: the report of all frames, not of a shard (--shard)", file));
  bool any = false;
  for (std::size_t i = 0; i < f.scenes(); ++i) {
    const Json& r = f.scene(i);
    if (f.report.contains("scenes") && r.contains("frames") && r["frames"] == 0) {
      need(file, r, {"scene"}, is_text);
      number(file, r, "total_frames", 1, kMostFrames);
      continue;
    }
    check(file, r);
    any = any || has_frames(r);
  }
  if (!any) refuse(file, "frames");
  f.count = number(file, f.report["shard"], "count", 1, kMostFrames);
  f.index = number(file, f.report["shard"], "index", 1, f.count);
  return f;
}

void check_frames(const ShardFile& f) {
  std::int64_t before = 0;
  for (std::size_t i = 0; i < f.scenes(); ++i) {
    check_frames(f, f.scene(i), before);
    before += f.scene(i)["total_frames"].get<int>();
  }
}

/// Throws Error unless the file is of the same run as those read before it.
void check_alike(const ShardFile& f, const std::vector<ShardFile>& before) {
  const ShardFile& first = before.front();
  if (f.scenes() != first.scenes() || f.report.contains("scenes") != first.report.contains("scenes"))
    throw Error(fmt::format("{}: its scenes are not those of {}", f.file, first.file));
  for (std::size_t i = 0; i < f.scenes(); ++i) {
    const auto same = [&](const ShardFile& other, const char* key) {
      if (f.scene(i)[key] != other.scene(i)[key])
        throw Error(fmt::format("{}: its {} is not that of {}", f.file, key, other.file));
    };
    for (const char* key : {"scene", "total_frames"}) same(first, key);
    const auto other =
        std::find_if(before.begin(), before.end(), [&](const ShardFile& b) { return has_frames(b.scene(i)); });
    if (!has_frames(f.scene(i)) || other == before.end()) continue;
    for (const char* key : {"width", "height", "config", "seed", "options", "degraded"}) same(*other, key);
  }
  if (f.count != first.count)
    throw Error(fmt::format("{}: one of {} shards, {} one of {}", f.file, f.count, first.file, first.count));
}

}  // namespace

std::vector<ShardFile> read_shards(const std::vector<std::string>& files) {
  std::vector<ShardFile> all;
  for (const std::string& file : files) {
    check_interrupt();
    ShardFile f = read(file);
    if (!all.empty()) check_alike(f, all);
    check_frames(f);
    all.push_back(std::move(f));
  }
  std::stable_sort(all.begin(), all.end(), [](const ShardFile& a, const ShardFile& b) { return a.index < b.index; });
  const int count = all.front().count;
  for (std::size_t i = 1; i < all.size(); ++i)
    if (all[i].index == all[i - 1].index)
      throw Error(fmt::format("{}: shard {}/{} once more, as {}", all[i].file, all[i].index, count, all[i - 1].file));
  for (int i = 1; i <= count; ++i)
    if (i > static_cast<int>(all.size()) || all[static_cast<std::size_t>(i) - 1].index != i)
      throw Error(fmt::format("shard {}/{} is missing", i, count));
  return all;
}

}  // namespace kage::cli
