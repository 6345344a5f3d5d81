// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <functional>
#include <utility>

#include "cosim/report/joined.hpp"
#include "cosim/session/workers.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"

namespace kage::cosim {
namespace {

/// With the inputs that there are.
CosimOptions with_inputs(CosimOptions o) {
  if (o.inputs.empty()) o.inputs = {o.input};
  return o;
}

}  // namespace

Session::Session(const CosimOptions& options, Host& host, Cores& cores) : options_(with_inputs(options)), host_(host) {
  std::int64_t frames = 0;
  int own = 0;
  for (const std::string& input : options_.inputs) {
    host_.check();
    CosimOptions with_input = options_;
    with_input.input = input;
    auto scene = std::make_unique<SceneRun>(with_input, host_, cores, frames);
    const std::string& name = scene->source().name();
    for (const auto& other : scenes_)
      if (other->source().name() == name)
        throw Error(fmt::format("{}: a scene called {} is there already: {}", input, name, other->options().input));
    frames += scene->total();
    own += scene->frames();
    scenes_.push_back(std::move(scene));
  }
  if (own == 0)
    throw Error(fmt::format("--shard {}/{}: {} {} only {}", options_.shard.index, options_.shard.count,
                            scenes_.size() == 1 ? scenes_.front()->source().name() : "the scenes",
                            scenes_.size() == 1 ? "has" : "have", counted(frames, "frame")));
}

void Session::compare() {
  const int jobs = options_.jobs > 0 ? options_.jobs : default_jobs();
  // Jobs that have no scene of their own share one: its frames go to as many ranges.
  const int ranges = (jobs + static_cast<int>(scenes_.size()) - 1) / static_cast<int>(scenes_.size());
  std::vector<std::function<void()>> work;
  for (const auto& scene : scenes_) {
    scene->prepare(ranges);
    for (int i = 0; i < scene->ranges(); ++i) work.emplace_back([&scene, i] { scene->run(i); });
  }
  std::atomic<std::size_t> next{0};
  const auto worker = [&] {
    for (std::size_t i = next++; i < work.size(); i = next++) work[i]();
  };
  const Workers others(static_cast<int>(std::min(work.size(), static_cast<std::size_t>(jobs))) - 1, worker);
  worker();
}

/// Writes the page over all scenes; its name, or nothing: the verdict stands without it.
std::optional<std::string> Session::joined_page(const report::RunRecord& record, TempFiles& files) {
  std::string page = (std::filesystem::path(options_.out) / "report.html").string();
  SceneRun& last = *scenes_.back();
  try {
    report::write_joined_page(files, page, record, [this] { host_.check(); });
    return page;
  } catch (const Interrupted&) {
    last.interrupt();
    last.note("interrupted after the verdict");
  } catch (const std::exception& e) {
    last.note(fmt::format("no report over all scenes was written: {}", e.what()));
  }
  return std::nullopt;
}

report::RunRecord Session::finish(TempFiles& files) {
  report::RunRecord record;
  record.several = scenes_.size() > 1;
  for (const auto& scene : scenes_) {
    record.scenes.push_back(scene->finish(files));
    if (scene->interrupted() && scene != scenes_.back()) throw Interrupted{};
  }
  if (record.several && !options_.no_report && !options_.out.empty()) record.page = joined_page(record, files);
  return record;
}

}  // namespace kage::cosim
