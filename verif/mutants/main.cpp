// SPDX-License-Identifier: Apache-2.0
// Tries mutants of the RTL, prints a table of what became of each, and fails if one lives or is blamed on another
// module.
//
// usage: mutants [--markdown] [--sample N | NAME...]
//        mutants --speed     what monitors and mutants cost in clocks a second
//
// Without names all of verif/mutants/mutants.yaml. Frames are by $KAGE_SEED; what lives through them is given those of
// the next seven seeds. Which N a sample has is by a seed that is printed: $KAGE_SEED, else another one in each run.
// $KAGE_SHARD=I/N: of all, the Ith of N parts.
// Exit code 0: all as they should be; 1: not; 2: trouble.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <utility>

#include "cosim/model/model.hpp"
#include "kage/error.hpp"
#include "kage/paths.hpp"
#include "mutants/list.hpp"
#include "mutants/trial.hpp"
#include "stimulus/random.hpp"
#include "stimulus/shard.hpp"

namespace kage::verif {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct Result {
  Mutant mutant;
  std::string config;  ///< in which it was found out
  std::string expected;
  std::optional<TrialVerdict> verdict;
  std::uint64_t set = 0;  ///< of frames, that found it out

  [[nodiscard]] bool right() const { return verdict && verdict->module == expected; }
  [[nodiscard]] bool fine() const {
    if (!mutant.equivalent.empty() || !mutant.lives.empty()) return !verdict;
    return mutant.named.empty() ? right() : verdict.has_value();
  }
};

/// A mutant that lives is given other frames, so many times at most: some need what a set of frames has by chance only.
constexpr std::uint64_t kSets = 8;

/// A configuration with its model, and its frames by number of the set; made when first asked for.
class Trials {
 public:
  explicit Trials(std::uint64_t seed) : seed_(seed), all_(trial_configurations()) {}

  [[nodiscard]] const std::vector<Inputs>& all() const { return all_; }

  std::optional<TrialVerdict> attempt(std::size_t i, std::uint64_t set, int mutant) {
    const auto [it, is_new] = sets_.try_emplace({i, set}, all_[i]);
    Inputs& inputs = it->second;
    std::filesystem::path& library = libraries_[i];
    if (library.empty()) library = cosim::find_model(inputs.config, {.monitors = true, .mutants = true}).library;
    if (is_new) {
      make_frames(inputs, seed_ + set);
      for (Sequence& s : inputs.sequences) s.rtl.text = [](int, std::string_view) {};  // else each failed assertion
      // No mutant selected: the same. Without that no verdict means anything.
      if (const auto v = try_mutant(library, inputs, 0))
        throw Error(fmt::format("configuration {}: the sound RTL is {}: {}", inputs.name, v->how, v->text));
      if (const auto text = sound_divergence(library, inputs))
        throw Error(fmt::format("configuration {}: a stage of the sound RTL differs: {}", inputs.name, *text));
      fmt::print(stderr, "configuration {}, frames by seed {}: the sound RTL is the same\n", inputs.name, seed_ + set);
    }
    return try_mutant(library, inputs, mutant);
  }

 private:
  std::uint64_t seed_;
  std::vector<Inputs> all_;
  std::map<std::pair<std::size_t, std::uint64_t>, Inputs> sets_;
  std::map<std::size_t, std::filesystem::path> libraries_;
};

Result run(const Mutant& m, Trials& trials) {
  Result r{m, "", "", std::nullopt};
  // Where it is known that these frames do not reach it, or that none can, one set is enough.
  const std::uint64_t sets = m.equivalent.empty() && m.lives.empty() ? kSets : 1;
  for (std::uint64_t set = 0; set < sets && !r.verdict; ++set)
    for (std::size_t i = 0; i < trials.all().size() && !r.verdict; ++i) {
      const Inputs& inputs = trials.all()[i];
      if (!m.configs.empty() && std::find(m.configs.begin(), m.configs.end(), inputs.name) == m.configs.end()) continue;
      r.config = inputs.name;
      r.expected = m.module_in(inputs.config);
      r.verdict = trials.attempt(i, set, m.number);
      r.set = set;
    }
  return r;
}

std::string end_of(const Result& r, std::uint64_t seed) {
  if (!r.verdict) return r.mutant.equivalent.empty() ? "LIVES" : "equivalent";
  return r.set == 0 ? r.verdict->how : fmt::format("{} (seed {})", r.verdict->how, seed + r.set);
}

void print_row(const Result& r, std::uint64_t seed) {
  const std::string module = r.verdict ? r.verdict->module : "";
  const std::string named = r.verdict && !r.right() ? fmt::format("{} (not {})", module, r.expected) : module;
  fmt::print("{:<22} {:<18} {:<16} {:<18} {}\n", r.mutant.name, std::filesystem::path(r.mutant.file).stem().string(),
             r.verdict ? r.config : "", end_of(r, seed), named);
  if (r.verdict && !r.right()) fmt::print("    {}\n", r.verdict->text);
  std::fflush(stdout);
}

/// A row for each file of rtl/, in the order of their first mutants. The last column has the mutants that are not
/// killed, and those for which another module is named.
void print_table(const std::vector<Result>& results) {
  struct Row {
    std::string file;
    int mutants = 0;
    int killed = 0;
    int right = 0;
    std::string others{};
  };
  std::vector<Row> rows;
  for (const Result& r : results) {
    auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& x) { return x.file == r.mutant.file; });
    if (row == rows.end()) row = rows.insert(rows.end(), Row{.file = r.mutant.file});
    const bool right = r.verdict && r.right();
    ++row->mutants;
    row->killed += r.verdict ? 1 : 0;
    row->right += right ? 1 : 0;
    if (!right)
      row->others += fmt::format("{}{}: {}", row->others.empty() ? "" : ", ", r.mutant.name,
                                 r.verdict                     ? r.verdict->module
                                 : r.mutant.equivalent.empty() ? "lives"
                                                               : "equivalent");
  }
  fmt::print("| of `rtl/` | mutants | killed | named right | the others |\n|---|---|---|---|---|\n");
  for (const Row& r : rows)
    fmt::print("| {} | {} | {} | {} | {} |\n", std::filesystem::path(r.file).lexically_relative("rtl").string(),
               r.mutants, r.killed, r.right, r.others);
}

/// Throws Error if a mutant asks for a configuration that there is not: it would be tried nowhere.
void check_configs(const std::vector<Mutant>& all, const std::vector<Inputs>& configs) {
  for (const Mutant& m : all)
    for (const std::string& name : m.configs)
      if (std::none_of(configs.begin(), configs.end(), [&](const Inputs& i) { return i.name == name; }))
        throw Error(fmt::format("verif/mutants/mutants.yaml: {}: no configuration {}", m.name, name));
}

std::vector<Mutant> chosen(std::vector<Mutant> all, const std::vector<std::string>& names, int sample,
                           std::uint64_t seed) {
  if (sample > 0) {
    Random random(seed);
    random.shuffle(all);
    all.resize(std::min(all.size(), static_cast<std::size_t>(sample)));
    std::sort(all.begin(), all.end(), [](const Mutant& a, const Mutant& b) { return a.number < b.number; });
  }
  if (names.empty()) {
    if (sample > 0) return all;
    std::erase_if(all, [shard = test_shard(), count = all.size()](const Mutant& m) {
      return !shard.has(static_cast<std::size_t>(m.number - 1), count);
    });
    return all;
  }
  std::vector<Mutant> some;
  for (const std::string& name : names) {
    const auto it = std::find_if(all.begin(), all.end(), [&](const Mutant& m) { return m.name == name; });
    if (it == all.end()) throw Error(fmt::format("{}: no such mutant in verif/mutants/mutants.yaml", name));
    some.push_back(*it);
  }
  return some;
}

// Simulated clocks a second of the first configuration's frames.
void print_speed() {
  Inputs inputs = trial_configurations().front();
  make_frames(inputs, 1);
  const auto measure = [&](const char* name, const cosim::ModelOptions& options) {
    const auto library = cosim::find_model(inputs.config, options).library;
    std::uint64_t clocks = 0;
    double seconds = 0;
    for (int round = 0; round < 20; ++round) {
      const auto rtl = make_rtl(library, inputs.config, inputs.sequences.front().rtl);
      for (const cosim::KnownFrame& f : inputs.sequences.front().frames) {
        const cosim::FrameEnd end = rtl->frame(f.words, cosim::kNowhere);
        clocks += end.cycles;
        seconds += end.seconds;
      }
    }
    fmt::print("{:<28} {:.0f} clocks a second\n", name, static_cast<double>(clocks) / seconds);
  };
  measure("plain", {});
  measure("with mutants", {.mutants = true});
  measure("with monitors", {.monitors = true});
  measure("with monitors and mutants", {.monitors = true, .mutants = true});
}

int run_all(std::vector<std::string> arguments) {
  bool markdown = false;
  int sample = 0;
  std::uint64_t seed = test_seed();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--speed") {
      print_speed();
      return 0;
    }
    if (arguments[i] == "--markdown") {
      markdown = true;
    } else if (arguments[i] == "--sample" && i + 1 < arguments.size()) {
      sample = std::stoi(arguments[++i]);
      seed = test_seed(std::random_device()());
      fmt::print("a sample by KAGE_SEED={}\n", seed);
    } else if (arguments[i].starts_with("--")) {
      throw Error("usage: mutants [--markdown] [--sample N | NAME...], or --speed");
    } else {
      names.push_back(arguments[i]);
    }
  }
  const auto all = load_mutants(data_directory() / "verif/mutants/mutants.yaml");
  check_configs(all, trial_configurations());
  const auto mutants = chosen(all, names, sample, seed);
  const auto start = Clock::now();
  Trials trials(test_seed());
  std::vector<Result> results;
  for (const Mutant& m : mutants) {
    results.push_back(run(m, trials));
    if (!markdown)
      print_row(results.back(), test_seed());
    else
      fmt::print(stderr, "{}: {}\n", m.name, end_of(results.back(), test_seed()));
  }
  if (markdown) print_table(results);

  const auto count = [&](auto is) { return std::count_if(results.begin(), results.end(), is); };
  const auto equivalent = count([](const Result& r) { return !r.mutant.equivalent.empty(); });
  const auto killed = count([](const Result& r) { return r.mutant.equivalent.empty() && r.verdict; });
  const auto further = count([](const Result& r) { return r.verdict && r.set > 0; });
  const auto right = count([](const Result& r) { return r.mutant.equivalent.empty() && r.right(); });
  const auto wanted = static_cast<std::ptrdiff_t>(results.size()) - equivalent;
  fmt::print(
      "{}{} mutants, {} of them equivalent; of the other {}: {} killed, {} of these by further seeds, {} live; {} "
      "named "
      "right, {} wrong; {:.0f} s\n",
      markdown ? "\n" : "", results.size(), equivalent, wanted, killed, further, wanted - killed, right, killed - right,
      since(start));
  return std::all_of(results.begin(), results.end(), [](const Result& r) { return r.fine(); }) ? 0 : 1;
}

}  // namespace
}  // namespace kage::verif

int main(int argc, char** argv) {
  try {
    return kage::verif::run_all({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    fmt::print(stderr, "mutants: {}\n", e.what());
    return 2;
  }
}
