// SPDX-License-Identifier: Apache-2.0
#include "cosim/regress/rounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <set>
#include <utility>

#include "cosim/session/command_lines.hpp"
#include "cosim/session/option_names.hpp"
#include "kage/error.hpp"
#include "kage/scene.hpp"
#include "stimulus/random_frames.hpp"

namespace kage::cosim {
namespace {

/// Percent of clocks without input, and without output taken.
struct StallPattern {
  int idle;
  int backpressure;
};
constexpr std::array kStalls{StallPattern{0, 0}, StallPattern{30, 30}, StallPattern{0, 70}, StallPattern{60, 0}};

/// Random frames of a run. In the first round they are few: most defects show in the first frames of some
/// configuration, so every configuration has its first frames before any has many.
constexpr int kFirstFrames = 20;
constexpr int kFrames = 60;

/// Sources by the order of their runs, as indices of verif::kRandomSources: random, random:mixed, random:damaged. This
/// order finds a mutant in the least time on average: tools/regress-mutants --each prints that time for each order.
constexpr std::array<std::size_t, 3> kSourcesInOrder{0, 2, 1};
static_assert(kSourcesInOrder.size() == verif::kRandomSources.size());

/// Width of a scene's frames where the configuration has it. Small, but pixel centres are where `depths` wants them.
constexpr int kSceneWidth = 160;

/// A configuration in a run's name, which is a folder's too, and stands in lines of text. It is the name of a file
/// without its folders and ending, with all that could be read as anything but a name replaced.
std::string short_name(const NamedConfig& c) {
  std::string name = std::filesystem::path(c.name).stem().string();
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-' && letter != '_') letter = '_';
  return name;
}

class Round {
 public:
  Round(int round, const RegressRun& how) : round_(round), how_(how) {}

  void random(const NamedConfig& c, std::size_t source) {
    CosimOptions o;
    o.input = verif::kRandomSources[source].name;
    o.frames = round_ == 0 ? kFirstFrames : kFrames;
    const std::string what = o.input.substr(o.input.find(':') + 1);
    add(what, c, source, std::move(o));
  }

  void scene(const NamedConfig& c, const std::string& scene) {
    CosimOptions o;
    o.input = scene;
    const int width = std::min(kSceneWidth, c.config.max_width);
    o.size = {width, std::max(1, width * 3 / 4)};
    o.size_given = true;
    o.degrade = true;
    o.all_spans = true;  // the RTL has ties and hidden spans to compare, too
    // Scenes and patterns of stalls would come round together: 4 divides 12.
    add(scene, c, static_cast<std::size_t>(round_) / builtin_scenes().size(), std::move(o));
  }

  std::vector<RoundRun> runs;

 private:
  void add(const std::string& what, const NamedConfig& c, std::size_t shift, CosimOptions o) {
    const StallPattern& stalls = kStalls[(static_cast<std::size_t>(round_) + shift) % kStalls.size()];
    o.config = c.name;
    o.seed = how_.seed + static_cast<std::uint64_t>(round_);
    o.jobs = 1;  // one core gets all frames, so a history of them shows
    o.rtl = how_.rtl;
    o.rtl.idle = stalls.idle;
    o.rtl.backpressure = stalls.backpressure;
    if (how_.level || c.config.active > 0) {
      o.level = how_.level.value_or(Level::polygons);
      o.level_option = "--front-end " + front_end_of(o.level);
    }
    o.lines = command_lines(o);
    runs.push_back({fmt::format("{}.{}.{}", what, short_name(c), round_), c.name, round_, std::move(o)});
  }

  int round_;
  const RegressRun& how_;
};

}  // namespace

std::vector<RoundRun> runs_of_round(const std::vector<NamedConfig>& configs, int round, const RegressRun& how) {
  std::set<std::string> names;
  for (const NamedConfig& c : configs)
    if (!names.insert(short_name(c)).second)
      throw Error(fmt::format("--config: two configurations are called {}", short_name(c)));
  Round r(round, how);
  for (const std::size_t source : kSourcesInOrder)
    for (const NamedConfig& c : configs) r.random(c, source);
  const std::vector<std::string>& scenes = builtin_scenes();
  for (std::size_t i = 0; i < configs.size(); ++i)
    r.scene(configs[i], scenes[(static_cast<std::size_t>(round) + i) % scenes.size()]);
  return std::move(r.runs);
}

}  // namespace kage::cosim
