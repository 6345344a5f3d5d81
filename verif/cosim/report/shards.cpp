// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/shards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "cosim/report/record_keys.hpp"
#include "json/foreign_json.hpp"
#include "kage/cosim.hpp"
#include "kage/error.hpp"

namespace kage::report {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw Error(fmt::format("{}: no report of kage cosim: {}", file, why));
}

/// Throws Error unless the number is within limits.
void check_range(const std::string& file, const char* key, int number, int least, int most) {
  if (number < least || number > most) refuse(file, fmt::format("{} is not what it should be", key));
}

/// Throws Error unless the record of a scene before which others have so many frames tells of the frames that the shard
/// has of it: all, or those up to the one that differs.
void check_frames(const ShardFile& f, const SceneRecord& s, std::int64_t before) {
  const cosim::Shard shard{f.number.index, f.number.count, true};
  const cosim::FrameSteps steps{shard.first(before), shard.count};
  check_range(f.file, "total_frames", s.total_frames, 1, cosim::kMostFrames);
  const int own = shard.frames(s.total_frames, before);
  check_range(f.file, "frames", s.frames, own == 0 ? 0 : 1, cosim::kMostFrames);
  const auto wrong = [&] {
    throw Error(fmt::format("{}: shard {}/{} of {} frames cannot have the {} that it claims", f.file, f.number.index,
                            f.number.count, s.total_frames, s.frames));
  };
  if (s.frames > own) wrong();
  if (own == 0) return;
  if (s.frame_step != steps.step || s.first_frame != steps.first || (s.same && s.frames < own) ||
      s.frame_seconds.size() != static_cast<std::size_t>(s.frames) ||
      (s.first_difference &&
       (s.first_difference->frame ? *s.first_difference->frame != steps.first + (s.frames - 1) * steps.step
                                  : s.frames < own)))
    wrong();
  for (const auto& seconds : s.frame_seconds)
    if (!seconds) refuse(f.file, "frame_seconds is not what it should be");
  // Each of them once, in order.
  int last = -1;
  for (const FrameRecord& frame : s.each) {
    const int n = frame.frame;
    if (n <= last || n % steps.step != steps.first || n > steps.first + std::int64_t{s.frames - 1} * steps.step)
      throw Error(
          fmt::format("{}: frame {} is there twice or is not of shard {}/{}", f.file, n, shard.index, shard.count));
    last = n;
  }
  for (const int n : s.verdicts.taken_frames) check_range(f.file, "taken_frames", n, 0, cosim::kMostFrames - 1);
}

ShardFile read(const std::string& file) {
  const Json json = read_json(file);
  ShardFile f;
  f.file = file;
  try {
    f.record = RunRecord::from_json(json);
  } catch (const Error& e) {
    refuse(file, e.what());
  }
  const auto& shard = f.record.any().shard;
  if (!shard) throw Error(fmt::format("{}: the report of all frames, not of a shard (--shard)", file));
  f.number = *shard;
  check_range(file, "count", f.number.count, 1, cosim::kMostFrames);
  check_range(file, "index", f.number.index, 1, f.number.count);
  return f;
}

void check_frames(const ShardFile& f) {
  std::int64_t before = 0;
  for (const SceneRecord& s : f.record.scenes) {
    check_frames(f, s, before);
    before += s.total_frames;
  }
}

/// Throws Error, naming the first of them, where options differ.
struct SameOptions {
  const ShardFile& f;
  const OptionsRecord& own;
  const ShardFile& other;
  const OptionsRecord& others;

  template <class Value>
  void operator()(const char* name, Value OptionsRecord::*option) const {
    if (own.*option != others.*option)
      throw Error(fmt::format("{}: its option {} is {}, that of {} is {}", f.file, name, text(own.*option), other.file,
                              text(others.*option)));
  }

 private:
  static std::string text(const std::string& value) { return value.empty() ? "not given" : value; }
  template <class Number>
  static std::string text(Number value) {
    return fmt::format("{}", value);
  }
};

/// Throws Error unless the file is of the same run as those read before it.
void check_alike(const ShardFile& f, const std::vector<ShardFile>& before) {
  const ShardFile& first = before.front();
  const auto& scenes = f.record.scenes;
  if (scenes.size() != first.record.scenes.size() || f.record.several != first.record.several)
    throw Error(fmt::format("{}: its scenes are not those of {}", f.file, first.file));
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const SceneRecord& s = scenes[i];
    const auto same = [&](const char* what, const ShardFile& other, auto member) {
      if (s.*member != other.record.scenes[i].*member)
        throw Error(fmt::format("{}: its {} is not that of {}", f.file, what, other.file));
    };
    using R = SceneRecord;
    same("scene", first, &R::scene);
    same("total_frames", first, &R::total_frames);
    const auto other =
        std::find_if(before.begin(), before.end(), [&](const ShardFile& b) { return b.record.scenes[i].frames != 0; });
    if (s.frames == 0 || other == before.end()) continue;
    // Width and height are those of the shard's largest frame: of frames of any size they say nothing.
    same("own_sizes", *other, &R::own_sizes);
    if (!s.own_sizes) {
      same("width", *other, &R::width);
      same("height", *other, &R::height);
    }
    same("config", *other, &R::config);
    same("seed", *other, &R::seed);
    const SameOptions same_option{f, s.options, *other, other->record.scenes[i].options};
    keys(same_option, Of<OptionsRecord>());
    same("degraded", *other, &R::degraded);
  }
  if (f.number.count != first.number.count)
    throw Error(
        fmt::format("{}: one of {} shards, {} one of {}", f.file, f.number.count, first.file, first.number.count));
}

}  // namespace

std::vector<ShardFile> read_shards(const std::vector<std::string>& files, const std::function<void()>& wait) {
  std::vector<ShardFile> all;
  for (const std::string& file : files) {
    wait();
    ShardFile f = read(file);
    if (!all.empty()) check_alike(f, all);
    check_frames(f);
    all.push_back(std::move(f));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const ShardFile& a, const ShardFile& b) { return a.number.index < b.number.index; });
  const int count = all.front().number.count;
  for (std::size_t i = 1; i < all.size(); ++i)
    if (all[i].number.index == all[i - 1].number.index)
      throw Error(
          fmt::format("{}: shard {}/{} once more, as {}", all[i].file, all[i].number.index, count, all[i - 1].file));
  for (int i = 1; i <= count; ++i)
    if (i > static_cast<int>(all.size()) || all[static_cast<std::size_t>(i) - 1].number.index != i)
      throw Error(fmt::format("shard {}/{} is missing", i, count));
  return all;
}

}  // namespace kage::report
