// SPDX-License-Identifier: Apache-2.0
// The records of shards as that of the run that they are parts of.
#include <algorithm>

#include "cosim/report/shards.hpp"
#include "kage/cosim.hpp"

namespace kage::report {
namespace {

/// Adds the entries that are not there yet.
void unite(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const std::string& text : more)
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
}

/// In the order of frames; nothing for those that were not compared.
void take_seconds(SceneRecord& all, const SceneRecord& s) {
  all.frame_seconds.resize(static_cast<std::size_t>(all.total_frames));
  auto frame = static_cast<std::size_t>(s.first_frame);
  for (const auto& seconds : s.frame_seconds) {
    all.frame_seconds[frame] = seconds;
    frame += static_cast<std::size_t>(s.frame_step);
  }
}

void take_verdicts(VerdictsRecord& all, const VerdictsRecord& v) {
  all.cached = all.cached || v.cached;
  all.taken_frames.insert(all.taken_frames.end(), v.taken_frames.begin(), v.taken_frames.end());
  all.kept += v.kept;
  if (!all.trouble) all.trouble = v.trouble;
}

/// A point that one shard reaches and another does not is reached.
void take_coverage(std::optional<CoverageRecord>& all, const CoverageRecord& c) {
  if (!all) all.emplace();
  all->frames += c.frames;
  for (const CoveragePointRecord& p : c.points) {
    const auto same = [&](const CoveragePointRecord& q) { return q.group == p.group && q.name == p.name; };
    const auto found = std::find_if(all->points.begin(), all->points.end(), same);
    if (found == all->points.end())
      all->points.push_back(p);
    else
      found->frames += p.frames;
  }
}

/// All shards' records of a scene as the record of one run. Polyhedra, which each shard tells of in its own frames,
/// stay with it, in `shards`.
SceneRecord joined(const std::vector<ShardFile>& shards, std::size_t scene) {
  SceneRecord all;
  const SceneRecord& any = *scene_of_shards(shards, scene).front();
  all.joined = true;
  all.scene = any.scene;
  all.total_frames = any.total_frames;
  all.own_sizes = any.own_sizes;
  all.options = any.options;
  all.config_name = any.config_name;
  all.config = any.config;
  all.seed = any.seed;
  all.degraded = any.degraded;
  for (const ShardFile& shard : shards) {
    const SceneRecord& s = shard.record.scenes[scene];
    if (s.frames == 0) continue;
    all.same = all.same && s.same;
    all.frames += s.frames;
    all.sizes_vary = all.sizes_vary || s.sizes_vary || s.width != any.width || s.height != any.height;
    all.width = std::max(all.width, s.width);
    all.height = std::max(all.height, s.height);
    all.pixels_compared += s.pixels_compared;
    all.spans += s.spans;
    all.span_pixels += s.span_pixels;
    all.segments += s.segments;
    all.units = std::max(all.units, s.units);
    all.cycles += s.cycles;
    all.stalls.starved += s.stalls.starved;
    all.stalls.blocked += s.stalls.blocked;
    take_seconds(all, s);
    all.each.insert(all.each.end(), s.each.begin(), s.each.end());
    take_verdicts(all.verdicts, s.verdicts);
    if (s.coverage) take_coverage(all.coverage, *s.coverage);
    all.golden_seconds += s.golden_seconds;
    all.rtl_seconds += s.rtl_seconds;
    all.build_seconds += s.build_seconds;
    unite(all.versions, s.versions);
    unite(all.pictures, s.pictures);
    unite(all.notes, s.notes);
    const auto& d = s.first_difference;
    // A difference of the register check, which has no frame, comes behind those of all frames.
    const auto place = [](const DifferenceRecord& of) { return of.frame.value_or(cosim::kMostFrames); };
    if (d && (!all.first_difference || place(*d) < place(*all.first_difference))) all.first_difference = d;
    ShardRecord& own = all.shards.emplace_back();
    static_cast<PartRecord&>(own) = static_cast<const PartRecord&>(s);
    own.number = shard.number;
    own.file = shard.file;
  }
  std::sort(all.each.begin(), all.each.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
  std::sort(all.verdicts.taken_frames.begin(), all.verdicts.taken_frames.end());
  return all;
}

}  // namespace

std::vector<const SceneRecord*> scene_of_shards(const std::vector<ShardFile>& shards, std::size_t scene) {
  std::vector<const SceneRecord*> parts;
  for (const ShardFile& s : shards)
    if (s.record.scenes[scene].frames != 0) parts.push_back(&s.record.scenes[scene]);
  return parts;
}

RunRecord joined_record(const std::vector<ShardFile>& shards) {
  RunRecord all;
  all.merged = true;
  all.several = shards.front().record.several;
  for (std::size_t i = 0; i < shards.front().record.scenes.size(); ++i) all.scenes.push_back(joined(shards, i));
  return all;
}

}  // namespace kage::report
