// SPDX-License-Identifier: Apache-2.0
#include "explore/sweep_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>

#include "cosim/session/option_names.hpp"
#include "cosim/session/workers.hpp"
#include "json/foreign_json.hpp"
#include "json/json_text.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"

namespace kage::explore {
namespace {

report::Json look_json(const SweepPoint& p) {
  return {{"width", p.width},
          {"height", p.height},
          {"sub_bits", p.look.sub_bits},
          {"samples", p.look.samples},
          {"samples_drawn", samples_of(p)},
          {"classes", p.look.classes},
          {"max_shading", p.look.max_shading},
          {"order", cosim::name_of(p.look.translucent)},
          {"seed", p.look.seed}};
}

/// A scene's name as rows, pages and plots have it: what of it is no UTF-8 is replaced, as in every JSON.
std::string readable(const std::string& name) {
  return parse_json<report::Json>(json_text(report::Json(name)), name).get<std::string>();
}

report::Json row_of(const SweptScene& s, std::size_t point, const report::Json& measured) {
  const SweepPoint& p = s.points[point];
  report::Json row;
  row["scene"] = readable(s.scene->name());
  row["axis"] = p.axis;
  row["value"] = p.value;
  row["frames"] = s.scene->frames();
  row["look"] = look_json(p);
  row["config"] = report::to_json(p.config);
  for (const char* key : {"accuracy", "speed", "area"}) row[key] = measured.at(key);
  return row;
}

}  // namespace

void Told::begin(std::size_t steps, const std::string& one, const std::string& more) {
  const std::lock_guard lock(mutex_);
  steps_name_ = counted(steps, one, more);
  steps_ = steps;
  done_ = made_ = 0;
  what_.clear();
  start_ = std::chrono::steady_clock::now();
}

void Told::doing(const std::string& what) {
  const std::lock_guard lock(mutex_);
  what_ = what;
  show();
}

void Told::done(bool made) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (made) ++made_;
  show();
}

void Told::clear() {
  const std::lock_guard lock(mutex_);
  progress_->clear();
}

void Told::show() {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  std::string left;
  if (made_ > 0) {
    const double rest = seconds / static_cast<double>(made_) * static_cast<double>(steps_ - done_);
    left = rest < 90 ? fmt::format(", {:.0f} s left", rest) : fmt::format(", {:.0f} min left", rest / 60);
  }
  progress_->show(fmt::format("sweep: {} of {}{}{}{}", done_, steps_name_, left, what_.empty() ? "" : "; ", what_));
}

Sweep::Sweep(const SweepOptions& o, const Tools& tools, std::vector<SweptScene>& scenes, SweepStore& store, Told& told,
             cosim::Host& host)
    : o_(o),
      scenes_(scenes),
      store_(store),
      told_(told),
      host_(host),
      build_(build_identity(o.build)),
      model_tools_(tools.versions.model) {
  for (SweptScene& s : scenes_)
    s.runner->keep_clocks = [this, &s](std::size_t point, const ClockSample& sample) {
      store_.keep_clocks(clocks_key(s, point), sample);
    };
}

void Sweep::announce_old(const std::vector<Entry>& entries) {
  std::map<std::string, std::size_t> counts;
  for (const Entry& e : entries) {
    const SweptScene& s = scenes_[e.scene];
    const std::string other = store_.old(s.scene->name(), text_of(s.points[e.point]), made_of(s, e.point));
    if (!other.empty()) ++counts[other];
  }
  for (const auto& [other, count] : counts)
    host_.say(fmt::format("kage: {} measured anew, because {} has {} of {}\n", counted(count, "row is", "rows are"),
                          o_.store, count == 1 ? "it" : "them", other));
}

void Sweep::run(std::vector<Entry>& entries) {
  // Cores take minutes of all processors, and a run that measures time wants the machine for itself: so the cores are
  // made first, or each run would wait for the core of another.
  const bool cores = std::any_of(entries.begin(), entries.end(),
                                 [&](const Entry& e) { return scenes_[e.scene].runner->needs_core(e.point); });
  if (cores) {
    told_.begin(entries.size(), "run's core", "runs' cores");
    each(entries, [this](Entry& e) { prepare(e); });
  }
  told_.begin(entries.size(), "run", "runs");
  each(entries, [this](Entry& e) { make(e); });
  told_.clear();
}

void Sweep::each(std::vector<Entry>& entries, const std::function<void(Entry&)>& work) const {
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  std::mutex error_mutex;
  {
    const cosim::Workers workers(std::min(jobs_of(o_), static_cast<int>(entries.size())), [&] {
      for (std::size_t i = next++; i < entries.size(); i = next++) {
        try {
          work(entries[i]);
        } catch (...) {
          const std::lock_guard lock(error_mutex);
          if (!error) error = std::current_exception();
          next = entries.size();
        }
      }
    });
    if (workers.count() == 0)
      for (std::size_t i = next++; i < entries.size(); i = next++) work(entries[i]);
  }
  if (!error) return;
  told_.clear();
  std::rethrow_exception(error);
}

std::string Sweep::clocks_key(const SweptScene& s, std::size_t point) const {
  return key_of({build_, "clocks", s.scene->identity(), std::to_string(s.scene->frames()), text_of(s.points[point]),
                 model_tools_});
}

std::string Sweep::row_key(const SweptScene& s, std::size_t point, const PointWords& words) const {
  return key_of({kRows, build_, s.scene->name(), s.scene->identity(), std::to_string(s.scene->frames()),
                 text_of(s.points[point]), text_of(s.scene->finest(s.points[point])), words.hash,
                 s.runner->clocks_text(point), o_.no_area ? "estimated" : "counted", o_.no_flip ? "no flip" : "flip",
                 s.runner->tools_text(point)});
}

MadeOf Sweep::made_of(const SweptScene& s, std::size_t point) const {
  return {.build = build_, .scene = s.scene->identity(), .tools = s.runner->tools_text(point)};
}

Sweep::Place Sweep::place_of(const Entry& e) {
  host_.check();
  SweptScene& s = scenes_[e.scene];
  Place place;
  place.words = s.runner->words(e.point);
  place.key = row_key(s, e.point, place.words);
  place.kept = store_.run(place.key);
  const std::size_t stands = s.runner->representative(e.point);
  if (!place.kept)
    if (const auto clocks = store_.clocks(clocks_key(s, stands))) s.runner->know_clocks(stands, *clocks);
  return place;
}

bool Sweep::take_kept(Entry& e, const Place& place) const {
  if (!place.kept) return false;
  const std::string name = fmt::format("{}: table run, row {}", o_.store, place.key);
  try {
    e.row = row_of(scenes_[e.scene], e.point, parse_json<report::Json>(*place.kept, name));
  } catch (const report::Json::exception&) {
    throw Error(fmt::format("{}: not what a row of this kage has", name));
  }
  return true;
}

void Sweep::prepare(Entry& e) {
  const bool kept = take_kept(e, place_of(e));
  if (!kept) scenes_[e.scene].runner->prepare(e.point);
  told_.done(!kept);
}

void Sweep::make(Entry& e) {
  if (!e.row.is_null()) {  // prepare() found it in the store
    told_.done(false);
    return;
  }
  SweptScene& s = scenes_[e.scene];
  const Place place = place_of(e);
  if (take_kept(e, place)) {
    told_.done(false);
    return;
  }
  const report::Json measured = s.runner->run(e.point, place.words);
  store_.keep_run(place.key, s.scene->name(), text_of(s.points[e.point]), made_of(s, e.point), json_text(measured));
  ++measured_;
  e.row = row_of(s, e.point, measured);
  told_.done(true);
}

}  // namespace kage::explore
