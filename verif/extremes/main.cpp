// SPDX-License-Identifier: Apache-2.0
//
// kage_extremes: campaigns over the families of extreme inputs. docs/extremes.md
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "extremes/campaign.hpp"
#include "extremes/found.hpp"
#include "extremes/injections.hpp"
#include "extremes/rtl_models.hpp"
#include "extremes/table.hpp"
#include "file/temp_file.hpp"
#include "kage/error.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

constexpr const char* kHelp = R"(usage: kage_extremes [OPTION]...

Runs cases of extreme inputs against oracles for some time and prints how near each family's errors come to their bounds.

  --seed S          of all chance (default: 1)
  --minutes M       for all families together; may be a fraction (default: 1)
  --starts N        run N starts of each family, however long that takes, instead of a time
  --family N[,N]    only these families: "15" is all of family 15, "14 cut" one check of family 14
  --jobs J          threads (default: 2)
  --json FILE       the table as JSON, too
  --models FOLDER   models of the RTL for families 12, 29 and 39 to 41 (default: those that the build has made)
  --found FOLDER    where a failing case is kept (default: verif/extremes/found of the source)
  --case NAME       only this one, as "FAMILY:SEED:INDEX" names it: prints its text and what it comes to
  --check PATH...   cases from files, or from all files of a folder; each must hold
  --list            all families, a line each
  --inject-all          put a deliberate error into each family, one that its check must see, and print in which start it
                    was seen; of --starts, or 200
  --inject NAME      put a deliberate error into all families: )";

constexpr const char* kEnd = R"(
Exit code: 0 all families hold; 1 one does not; 2 trouble, or a family had no case in the time; 130 after Ctrl-C, with
the table so far.

examples:
  kage_extremes --seed 1 --minutes 10
  kage_extremes --family 15,18,19 --minutes 2 --json depth.json
  kage_extremes --case 15:1:42
  kage_extremes --check verif/extremes/found
  kage_extremes --inject-all
  kage_extremes --inject wide_span --family 6 --minutes 0.1 --found /tmp
)";

// Starts in which a check must have seen its family's error.
constexpr std::uint64_t kInjectionStarts = 200;

volatile std::sig_atomic_t signalled = 0;

void on_signal(int number) {
  if (signalled != 0) _exit(128 + number);
  signalled = number;
}

// The process ends within a case: say which.
void on_crash(int number) {
  const auto say = [](const char* text) { (void)!write(STDERR_FILENO, text, std::strlen(text)); };
  say("kage_extremes: case ");
  say(case_at_hand());
  say(number == SIGSEGV ? " ends the program: segmentation fault\n" : " ends the program: aborted\n");
  _exit(1);
}

struct Arguments {
  CampaignOptions campaign;
  std::string json;
  std::string models = KAGE_RTL_TEST_MODELS;
  std::string one_case;
  std::vector<std::string> files;
  bool list = false;
  bool injections = false;
};

[[noreturn]] void usage(const std::string& cause) { throw Error("kage_extremes: " + cause + " (--help tells more)"); }

template <class T>
T parsed(const char* option, const std::string& text, T least, T most) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= least && value <= most))
    usage(fmt::format("{} {}: it must be {} .. {}", option, text, least, most));
  return value;
}

std::vector<const Family*> chosen(const std::string& names) {
  std::vector<const Family*> found;
  for (std::size_t from = 0; from <= names.size();) {
    const std::size_t to = std::min(names.find(',', from), names.size());
    const std::string name = names.substr(from, to - from);
    bool any = false;
    for (const auto& f : all_families()) {
      if (f->info().name != name && std::to_string(f->info().number) != name) continue;
      any = true;
      if (std::find(found.begin(), found.end(), f.get()) == found.end()) found.push_back(f.get());
    }
    if (!any) usage(fmt::format("--family {}: there is no such family (--list has them)", name));
    from = to + 1;
  }
  return found;
}

Arguments arguments(int argc, char** argv) {
  Arguments a;
  a.campaign.seconds = 60;
  a.campaign.found = std::string(KAGE_SOURCE_DIR) + "/verif/extremes/found";
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const auto value = [&]() -> std::string {
      if (i + 1 >= argc) usage(option + " needs a value");
      return argv[++i];
    };
    if (option == "--help" || option == "-h") {
      std::string injections;
      for (const std::string& p : injection_names()) injections += (injections.empty() ? "" : ", ") + p;
      fmt::print("{}\n                    {}\n{}", kHelp, injections, kEnd);
      std::exit(0);
    }
    if (option == "--seed") {
      a.campaign.seed = parsed<std::uint64_t>("--seed", value(), 0, UINT64_MAX);
    } else if (option == "--minutes") {
      a.campaign.seconds = 60 * parsed<double>("--minutes", value(), 0.001, 100'000);
    } else if (option == "--starts") {
      a.campaign.starts = parsed<std::uint64_t>("--starts", value(), 1, 1'000'000'000);
    } else if (option == "--jobs") {
      a.campaign.jobs = parsed<int>("--jobs", value(), 1, 1024);
    } else if (option == "--family") {
      a.campaign.families = chosen(value());
    } else if (option == "--json") {
      a.json = value();
    } else if (option == "--models") {
      a.models = value();
    } else if (option == "--found") {
      a.campaign.found = value();
    } else if (option == "--case") {
      a.one_case = value();
    } else if (option == "--check") {
      while (i + 1 < argc && argv[i + 1][0] != '-') a.files.emplace_back(argv[++i]);
      if (a.files.empty()) usage("--check needs a file or a folder");
    } else if (option == "--list") {
      a.list = true;
    } else if (option == "--inject-all") {
      a.injections = true;
    } else if (option == "--inject") {
      const std::string name = value();
      const auto injection = injection_of(name);
      if (!injection) usage(fmt::format("--inject {}: there is no such error", name));
      a.campaign.context.injection = *injection;
    } else {
      usage("unknown option: " + option);
    }
  }
  if (a.campaign.families.empty())
    for (const auto& f : all_families()) a.campaign.families.push_back(f.get());
  return a;
}

int check_files(const Arguments& a) {
  std::vector<std::filesystem::path> files;
  for (const std::string& path : a.files) {
    if (!std::filesystem::is_directory(path)) {
      files.emplace_back(path);
      continue;
    }
    const auto all = found_files(path);
    files.insert(files.end(), all.begin(), all.end());
  }
  std::size_t bad = 0;
  for (const auto& file : files) {
    const FoundCase c = read_found(file);
    if (c.family->info().rtl && a.campaign.context.models->empty()) {
      fmt::print("{}: skipped: there are no models of the RTL\n", file.string());
      continue;
    }
    set_case_at_hand(file.filename().string());
    const Outcome o = c.family->check(c.text, file.string(), a.campaign.context);
    fmt::print("{}: family {}: {}\n", file.string(), c.family->info().name, o.wrong.empty() ? "holds" : o.wrong);
    bad += o.wrong.empty() ? 0 : 1;
  }
  fmt::print("{} cases, {} of them wrong\n", files.size(), bad);
  return bad == 0 ? 0 : 1;
}

int run_case(const Arguments& a) {
  const std::size_t second = a.one_case.rfind(':');
  const std::size_t first =
      second == std::string::npos || second == 0 ? std::string::npos : a.one_case.rfind(':', second - 1);
  if (first == std::string::npos) usage(fmt::format("--case {}: it must be FAMILY:SEED:INDEX", a.one_case));
  const Family* family = family_named(a.one_case.substr(0, first));
  if (family == nullptr) usage(fmt::format("--case {}: there is no such family (--list has them)", a.one_case));
  const auto seed =
      parsed<std::uint64_t>("--case, seed", a.one_case.substr(first + 1, second - first - 1), 0, UINT64_MAX);
  const auto index = parsed<std::uint64_t>("--case, index", a.one_case.substr(second + 1), 0, UINT64_MAX);
  set_case_at_hand(a.one_case);
  const Search run = family->run(seed, index, a.campaign.context, [] { return signalled != 0; });
  const std::string text = run.failing ? *run.failing : run.nearest.empty() ? family->text(seed, index) : run.nearest;
  fmt::print("# {}: {} cases, {} pixels, {} items\n", a.one_case, run.cases, run.sum.pixels, run.sum.items);
  if (run.sum.bound > 0) fmt::print("# nearest: {} of {} {}\n", run.sum.worst, run.sum.bound, family->info().unit);
  fmt::print("# {}\nfamily {}\n{}", run.sum.wrong.empty() ? "holds" : run.sum.wrong, family->info().name, text);
  return run.sum.wrong.empty() ? 0 : 1;
}

/// Leaves out what needs models where there are none.
void leave_out(Arguments& a) {
  CampaignOptions& o = a.campaign;
  if (!o.context.models->empty()) return;
  const std::size_t before = o.families.size();
  std::erase_if(o.families, [](const Family* f) { return f->info().rtl; });
  if (o.families.size() < before)
    fmt::print(stderr, "kage_extremes: {}: no models of the RTL there: {} families are left out\n", a.models,
               before - o.families.size());
  if (o.families.empty()) usage("no family is left");
}

int try_injections(Arguments& a) {
  leave_out(a);
  const CampaignOptions& o = a.campaign;
  const std::uint64_t starts = o.starts > 0 ? o.starts : kInjectionStarts;
  std::size_t unseen = 0;
  fmt::print("| family | error | seen in start |\n|---|---|---|\n");
  for (const Family* f : o.families) {
    const InjectionTrial t = try_injection(*f, o.seed, starts, o.context, [] { return signalled != 0; });
    if (signalled != 0) return 128 + signalled;
    fmt::print("| {} | {} | {} |\n", f->info().name, name_of(t.injection), t.seen ? std::to_string(*t.seen) : "none");
    unseen += t.seen ? 0 : 1;
  }
  fmt::print("\n{} of {} families see their error in {} starts\n", o.families.size() - unseen, o.families.size(),
             starts);
  return unseen == 0 ? 0 : 1;
}

int campaign(Arguments& a) {
  CampaignOptions& o = a.campaign;
  leave_out(a);
  if (!std::filesystem::is_directory(o.found)) usage(fmt::format("--found {}: no such folder", o.found.string()));
  o.stop = [] { return signalled != 0; };
  if (isatty(STDERR_FILENO) != 0)
    o.progress = [](double done, const CampaignState& s) {
      fmt::print(stderr, "\r{:3.0f} %, {:.0f} s, {:.2e} pixels, {} families failed ", 100 * done, s.seconds,
                 static_cast<double>(s.pixels()), s.failed());
    };
  TempFiles files;
  if (!a.json.empty()) files.add(a.json);  // whether it can be written shows now
  const CampaignState state = run_campaign(o);
  if (o.progress) fmt::print(stderr, "\r\033[K");
  fmt::print("{}", table_text(state, o.jobs));
  if (!a.json.empty()) {
    TempFiles out;
    write_text(out, a.json, table_json(state, o));
    out.commit();
  }
  if (state.failed() > 0) return 1;
  if (signalled != 0) return 128 + signalled;
  if (state.without_case() == 0) return 0;
  std::fflush(stdout);
  fmt::print(stderr, "kage_extremes: {} of {} families had no case: --minutes {:g} is too short for them\n",
             state.without_case(), state.families.size(), o.seconds / 60);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Arguments a = arguments(argc, argv);
    if (a.list) {
      for (const auto& f : all_families()) fmt::print("{:<12} {}\n", f->info().name, f->info().what);
      return 0;
    }
    struct sigaction action = {};
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    action.sa_handler = on_crash;
    sigaction(SIGSEGV, &action, nullptr);
    sigaction(SIGABRT, &action, nullptr);
    RtlModels models(a.models);
    a.campaign.context.models = &models;
    if (!a.files.empty()) return check_files(a);
    if (!a.one_case.empty()) return run_case(a);
    if (a.injections) return try_injections(a);
    return campaign(a);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
}
