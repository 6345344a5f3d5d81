// SPDX-License-Identifier: Apache-2.0
// kage regress: the recommended runs of kage cosim, in rounds, until the time is over or one comes out different.
#include "cosim/regress/regress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "ci.hpp"
#include "command.hpp"
#include "command_lines.hpp"
#include "cosim/report/cases.hpp"
#include "cosim/report/joined.hpp"
#include "cosim/report/report_lock.hpp"
#include "cosim_print.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "results.hpp"
#include "rtl_options.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

constexpr const char* kFrontEnd = "--front-end";

struct RegressCommand {
  cosim::RegressOptions how;
  cosim::SourceOptions source;  // of which --front-end
  std::string json;
  CiOptions ci;
  bool list = false;  // the runs are told, and none is made
  Command command;
};

/// A case for each run; classname kage.regress.CONFIGURATION.
void write_junit(TempFiles& files, const std::string& path, const report::RunRecord& record,
                 const std::optional<cosim::Regress::Trouble>& trouble) {
  report::JUnitWriter junit(files, path, "kage regress");
  for (const report::SceneRecord& r : record.scenes) {
    junit.group(r.config_name);
    const double seconds = r.golden_seconds + r.rtl_seconds;
    if (r.first_difference)
      report::junit_difference(junit, r.scene, seconds, *r.first_difference, r.again);
    else
      junit.pass(r.scene, seconds);
  }
  if (trouble) {
    junit.group(trouble->config);
    junit.error(trouble->name, trouble->text);
  }
  junit.close();
}

/// Prints the runs and frames of each configuration, and whether all were the same.
void print_configurations(const report::RunRecord& record) {
  struct Sum {
    std::uint64_t runs = 0;
    std::uint64_t frames = 0;
    bool same = true;
  };
  std::vector<std::string> order;
  std::map<std::string, Sum> sums;
  for (const report::SceneRecord& r : record.scenes) {
    if (sums.count(r.config_name) == 0) order.push_back(r.config_name);
    Sum& s = sums[r.config_name];
    ++s.runs;
    s.frames += static_cast<std::uint64_t>(r.frames);
    s.same = s.same && r.same;
  }
  for (const std::string& name : order) {
    const Sum& s = sums[name];
    fmt::print("  {:<16} {:<12} {:<14} {}\n", name, counted(s.runs, "run"), counted(s.frames, "frame"),
               s.same ? "same" : "different");
  }
}

void print_summary(const report::RunRecord& record) {
  const report::TotalsRecord totals = record.totals();
  const report::RegressRecord& r = *record.regress;
  fmt::print("{}: {}{} of {}, {}, {} compared, {}, {:.0f} s, seed {}\n", totals.same ? "same" : "different", r.ended(),
             counted(record.scenes.size(), "run"), counted(r.rounds, "round"), counted(totals.frames, "frame"),
             counted(totals.pixels_compared, "pixel"), counted(totals.cycles, "cycle"), r.seconds, r.seed);
}

/// The verdict, and what is known of the run that differs: without its files where those do not appear.
void print_verdicts(const cosim::Regress& regress, const report::RunRecord& record, bool files_appear) {
  print_summary(record);
  print_configurations(record);
  if (regress.same()) return;
  const report::SceneRecord& d = regress.different();
  if (files_appear)
    print_report(d, d.scene + ": ", regress.folder());
  else
    print_finding(d, d.scene + ": ");
  fmt::print("that run again: {}\n", d.again);
}

/// Page, JUnit and JSON. Throws Error if JUnit or JSON cannot be written: then no file of the regression appears, but
/// what it found is told. The verdict stands without the page.
void write_reports(const RegressCommand& o, cosim::Regress& regress, report::RunRecord& record, const std::string& page,
                   TempFiles& files) {
  try {
    // After a signal the runs that were done before it are still written.
    const bool over = regress.interrupted();
    report::write_joined_page(files, page, record, [over] {
      if (!over) check_interrupt();
    });
    record.page = page;
  } catch (const Interrupted&) {
    regress.interrupt();
  } catch (const std::exception& e) {
    regress.note(fmt::format("no report over all runs was written: {}", e.what()));
  }
  try {
    write_junit(files, o.ci.junit, record, regress.trouble());
    write_json(o.json, record, files);
  } catch (const Error&) {
    if (!json_only(o.json)) print_verdicts(regress, record, false);
    throw;
  }
}

int run(RegressCommand& o) {
  o.how.again = command_line(o.command);
  if (o.command.option(kFrontEnd).count() != 0) o.how.level = o.source.level;
  if (o.list) {
    for (const cosim::RoundRun& run : cosim::Regress(o.how, terminal()).list(std::max(1, o.how.rounds)))
      fmt::print("{}: {}\n", run.name, run.options.lines.again);
    return kSame;
  }
  const OutFolder folder(o.how.out);
  const report::ReportLock lock(o.how.out);
  reads_files(o.how.configs);
  check_json(o.source, o.json);
  check_output(o.ci.junit);
  const std::string page = (std::filesystem::path(o.how.out) / "report.html").string();
  refuse_twice({file_named(o.json), o.ci.junit, page});
  cosim::Regress regress(o.how, terminal());
  regress.prepare();
  regress.run();
  TempFiles files;
  regress.look_into(files);
  report::RunRecord record = regress.record();
  write_reports(o, regress, record, page, files);
  std::FILE* const to = json_only(o.json) ? stderr : stdout;
  for (const std::string& note : regress.notes()) fmt::print(to, "{}\n", note);
  if (!json_only(o.json)) {
    print_verdicts(regress, record, true);
    if (record.page) fmt::print("report over all runs: {}\n", shown(*record.page));
  }
  if (!regress.same()) report::annotate_difference(o.ci.annotate, regress.different(), to);
  if (!regress.same()) return kDifferent;
  if (regress.trouble()) throw Error(regress.trouble()->text);
  return regress.interrupted() ? interrupted_code() : kSame;
}

}  // namespace

void add_regress(Program& program, Action& action) {
  Command c = program.add(
      "regress", "Run scenes and random frames through all configurations until the time is over",
      "  kage regress\n"
      "  kage regress --minutes 30 --seed 7 --junit regress.xml\n"
      "  kage regress --config glass --config mine.yaml --minutes 1\n"
      "  kage regress --rounds 2 --json -\n"
      "  kage regress --front-end rtl                    (a front end in every configuration, and polygons for it)\n"
      "  kage regress --list --config glass\n"
      "Each run is a kage cosim: sound, mixed and damaged random frames and the built-in scenes, in every\n"
      "configuration, with ports that stop and ports that do not (docs/regress.md). Configurations with a front end\n"
      "get frames at both levels: polygons, and spans between. The first\n"
      "difference ends the regression: its run is repeated with pictures, waveform, page and the stage that differs\n"
      "first, in DIR/RUN, and the line of kage cosim that repeats it is printed.\n"
      "DIR/report.html is over all runs. The RTL models that are missing are built before the time begins.\n"
      "Exit code 0: the same. 1: different. 2: trouble. A signal ends it with what was done, and the code is 130\n"
      "(Ctrl-C), 143 (SIGTERM) or 129 (SIGHUP), if no difference was found before.");
  const auto o = std::make_shared<RegressCommand>();
  o->how.out = "out";
  const Option minutes =
      c.add_option("--minutes", o->how.minutes, "time to run, default 5; the runs that are under way then end early")
          .check(real_number(0.01, 10000))
          .type_name("M");
  c.add_option("--rounds", o->how.rounds, "run N rounds instead of a time, so that every machine runs the same")
      .check(whole_number(1, 1000000))
      .excludes(minutes)
      .type_name("N");
  Option list =
      c.add_flag("--list", o->list, "run nothing, but print the runs of the first round, or of --rounds N, as commands")
          .excludes(minutes);
  c.add_option("--config", o->how.configs,
               "a configuration, by name or file; may be given several times. Default: all named ones")
      .one_value_each()
      .take_all()
      .type_name("NAME|FILE");
  option_seed(c, o->how.seed);
  option_front_end(c, o->source);
  c.option(kFrontEnd).description(
      "who makes spans of polygons, default rtl in configurations with a front end (ACTIVE), else host; rtl gives the "
      "others a front end, too (docs/regress.md)");
  c.add_option("--out", o->how.out, "folder for report.html and what is found out about a difference, default out")
      .type_name("DIR");
  option_json(c, o->json);
  option_junit(c, o->ci.junit, "run");
  option_annotate(c, o->ci.annotate);
  c.add_option(
       "--jobs", o->how.jobs,
       "runs at a time; default one per processor, at most as many as half of the memory holds 256 MiB for each")
      .check(whole_number(1, 4096))
      .type_name("N");
  for (const char* result : {"--json", "--junit", "--annotate", "--jobs"}) list.excludes(c.option(result));
  c.add_flag("--no-divergence", o->how.no_divergence,
             "after a difference do not look for the stage that differs first");
  option_defect(c, o->how.rtl);
  o->command = c;
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
