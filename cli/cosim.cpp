// SPDX-License-Identifier: Apache-2.0
// kage cosim SCENE: golden model against RTL, frame by frame.
#include <fmt/format.h>

#include <memory>

#include "common.hpp"
#include "cosim/model.hpp"
#include "cosim/rtl.hpp"
#include "cosim/run.hpp"
#include "source.hpp"

namespace kage::cli {
namespace {

struct CosimCommand : Options {
  std::string fault;
  cosim::RtlOptions rtl;
};

Json to_json(const std::optional<cosim::Difference>& d) {
  if (!d) return nullptr;
  Json j;
  j["frame"] = d->frame;
  j["line"] = d->line < 0 ? Json(nullptr) : Json(d->line);
  j["x"] = d->x < 0 ? Json(nullptr) : Json(d->x);
  j["stage"] = nullptr;
  j["cycle"] = nullptr;
  j["field"] = d->field;
  j["expected"] = d->expected;
  j["actual"] = d->actual;
  j["waveform"] = nullptr;
  return j;
}

/// Where the pictures are; after a difference, which to look at.
std::string pictures_of(const cosim::Report& r, const std::string& folder) {
  const std::string& last = r.pictures.back();
  if (r.same) return folder;
  return last + (last.ends_with("_difference.png") ? ", with _expected and _actual beside it" : "");
}

int run(CosimCommand& o) {
  const OutFolder folder(o.out);
  check_json(o);
  Source source(o);
  const Config& config = source.config().config;

  Progress progress;
  const cosim::Model model = cosim::find_model(config, o.fault, [&](double seconds) {
    check_interrupt();
    progress.show(fmt::format("building the RTL model of configuration {}: {:.0f} s", source.config().name, seconds));
  });
  progress.clear();

  o.rtl.seed = o.seed;
  const auto golden = cosim::make_golden(config);
  const auto rtl = cosim::make_rtl(model.library, config, o.rtl);
  cosim::RunOptions options;
  options.out = o.out;
  options.name = source.name();
  options.two_threads = o.threads != 1;
  options.begin = [&](int frame) {
    check_interrupt();
    progress.show(fmt::format("{}: frame {}/{}", source.name(), frame + 1, source.frames()));
  };
  options.wait = check_interrupt;
  const cosim::Report r = cosim::run(
      source.frames(), [&](int i, const WordSink& sink) { return source.frame(i, sink); }, *golden, *rtl, options);
  progress.clear();

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
  j["golden_seconds"] = r.expected_seconds;
  j["rtl_seconds"] = r.actual_seconds;
  j["build_seconds"] = model.build_seconds;
  j["config"] = cli::to_json(config);
  j["seed"] = o.seed;
  j["degraded"] = source.degraded();
  j["pictures"] = r.pictures;
  j["first_difference"] = to_json(r.first_difference);
  j["notes"] = source.notes();
  write_json(o, j);
  print_notes(source, o);
  if (!json_only(o)) {
    fmt::print("{}: {}, {}x{}, {} compared, {}{}, {}, golden {:.3f} s, RTL {:.3f} s, seed {}\n",
               r.same ? "same" : "different", counted(r.frames, "frame"), r.width, r.height,
               counted(r.pixels_compared, "pixel"), counted(r.spans, "span"), and_segments(r.segments),
               counted(r.cycles, "cycle"), r.expected_seconds, r.actual_seconds, o.seed);
    if (r.first_difference) fmt::print("first difference: {}\n", cosim::describe(*r.first_difference));
    if (!r.pictures.empty()) fmt::print("pictures: {}\n", pictures_of(r, o.out));
  }
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
      "The RTL model of a configuration is built on first use, and anew when the RTL has changed; it is kept in\n"
      "~/.cache/kage/models. The pictures appear together when there is a verdict.\n"
      "Exit code 0: the same. 1: different; expected, actual and difference pictures are in the folder. 2: trouble.");
  const auto o = std::make_shared<CosimCommand>();
  o->out = "out";
  option_scene(*c, *o);
  c->add_option("--out", o->out, "folder for the pictures, default out")->type_name("DIR");
  option_size(*c, *o);
  option_frames(*c, *o);
  option_config(*c, *o);
  option_degrade(*c, *o);
  option_units_only(*c, *o);
  option_translucent(*c, *o);
  option_lights(*c, *o);
  option_seed(*c, *o);
  option_json(*c, *o);
  option_threads(*c, *o);
  c->add_option("--idle", o->rtl.idle_percent, "percent of clocks at random in which no input is offered, default 0")
      ->check(CLI::Range(0, 95))
      ->type_name("P");
  c->add_option("--backpressure", o->rtl.backpressure_percent,
                "percent of clocks at random in which no output is taken, default 0")
      ->check(CLI::Range(0, 95))
      ->type_name("P");
  option_fault(*c, o->fault);
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
