// SPDX-License-Identifier: Apache-2.0
// kage cosim SCENE...: golden model against RTL, frame by frame.
#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "ci.hpp"
#include "common.hpp"
#include "cosim/lock.hpp"
#include "cosim_run.hpp"
#include "joined.hpp"
#include "kage/error.hpp"

namespace kage::cli {
namespace {

/// Where the pictures are; after a difference, which to look at.
std::string pictures_of(const Json& report, const std::string& folder) {
  const auto last = report["pictures"].back().get<std::string>();
  if (report["same"].get<bool>()) return folder;
  return last + (last.ends_with("_difference.png") ? ", with _expected and _actual beside it" : "");
}

using Scenes = std::vector<std::unique_ptr<SceneRun>>;

/// Opens all scenes, so that what cannot be read is found before the work.
Scenes open(const CosimCommand& o) {
  Scenes scenes;
  std::int64_t frames = 0;
  int own = 0;
  for (const std::string& input : o.inputs) {
    check_interrupt();
    CosimCommand with_input = o;
    with_input.input = input;
    auto scene = std::make_unique<SceneRun>(with_input, frames);
    const std::string& name = scene->source().name();
    for (const auto& other : scenes)
      if (other->source().name() == name)
        throw Error(fmt::format("{}: a scene called {} is there already: {}", input, name, other->command().input));
    frames += scene->total();
    own += scene->frames();
    scenes.push_back(std::move(scene));
  }
  if (own == 0)
    throw Error(fmt::format("--shard {}/{}: {} {} only {}", o.ci.shard.index, o.ci.shard.count,
                            scenes.size() == 1 ? scenes.front()->source().name() : "the scenes",
                            scenes.size() == 1 ? "has" : "have", counted(frames, "frame")));
  return scenes;
}

/// Compares all frames of all scenes, on so many threads.
void compare(const Scenes& scenes, int jobs) {
  // Jobs that have no scene of their own share one: its frames go to as many ranges.
  const int ranges = (jobs + static_cast<int>(scenes.size()) - 1) / static_cast<int>(scenes.size());
  std::vector<std::function<void()>> work;
  for (const auto& scene : scenes) {
    scene->prepare(ranges);
    for (int i = 0; i < scene->ranges(); ++i) work.emplace_back([&scene, i] { scene->run(i); });
  }
  std::atomic<std::size_t> next{0};
  const auto worker = [&] {
    for (std::size_t i = next++; i < work.size(); i = next++) work[i]();
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < std::min(work.size(), static_cast<std::size_t>(jobs)); ++i) threads.emplace_back(worker);
  worker();
  for (std::thread& t : threads) t.join();
}

void print_difference(const Json& d) {
  fmt::print("first difference: {}\n", d["text"].get<std::string>());
  const Json& by = d["divergence"];
  if (!by.is_null()) {
    fmt::print("first divergence: {}\n", by["text"].get<std::string>());
    if (!d["waveform"].is_null())
      fmt::print("waveform: {}; {}\n", d["waveform"].get<std::string>(),
                 gtkwave_line(by["save_file"].get<std::string>()));
  } else if (!d["no_divergence"].is_null()) {
    fmt::print("{}\n", d["no_divergence"].get<std::string>());
  }
}

/// The frame that was kept, and how to run it again.
void print_kept(const Json& kept) {
  const auto number = [&](const char* key) { return kept[key].get<std::uint64_t>(); };
  fmt::print("the frame: {}: {}, {}, {} wide, {} of {}\n", kept["file"].get<std::string>(),
             counted(number("lines"), "line"), counted(number("tokens"), "token"), counted(number("width"), "pixel"),
             number("words"), counted(number("words_before"), "word"));
  if (kept["alone"].get<bool>())
    fmt::print("again: {}\n", kept["again"].get<std::string>());
  else
    fmt::print("alone, on a new core, it comes out the same: it takes the frames before it, or stalls of its place\n");
}

/// What the frames reached, and what none did.
void print_coverage(const Json& coverage) {
  const auto frames = coverage["frames"].get<std::uint64_t>();
  std::string group;
  for (const Json& p : coverage["points"]) {
    if (p["group"] != group) fmt::print("{}:\n", group = p["group"].get<std::string>());
    const auto hits = p["frames"].get<std::uint64_t>();
    fmt::print("  {:<50} {}\n", p["name"].get<std::string>(),
               hits == 0 ? std::string("not reached")
                         : fmt::format("{} of {} ({:.1f} %)", hits, counted(frames, "frame"),
                                       100.0 * static_cast<double>(hits) / static_cast<double>(frames)));
  }
}

/// The first line of a report. `who` begins it.
void print_verdict(const Json& j, const std::string& who) {
  const auto number = [&](const char* key) { return j[key].get<std::uint64_t>(); };
  fmt::print("{}{}: {}, {}x{}, {} compared, {}{}, {}, golden {:.3f} s, RTL {:.3f} s, seed {}\n", who,
             j["same"].get<bool>() ? "same" : "different", counted(number("frames"), "frame"), number("width"),
             number("height"), counted(number("pixels_compared"), "pixel"), counted(number("spans"), "span"),
             and_segments(number("segments")), counted(number("cycles"), "cycle"), j["golden_seconds"].get<double>(),
             j["rtl_seconds"].get<double>(), number("seed"));
}

void print_report(const Json& j, const std::string& who, const std::string& folder) {
  if (!has_frames(j)) {
    fmt::print("{}no frame in this shard\n", who);
    return;
  }
  print_verdict(j, who);
  if (j.contains("coverage")) print_coverage(j["coverage"]);
  if (!j["same"].get<bool>()) print_difference(j["first_difference"]);
  if (const Json& kept = j["kept"]; !kept.is_null()) print_kept(kept);
  if (!j["pictures"].empty()) fmt::print("pictures: {}\n", pictures_of(j, folder));
  if (!j["report"].is_null()) fmt::print("report: {}\n", j["report"].get<std::string>());
}

/// Writes the page over all scenes; its name, or nothing: the verdict stands without it.
std::string joined_page(const CosimCommand& o, const Json& j, SceneRun& last, TempFiles& files) {
  std::string page = (std::filesystem::path(o.out) / "report.html").string();
  try {
    write_joined_page(files, page, j);
    return page;
  } catch (const Interrupted&) {
    last.interrupt();
    last.note("interrupted after the verdict");
  } catch (const std::exception& e) {
    last.note(fmt::format("no report over all scenes was written: {}", e.what()));
  }
  return {};
}

int run(const CosimCommand& o) {
  const OutFolder folder(o.out);
  std::optional<cosim::Lock> lock;
  if (!o.no_report && !o.out.empty()) lock.emplace(o.out, O_RDONLY | O_DIRECTORY);
  // Where the file system knows no locks nothing is kept out.
  if (lock && !lock->try_lock() && errno == EWOULDBLOCK)
    throw Error(
        fmt::format("{}: another run writes its report there: give one of them a folder of its own by --out", o.out));
  check_json(o);
  refuse_twice({o.json == "-" ? "" : o.json, o.ci.junit,
                o.no_report || o.out.empty() ? "" : (std::filesystem::path(o.out) / "report.html").string()});
  const Scenes scenes = open(o);
  const bool several = scenes.size() > 1;
  compare(scenes, o.jobs > 0 ? o.jobs : default_jobs());
  TempFiles files;
  JUnitWriter junit(files, o.ci.junit, "kage cosim");
  std::vector<Json> reports;
  for (const auto& scene : scenes) {
    reports.push_back(scene->finish(files));
    if (scene->interrupted() && scene != scenes.back()) throw Interrupted{};
  }
  const auto who = [&](const Json& r) { return several ? r["scene"].get<std::string>() + ": " : std::string(); };
  Json j = several ? all_scenes(reports) : reports.front();
  std::string page;
  if (several && !o.no_report && !o.out.empty()) page = joined_page(o, j, *scenes.back(), files);
  if (several) j["report"] = page.empty() ? Json(nullptr) : Json(page);
  try {
    for (const Json& r : reports)
      if (has_frames(r)) junit_frames(junit, {&r});
    junit.close();
    write_json(o, j, files);
  } catch (const Error&) {
    // No file of the run appears, but what it found is told.
    for (const Json& r : reports)
      if (has_frames(r) && !json_only(o)) print_verdict(r, who(r));
    throw;
  }
  const bool same = j["same"].get<bool>();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (const std::string& note : scenes[i]->notes()) fmt::print(json_only(o) ? stderr : stdout, "{}\n", note);
    if (!json_only(o)) print_report(reports[i], who(reports[i]), scenes[i]->command().out);
    if (has_frames(reports[i])) annotate_difference(o.ci.annotate, reports[i], json_only(o) ? stderr : stdout);
  }
  if (several && !json_only(o))
    fmt::print("{}: {}, {} of {}, {} compared, {}, seed {}\n", same ? "same" : "different",
               counted(scenes.size(), "scene"), counted(j["frames"].get<std::uint64_t>(), "frame"),
               j["total_frames"].get<std::uint64_t>(), counted(j["pixels_compared"].get<std::uint64_t>(), "pixel"),
               counted(j["cycles"].get<std::uint64_t>(), "cycle"), o.seed);
  if (several && !json_only(o) && !page.empty()) fmt::print("report: {}\n", page);
  if (scenes.back()->interrupted()) return interrupted_code();
  return same ? kSame : kDifferent;
}

}  // namespace

void add_cosim(CLI::App& app, Action& action) {
  CLI::App* c = add_command(
      app, "cosim", "Send every frame through golden model and RTL and compare every pixel",
      "  kage cosim courtyard\n"
      "  kage cosim model.glb --size 320x240 --frames 2 --config full --out pictures\n"
      "  kage cosim courtyard.kage --json -\n"
      "  kage cosim courtyard --fault wrong_compare\n"
      "  kage cosim courtyard penumbra glass --size 160x120\n"
      "  kage cosim random:mixed --frames 1000 --seed 5 --config glass --coverage\n"
      "  kage cosim courtyard --shard 2/4 --junit cosim-2.xml --json cosim-2.json   (then kage merge)\n"
      "The RTL model of a configuration is built on first use, and anew when the RTL has changed; it is kept in\n"
      "~/.cache/kage/models. All files of a run appear together at its end: the pictures and DIR/report.html, which\n"
      "has verdict, frames, clocks, and the history of each pixel that is clicked (docs/report.md). Of several scenes\n"
      "each has its own folder in DIR, and DIR/report.html is over all; a difference ends its scene, not the others.\n"
      "Exit code 0: the same. 1: different; expected, actual and difference pictures are in the folder. 2: trouble.");
  const auto o = std::make_shared<CosimCommand>();
  o->out = "out";
  option_scenes(*c, o->inputs);
  c->add_option("--out", o->out, "folder for pictures and report.html, default out")->type_name("DIR");
  options_of_frames(*c, *o);
  option_json(*c, *o);
  option_rtl(*c, o->rtl);
  c->add_option("--jobs", o->jobs,
                "RTL models at a time, each with frames of its own; default one per processor, within half of the\n"
                "memory at 256 MiB a job. What is found does not depend on it, but for what only a history of more\n"
                "than one frame shows: --jobs 1 has it")
      ->check(whole_number(1, 4096))
      ->type_name("N");
  c->add_flag("--no-divergence", o->no_divergence,
              "after a difference do not run the frame again to find the stage that differs first");
  option_shard(*c, o->ci.shard);
  option_junit(*c, o->ci.junit);
  option_annotate(*c, o->ci.annotate);
  c->add_option("--frame", o->frame, "only this frame of each scene, on a core that has seen none before it")
      ->check(whole_number(0, kMostFrames - 1))
      ->type_name("K");
  c->add_flag("--no-shrink", o->no_shrink,
              "keep a random frame that comes out different as it is, not as small as it can be made in a minute");
  c->add_flag("--coverage", o->coverage, "print what the frames reach: tokens, borders and extremes of fields, errors");
  c->add_flag("--no-report", o->no_report, "write no report.html");
  o->command = c;
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
