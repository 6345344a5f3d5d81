// SPDX-License-Identifier: Apache-2.0
#include "sweep_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>

#include "command.hpp"
#include "signals.hpp"
#include "standard_files.hpp"
#include "text.hpp"
#include "workers.hpp"

namespace kage::cli {
namespace {

Json look_json(const trade::SweepPoint& p) {
  return {{"width", p.width},
          {"height", p.height},
          {"sub_bits", p.look.sub_bits},
          {"samples", p.look.samples},
          {"samples_drawn", trade::samples_of(p)},
          {"classes", p.look.classes},
          {"order", name_of(p.look.translucent)},
          {"seed", p.look.seed}};
}

/// A scene's name as rows, pages and plots have it: what of it is no UTF-8 is replaced, as in every JSON.
std::string readable(const std::string& name) {
  return Json::parse(Json(name).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

Json row_of(const SweptScene& s, std::size_t point, const Json& measured) {
  const trade::SweepPoint& p = s.points[point];
  Json row;
  row["scene"] = readable(s.scene->name());
  row["axis"] = p.axis;
  row["value"] = p.value;
  row["frames"] = s.scene->frames();
  row["look"] = look_json(p);
  row["config"] = cli::to_json(p.config);
  for (const char* key : {"accuracy", "speed", "area"}) row[key] = measured.at(key);
  return row;
}

}  // namespace

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
  progress_.clear();
}

void Told::show() {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  std::string left;
  if (made_ > 0) {
    const double rest = seconds / static_cast<double>(made_) * static_cast<double>(runs_ - done_);
    left = rest < 90 ? fmt::format(", {:.0f} s left", rest) : fmt::format(", {:.0f} min left", rest / 60);
  }
  progress_.show(
      fmt::format("sweep: {} of {}{}{}{}", done_, counted(runs_, "run"), left, what_.empty() ? "" : "; ", what_));
}

Sweep::Sweep(const SweepCommand& o, const Tools& tools, std::vector<SweptScene>& scenes, trade::SweepStore& store,
             Told& told)
    : o_(o),
      scenes_(scenes),
      store_(store),
      told_(told),
      build_(trade::build_identity(build_name())),
      model_tools_(tools.versions.model) {
  for (SweptScene& s : scenes_)
    s.runner->keep_clocks = [this, &s](std::size_t point, const trade::ClockSample& sample) {
      store_.keep_clocks(clocks_key(s, point), sample);
    };
}

void Sweep::announce_old(const std::vector<Entry>& entries) {
  std::map<std::string, std::size_t> counts;
  for (const Entry& e : entries) {
    const SweptScene& s = scenes_[e.scene];
    const std::string other = store_.old(s.scene->name(), trade::text_of(s.points[e.point]), made_of(s, e.point));
    if (!other.empty()) ++counts[other];
  }
  for (const auto& [other, count] : counts)
    say(fmt::format("kage: {} measured anew, because {} has {} of {}\n", counted(count, "row is", "rows are"), o_.store,
                    count == 1 ? "it" : "them", other));
}

void Sweep::run(std::vector<Entry>& entries) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  std::mutex error_mutex;
  {
    const Workers workers(std::min(jobs_of(o_), static_cast<int>(entries.size())), [&] {
      for (std::size_t i = next++; i < entries.size(); i = next++) {
        try {
          make(entries[i]);
        } catch (...) {
          const std::lock_guard lock(error_mutex);
          if (!error) error = std::current_exception();
          next = entries.size();
        }
      }
    });
    if (workers.count() == 0)
      for (std::size_t i = next++; i < entries.size(); i = next++) make(entries[i]);
  }
  told_.clear();
  if (error) std::rethrow_exception(error);
}

std::string Sweep::clocks_key(const SweptScene& s, std::size_t point) const {
  return trade::key_of({build_, "clocks", s.scene->identity(), std::to_string(s.scene->frames()),
                        trade::text_of(s.points[point]), model_tools_});
}

std::string Sweep::row_key(const SweptScene& s, std::size_t point, const trade::PointWords& words) const {
  return trade::key_of({kRows, build_, s.scene->name(), s.scene->identity(), std::to_string(s.scene->frames()),
                        trade::text_of(s.points[point]), trade::text_of(s.scene->finest(s.points[point])), words.hash,
                        s.runner->clocks_text(point), o_.no_area ? "estimated" : "counted",
                        o_.no_flip ? "no flip" : "flip", s.runner->tools_text(point)});
}

trade::MadeOf Sweep::made_of(const SweptScene& s, std::size_t point) const {
  return {.build = build_, .scene = s.scene->identity(), .tools = s.runner->tools_text(point)};
}

void Sweep::make(Entry& e) {
  check_interrupt();
  SweptScene& s = scenes_[e.scene];
  const trade::PointWords words = s.runner->words(e.point);
  const std::string key = row_key(s, e.point, words);
  if (const auto kept = store_.run(key)) {
    e.row = row_of(s, e.point, Json::parse(*kept));
    told_.done(false);
    return;
  }
  const std::size_t stands = s.runner->representative(e.point);
  if (const auto clocks = store_.clocks(clocks_key(s, stands))) s.runner->know_clocks(stands, *clocks);
  const Json measured = s.runner->run(e.point, words);
  store_.keep_run(key, s.scene->name(), trade::text_of(s.points[e.point]), made_of(s, e.point), measured.dump());
  e.row = row_of(s, e.point, measured);
  told_.done(true);
}

}  // namespace kage::cli
