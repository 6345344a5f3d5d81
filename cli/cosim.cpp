// SPDX-License-Identifier: Apache-2.0
// kage cosim SCENE: golden model against RTL, frame by frame.
#include <fmt/format.h>

#include <memory>

#include "ci.hpp"
#include "common.hpp"
#include "cosim/divergence.hpp"
#include "cosim/model.hpp"
#include "cosim/rtl.hpp"
#include "cosim/run.hpp"
#include "kage/error.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "source.hpp"

namespace kage::cli {
namespace {

struct CosimCommand : Options {
  std::string fault;
  bool no_divergence = false;
  cosim::RtlOptions rtl;
  CiOptions ci;
  bool no_report = false;
  const CLI::App* command = nullptr;
};

/// What decides words and clocks besides scene, size, configuration and seed.
Json options_of(const CosimCommand& o) {
  return {{"fault", o.fault},
          {"idle", o.rtl.idle_percent},
          {"backpressure", o.rtl.backpressure_percent},
          {"degrade", o.degrade},
          {"order", static_cast<int>(o.order)},
          {"alpha", o.alpha},
          {"samples", o.samples},
          {"classes", o.classes}};
}

/// The first difference of the pixels, and the stage that it came of where one was found.
Json to_json(const std::optional<cosim::Difference>& d, const std::optional<cosim::Divergence>& by) {
  if (!d) return nullptr;
  const auto text = [](const std::string& t) { return t.empty() ? Json(nullptr) : Json(t); };
  Json j;
  j["frame"] = d->frame;
  j["line"] = d->line < 0 ? Json(nullptr) : Json(d->line);
  j["x"] = d->x < 0 ? Json(nullptr) : Json(d->x);
  j["stage"] = by ? Json(by->module) : Json(nullptr);
  j["cycle"] = by ? Json(by->cycle) : Json(nullptr);
  j["field"] = d->field;
  j["expected"] = d->expected;
  j["actual"] = d->actual;
  j["waveform"] = by ? text(by->waveform) : Json(nullptr);
  j["text"] = cosim::describe(*d);
  if (!by) {
    j["divergence"] = nullptr;
    return j;
  }
  j["divergence"] = {{"line", by->line < 0 ? Json(nullptr) : Json(by->line)},
                     {"x", by->x < 0 ? Json(nullptr) : Json(by->x)},
                     {"module", by->module},
                     {"file", "rtl/" + by->module + ".sv"},
                     {"what", by->what},
                     {"field", by->field},
                     {"expected", by->expected},
                     {"actual", by->actual},
                     {"cycle", by->cycle},
                     {"token", by->token},
                     {"token_text", text(by->token_text)},
                     {"source", text(by->source)},
                     {"waits", text(by->waits)},
                     {"save_file", text(by->save_file)},
                     {"text", cosim::describe(*by)}};
  return j;
}

/// Where the pictures are; after a difference, which to look at.
std::string pictures_of(const cosim::Report& r, const std::string& folder) {
  const std::string& last = r.pictures.back();
  if (r.same) return folder;
  return last + (last.ends_with("_difference.png") ? ", with _expected and _actual beside it" : "");
}

/// How the RTL is run with monitors; the model is built if it is not there.
cosim::DivergenceOptions monitors(const CosimCommand& o, const Config& config, Progress& progress) {
  const cosim::Model model = cosim::find_model(
      config, {.fault = o.fault, .traced = true, .progress = [&](double seconds) {
                 check_interrupt();
                 progress.show(fmt::format("building the RTL model with monitors: {:.0f} s", seconds));
               }});
  cosim::DivergenceOptions options;
  options.library = model.library;
  options.rtl = o.rtl;
  options.steps = o.ci.shard.steps();
  options.wait = check_interrupt;
  return options;
}

/// The stage that a frame which came out different departs in first.
std::optional<cosim::Divergence> find_divergence(const CosimCommand& o, Source& source, Progress& progress, int frame) {
  const Config& config = source.config().config;
  cosim::DivergenceOptions options = monitors(o, config, progress);
  progress.show("looking for the stage that differs first");
  if (!o.out.empty())
    options.waveform = std::filesystem::path(o.out) / fmt::format("{}_{:04}.fst", source.name(), frame);
  const auto feed = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
  auto d = cosim::find_divergence(frame, feed, config, options);
  if (const auto provenance = d ? source.provenance(frame) : std::nullopt) {
    std::vector<std::uint32_t> words;
    source.frame(frame,
                 [&](std::span<const std::uint32_t> piece) { words.insert(words.end(), piece.begin(), piece.end()); });
    const auto sources = provenance->of_tokens(config, words, {d->token});
    if (!sources.empty()) d->source = sources.begin()->second.text();
  }
  progress.clear();
  return d;
}

void print_divergence(const std::optional<cosim::Divergence>& d) {
  if (!d) {
    fmt::print("no stage differs: look at the registers and the video port\n");
    return;
  }
  fmt::print("first divergence: {}\n", cosim::describe(*d));
  if (!d->waveform.empty()) fmt::print("waveform: {}; gtkwave {}\n", d->waveform, d->save_file);
}

int run(CosimCommand& o) {
  const OutFolder folder(o.out);
  check_json(o);
  if (!o.ci.junit.empty() && o.ci.junit == o.json) throw Error(fmt::format("{}: is to be written twice", o.json));
  Source source(o);
  const Config& config = source.config().config;
  const int frames = o.ci.shard.frames(source.frames());
  if (frames == 0)
    throw Error(fmt::format("--shard {}/{}: {} has only {}", o.ci.shard.index, o.ci.shard.count, source.name(),
                            counted(source.frames(), "frame")));
  TempFiles files;
  JUnitWriter junit(files, o.ci.junit, "kage cosim " + source.name());

  Progress progress;
  const cosim::Model model =
      cosim::find_model(config, {.fault = o.fault, .progress = [&](double seconds) {
                                   check_interrupt();
                                   progress.show(fmt::format("building the RTL model of configuration {}: {:.0f} s",
                                                             source.config().name, seconds));
                                 }});
  progress.clear();

  o.rtl.seed = o.seed;
  const auto golden = cosim::make_golden(config);
  const auto rtl = cosim::make_rtl(model.library, config, o.rtl);
  cosim::RunOptions options;
  options.out = o.out;
  options.name = source.name();
  options.steps = o.ci.shard.steps();
  options.two_threads = o.threads != 1;
  FrameProgress frame_progress(progress, source.name(), frames);
  options.begin = [&](int) {
    check_interrupt();
    frame_progress.next();
  };
  options.wait = check_interrupt;
  std::optional<RunReport> report;
  if (!o.no_report && !o.out.empty()) report.emplace(source, *o.command);
  const cosim::Report r = cosim::run(
      source.frames(),
      [&](int i, const WordSink& sink) { return report ? report->frame(i, sink) : source.frame(i, sink); }, *golden,
      *rtl, options);
  progress.clear();
  std::optional<cosim::Divergence> divergence;
  bool searched = false;
  if (r.first_difference && !o.no_divergence) {
    try {
      divergence = find_divergence(o, source, progress, r.first_difference->frame);
      searched = true;
    } catch (const Error& e) {  // the verdict stands without it
      progress.clear();
      source.note(fmt::format("the stage that differs first was not found: {}", e.what()));
    }
  }
  std::string page;
  if (report) {
    const auto watch = [&] { return monitors(o, config, progress); };
    // Where the monitors could not be had for the search, the page does without them too.
    page = report->write(o.out, r, o.seed, divergence, searched ? watch : RunReport::Watch());
  }

  Json j;
  j["same"] = r.same;
  j["frames"] = r.frames;
  j["width"] = r.width;
  j["height"] = r.height;
  j["pixels_compared"] = r.pixels_compared;
  j["spans"] = r.spans;
  j["span_pixels"] = r.span_pixels;
  j["segments"] = r.segments;
  j["units"] = source.units();
  j["polyhedra"] = source.ways();
  j["cycles"] = r.cycles;
  j["stalled"] = {{"input_starved", r.starved}, {"output_blocked", r.blocked}};
  describe_run(j, source.name(), source.frames(), o.ci.shard, options_of(o));
  j["frame_seconds"] = r.frame_seconds;
  j["golden_seconds"] = r.expected_seconds;
  j["rtl_seconds"] = r.actual_seconds;
  j["build_seconds"] = model.build_seconds;
  j["config"] = cli::to_json(config);
  j["seed"] = o.seed;
  j["degraded"] = source.degraded();
  j["pictures"] = r.pictures;
  j["report"] = page.empty() ? Json(nullptr) : Json(page);
  j["first_difference"] = to_json(r.first_difference, divergence);
  j["notes"] = source.notes();
  junit_frames(junit, {&j});
  junit.close();
  write_json(o, j, files);
  print_notes(source, o);
  if (!json_only(o)) {
    fmt::print("{}: {}, {}x{}, {} compared, {}{}, {}, golden {:.3f} s, RTL {:.3f} s, seed {}\n",
               r.same ? "same" : "different", counted(r.frames, "frame"), r.width, r.height,
               counted(r.pixels_compared, "pixel"), counted(r.spans, "span"), and_segments(r.segments),
               counted(r.cycles, "cycle"), r.expected_seconds, r.actual_seconds, o.seed);
    if (r.first_difference) fmt::print("first difference: {}\n", cosim::describe(*r.first_difference));
    if (searched) print_divergence(divergence);
    if (!r.pictures.empty()) fmt::print("pictures: {}\n", pictures_of(r, o.out));
    if (!page.empty()) fmt::print("report: {}\n", page);
  }
  annotate_difference(o.ci.annotate, j, json_only(o) ? stderr : stdout);
  return r.same ? kSame : kDifferent;
}

}  // namespace

void add_cosim(CLI::App& app, Action& action) {
  CLI::App* c = add_command(
      app, "cosim", "Send every frame through golden model and RTL and compare every pixel",
      "  kage cosim courtyard\n"
      "  kage cosim model.glb --size 320x240 --frames 2 --config full --out pictures\n"
      "  kage cosim courtyard.kage --json -\n"
      "  kage cosim courtyard --fault wrong_compare\n"
      "  kage cosim courtyard --shard 2/4 --junit cosim-2.xml --json cosim-2.json   (then kage merge)\n"
      "The RTL model of a configuration is built on first use, and anew when the RTL has changed; it is kept in\n"
      "~/.cache/kage/models. The pictures appear together when there is a verdict, then DIR/report.html:\n"
      "verdict, frames, clocks, and the history of each pixel that is clicked (docs/report.md).\n"
      "Exit code 0: the same. 1: different; expected, actual and difference pictures are in the folder. 2: trouble.");
  const auto o = std::make_shared<CosimCommand>();
  o->out = "out";
  option_scene(*c, *o);
  c->add_option("--out", o->out, "folder for pictures and report.html, default out")->type_name("DIR");
  options_of_frames(*c, *o);
  option_json(*c, *o);
  c->add_option("--idle", o->rtl.idle_percent, "percent of clocks at random in which no input is offered, default 0")
      ->check(CLI::Range(0, 95))
      ->type_name("P");
  c->add_option("--backpressure", o->rtl.backpressure_percent,
                "percent of clocks at random in which no output is taken, default 0")
      ->check(CLI::Range(0, 95))
      ->type_name("P");
  option_fault(*c, o->fault);
  c->add_flag("--no-divergence", o->no_divergence,
              "after a difference do not run the frame again to find the stage that differs first");
  option_shard(*c, o->ci.shard);
  option_junit(*c, o->ci.junit);
  option_annotate(*c, o->ci.annotate);
  c->add_flag("--no-report", o->no_report, "write no report.html");
  o->command = c;
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
