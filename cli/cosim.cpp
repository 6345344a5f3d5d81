// SPDX-License-Identifier: Apache-2.0
// kage cosim SCENE...: golden model against RTL, frame by frame.
#include <fmt/format.h>

#include <cerrno>
#include <memory>
#include <optional>

#include "ci.hpp"
#include "common.hpp"
#include "cosim/divergence.hpp"
#include "cosim/lock.hpp"
#include "cosim/rtl.hpp"
#include "cosim/run.hpp"
#include "joined.hpp"
#include "kage/error.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "report/html.hpp"
#include "rtl_run.hpp"
#include "source.hpp"

namespace kage::cli {
namespace {

struct CosimCommand : Options {
  std::vector<std::string> inputs;  // of which `input` is the one at hand
  bool no_divergence = false;
  RtlRun rtl;
  CiOptions ci;
  bool no_report = false;
  const CLI::App* command = nullptr;
};

/// What decides words and clocks besides scene, size, configuration and seed.
Json options_of(const CosimCommand& o) {
  return {{"fault", o.rtl.fault},
          {"idle", o.rtl.options.idle_percent},
          {"backpressure", o.rtl.options.backpressure_percent},
          {"degrade", o.degrade},
          {"order", name_of(o.order)},
          {"alpha", o.alpha},
          {"cull", o.cull},
          {"samples", o.samples},
          {"classes", o.classes}};
}

/// The first difference of the pixels, and the stage that it came of where one was looked for and found.
Json to_json(const std::optional<cosim::Difference>& d, const std::optional<cosim::Divergence>& by, bool searched) {
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
  j["assertion"] = text(d->assertion);
  j["waveform"] = by ? text(by->waveform) : Json(nullptr);
  j["text"] = cosim::describe(*d);
  j["searched"] = searched;
  j["no_divergence"] = searched && !by ? Json(cosim::describe_none(*d)) : Json(nullptr);
  j["divergence"] = nullptr;
  if (!by) return j;
  j["divergence"] = {{"frame", by->frame},
                     {"line", by->line < 0 ? Json(nullptr) : Json(by->line)},
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

Json to_json(const cosim::Stalls& s) { return {{"input_starved", s.starved}, {"output_blocked", s.blocked}}; }

/// By the name of the phase; without those that lost nothing.
Json to_json(const cosim::PhaseStalls& stalls) {
  Json j = Json::object();
  for (std::size_t i = 0; i < stalls.size(); ++i)
    if (stalls[i].starved != 0 || stalls[i].blocked != 0)
      j[std::string(i < cosim::kPhases ? cosim::kPhaseNames[i] : "behind the last token")] = to_json(stalls[i]);
  return j;
}

/// The frames that were compared, the first so many and the one that is different.
Json to_json(const std::vector<cosim::FrameResult>& frames, const std::optional<cosim::Difference>& difference) {
  Json all = Json::array();
  for (const cosim::FrameResult& r : frames)
    all.push_back({{"frame", r.frame},
                   {"same", !difference || difference->frame != r.frame},
                   {"cycles", r.cycles},
                   {"stalled", to_json(r.stalls)},
                   {"stalled_by_phase", to_json(r.phase_stalls)},
                   {"spans", r.counts.spans},
                   {"span_pixels", r.counts.span_pixels},
                   {"segments", r.counts.of_kind[static_cast<std::size_t>(Kind::SEG)]},
                   {"words", r.counts.words}});
  return all;
}

/// Where the pictures are; after a difference, which to look at.
std::string pictures_of(const Json& report, const std::string& folder) {
  const auto last = report["pictures"].back().get<std::string>();
  if (report["same"].get<bool>()) return folder;
  return last + (last.ends_with("_difference.png") ? ", with _expected and _actual beside it" : "");
}

/// A scene of the run.
struct Job {
  CosimCommand o;  // with its input and its folder
  std::unique_ptr<OutFolder> folder;
  std::unique_ptr<Source> source;
  int total = 0;            // of its frames
  std::int64_t before = 0;  // frames of the scenes before it
  std::vector<std::string> notes;
  bool interrupted = false;  // after its verdict
};

/// How the RTL is run with monitors.
cosim::DivergenceOptions monitors(const Job& job) {
  cosim::DivergenceOptions options = cli::monitors(job.source->config(), job.o.rtl);
  options.steps = job.o.ci.shard.steps(job.before);
  return options;
}

/// The stage that a frame which came out different departs in first.
std::optional<cosim::Divergence> find_divergence(const Job& job, TempFiles& files, Progress& progress, int frame) {
  Source& source = *job.source;
  const Config& config = source.config().config;
  cosim::DivergenceOptions options = monitors(job);
  progress.show("looking for the stage that differs first");
  if (!job.o.out.empty())
    options.waveform = std::filesystem::path(job.o.out) / fmt::format("{}_{:04}.fst", source.name(), frame);
  options.files = &files;
  const auto feed = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
  auto d = cosim::find_divergence(frame, feed, config, options);
  if (const auto provenance = d ? source.provenance(d->frame) : std::nullopt) {
    const auto sources = provenance->of_tokens(config, source.words(d->frame), {d->token});
    if (!sources.empty()) d->source = sources.begin()->second.text();
  }
  progress.clear();
  return d;
}

/// Opens all scenes, so that what cannot be read is found before the work.
std::vector<Job> open(const CosimCommand& o) {
  std::vector<Job> jobs;
  std::int64_t frames = 0;
  int own = 0;
  for (const std::string& input : o.inputs) {
    check_interrupt();
    Job& job = jobs.emplace_back();
    job.o = o;
    job.o.input = input;
    job.source = std::make_unique<Source>(job.o);
    const std::string& name = job.source->name();
    for (const Job& other : jobs)
      if (&other != &job && other.source->name() == name)
        throw Error(fmt::format("{}: a scene called {} is there already: {}", input, name, other.o.input));
    // Each scene has its own folder, where there are several.
    if (o.inputs.size() > 1 && !o.out.empty()) job.o.out = (std::filesystem::path(o.out) / name).string();
    job.total = job.source->frames();
    job.before = frames;
    frames += job.total;
    own += o.ci.shard.frames(job.total, job.before);
  }
  if (own == 0)
    throw Error(fmt::format("--shard {}/{}: {} {} only {}", o.ci.shard.index, o.ci.shard.count,
                            jobs.size() == 1 ? jobs.front().source->name() : "the scenes",
                            jobs.size() == 1 ? "has" : "have", counted(frames, "frame")));
  return jobs;
}

/// With the new files goes what an earlier run into the folder left of frames that this one has compared: a difference
/// that is no more, or was another.
void remove_old_evidence(TempFiles& files, const std::string& folder, const std::string& name, cosim::FrameSteps steps,
                         const cosim::Report& r) {
  namespace fs = std::filesystem;
  if (folder.empty()) return;
  for (int i = 0; i < r.frames; ++i)
    for (const char* end : {"_expected.png", "_actual.png", "_difference.png", ".fst", ".gtkw"}) {
      const fs::path path = fs::path(folder) / fmt::format("{}_{:04}{}", name, steps.first + i * steps.step, end);
      std::error_code ec;
      const fs::file_type type = fs::symlink_status(path, ec).type();
      if ((type == fs::file_type::regular || type == fs::file_type::symlink) &&  // else it was not ours
          std::find(r.pictures.begin(), r.pictures.end(), path.string()) == r.pictures.end())
        files.remove(path);
    }
}

/// Compares what the shard has of a scene; its report. What it writes gets its names with the others of `files`.
Json compare(Job& job, TempFiles& files) {
  CosimCommand& o = job.o;
  Source& source = *job.source;
  const cosim::FrameSteps steps = o.ci.shard.steps(job.before);
  const int frames = o.ci.shard.frames(job.total, job.before);
  if (frames == 0) return no_frames(source.name(), job.total);
  job.folder = std::make_unique<OutFolder>(o.out);
  const Config& config = source.config().config;
  const cosim::Model model = model_of(source.config(), o.rtl.fault);
  Progress progress;

  o.rtl.options.seed = o.seed;
  const auto golden = cosim::make_golden(config);
  const auto rtl = cosim::make_rtl(model.library, config, o.rtl.options);
  cosim::RunOptions options;
  options.out = o.out;
  options.name = source.name();
  options.files = &files;
  options.steps = steps;
  options.two_threads = o.threads != 1;
  FrameProgress frame_progress(progress, source.name(), frames);
  options.begin = [&](int) {
    check_interrupt();
    frame_progress.next();
  };
  options.wait = [&] {
    check_interrupt();
    frame_progress.wait();
  };
  std::optional<RunReport> report;
  if (!o.no_report && !o.out.empty()) report.emplace(source, o.input, *o.command);
  const cosim::Report r = cosim::run(
      source.frames(),
      [&](int i, const WordSink& sink) { return report ? report->frame(i, sink) : source.frame(i, sink); }, *golden,
      *rtl, options);
  progress.clear();
  remove_old_evidence(files, o.out, source.name(), steps, r);
  std::optional<cosim::Divergence> divergence;
  bool searched = false;
  std::string page;
  // The verdict stands whatever becomes of what is said about it.
  try {
    if (r.first_difference && !o.no_divergence) {
      try {
        divergence = find_divergence(job, files, progress, r.first_difference->frame);
        searched = true;
        if (divergence && !divergence->no_waveform.empty())
          source.note(fmt::format("no waveform was written: {}", divergence->no_waveform));
      } catch (const Error& e) {
        progress.clear();
        source.note(fmt::format("the stage that differs first was not found: {}", e.what()));
      }
    }
    if (report) {
      const auto watch = [&] { return monitors(job); };
      // Where the monitors could not be had for the search, the page does without them too.
      page = report->write(files, o.out, r, o.seed, divergence, searched ? watch : RunReport::Watch());
    }
  } catch (const Interrupted&) {
    job.interrupted = true;
    source.note("interrupted after the verdict");
  } catch (const std::exception& e) {
    source.note(fmt::format("no report was written: {}", e.what()));
  }
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
  j["stalled"] = to_json(r.stalls);
  describe_run(j, source.name(), source.frames(), o.ci.shard, steps, options_of(o));
  j["frame_seconds"] = r.frame_seconds;
  j["each"] = to_json(r.each, r.first_difference);
  j["golden_seconds"] = r.expected_seconds;
  j["rtl_seconds"] = r.actual_seconds;
  j["build_seconds"] = model.build_seconds;
  j["config_name"] = source.config().name;
  j["config"] = cli::to_json(config);
  j["seed"] = o.seed;
  j["versions"] = versions();
  j["again"] = command_line(*o.command);
  j["folder"] = std::filesystem::current_path().string();
  j["rtl"] = rtl_directory();
  j["degraded"] = source.degraded();
  j["pictures"] = r.pictures;
  j["report"] = page.empty() ? Json(nullptr) : Json(page);
  j["report_crc32"] = page.empty() ? Json(nullptr) : Json(report::checksum(files.now(page)));
  j["first_difference"] = to_json(r.first_difference, divergence, searched);
  j["notes"] = source.notes();
  return j;
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
  if (!j["same"].get<bool>()) print_difference(j["first_difference"]);
  if (!j["pictures"].empty()) fmt::print("pictures: {}\n", pictures_of(j, folder));
  if (!j["report"].is_null()) fmt::print("report: {}\n", j["report"].get<std::string>());
}

/// Writes the page over all scenes; its name, or nothing: the verdict stands without it.
std::string joined_page(const CosimCommand& o, const Json& j, Job& last, TempFiles& files) {
  std::string page = (std::filesystem::path(o.out) / "report.html").string();
  try {
    write_joined_page(files, page, j);
    return page;
  } catch (const Interrupted&) {
    last.interrupted = true;
    last.notes.emplace_back("interrupted after the verdict");
  } catch (const std::exception& e) {
    last.notes.push_back(fmt::format("no report over all scenes was written: {}", e.what()));
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
  std::vector<Job> jobs = open(o);
  const bool several = jobs.size() > 1;
  TempFiles files;
  JUnitWriter junit(files, o.ci.junit, "kage cosim");
  std::vector<Json> reports;
  for (Job& job : jobs) {
    reports.push_back(compare(job, files));
    for (const std::string& note : job.source->notes())
      job.notes.push_back(fmt::format("{}: {}", job.source->name(), note));
    job.source.reset();  // its memory
    if (job.interrupted && &job != &jobs.back()) throw Interrupted{};
  }
  const auto who = [&](const Json& r) { return several ? r["scene"].get<std::string>() + ": " : std::string(); };
  Json j = several ? all_scenes(reports) : reports.front();
  std::string page;
  if (several && !o.no_report && !o.out.empty()) page = joined_page(o, j, jobs.back(), files);
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
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    for (const std::string& note : jobs[i].notes) fmt::print(json_only(o) ? stderr : stdout, "{}\n", note);
    if (!json_only(o)) print_report(reports[i], who(reports[i]), jobs[i].o.out);
    if (has_frames(reports[i])) annotate_difference(o.ci.annotate, reports[i], json_only(o) ? stderr : stdout);
  }
  if (several && !json_only(o))
    fmt::print("{}: {}, {} of {}, {} compared, {}, seed {}\n", same ? "same" : "different",
               counted(jobs.size(), "scene"), counted(j["frames"].get<std::uint64_t>(), "frame"),
               j["total_frames"].get<std::uint64_t>(), counted(j["pixels_compared"].get<std::uint64_t>(), "pixel"),
               counted(j["cycles"].get<std::uint64_t>(), "cycle"), o.seed);
  if (several && !json_only(o) && !page.empty()) fmt::print("report: {}\n", page);
  if (jobs.back().interrupted) return interrupted_code();
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
