// SPDX-License-Identifier: Apache-2.0
//
// Figures of one point of a sweep: accuracy, speed, cost (docs/sweep.md says how each figure is measured).
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <shared_mutex>
#include <string>
#include <vector>

#include "cosim/model/model.hpp"
#include "explore/kept.hpp"
#include "explore/placement.hpp"
#include "explore/sweep_accuracy.hpp"
#include "explore/sweep_points.hpp"
#include "explore/sweep_scene.hpp"
#include "explore/synthesis.hpp"

namespace kage::explore {

/// Names and versions of the tools that figures come from, so far as a sweep uses them.
struct SweepTools {
  std::string yosys = {};  ///< counts cells
  std::string model = {};  ///< Verilator and compiler, which make RTL models
};

/// How a sweep measures, and whom it tells.
struct SweepHow {
  bool area = true;   ///< yosys counts cells; else they are estimated
  bool cosim = true;  ///< clocks come from the RTL; else from the design
  bool flip = true;
  SweepTools tools = {};
  Placer* placer = nullptr;                       ///< places cores; null: none is placed
  std::function<void()> wait;                     ///< called often, by several threads; what it throws ends the run
  std::function<void(const std::string&)> doing;  ///< called before and during what takes long
};

/// Sums over error maps, by their names in docs/schema/sweep.json.
nlohmann::ordered_json error_json(const PictureError& e);
/// Errors of light as JSON, likewise.
nlohmann::ordered_json light_json(const LightErrors& e);

/// The clocks of a co-simulation beside those that the design foretells for the same words (cost/token_clocks.hpp).
struct ClockSample {
  std::uint64_t cycles = 0;
  std::uint64_t foretold = 0;
  double seconds = 0;  ///< of the model's work
};

/// The words of a point's frames, and what is known of them without a core.
struct PointWords {
  std::vector<std::vector<std::uint32_t>> frames;
  std::uint64_t words = 0;
  std::uint64_t foretold = 0;  ///< clocks by design
  int longest_depth = 0;       ///< pixels along which depth goes on by steps
  std::string hash;            ///< SHA-256 of all
};
PointWords words_of(SweepScene& scene, const SweepPoint& point);

class SweepRunner {
 public:
  /// `points` are all points of the sweep, shards or not: of those with the same features the first is co-simulated,
  /// and of the others three, to show that both ways to their clocks agree.
  SweepRunner(SweepScene& scene, std::vector<SweepPoint> points, SweepHow how);

  /// The words of a point; the thread is not one that is alone.
  PointWords words(std::size_t index);

  /// Whether a point's figures need something of its core that prepare() makes.
  [[nodiscard]] bool needs_core(std::size_t index) const;
  /// Has all that run() needs of a point's core made and kept: its RTL model, its cells, its placement. For several
  /// threads at once: where every core is made before the first run(), no thread that measures time waits for one.
  void prepare(std::size_t index);

  /// A point's figures by their names in docs/schema/sweep.json: accuracy, speed and area. For several threads at once;
  /// where time is measured, the thread waits until it is alone.
  nlohmann::ordered_json run(std::size_t index, const PointWords& words);

  /// Clocks of a point that are known from an earlier run, so that it need not be co-simulated.
  void know_clocks(std::size_t point, const ClockSample& sample);
  /// Told, by several threads, of each point that was co-simulated; set before the first run().
  std::function<void(std::size_t point, const ClockSample& sample)> keep_clocks;

  /// The point whose clocks stand for those of this one: itself, if it is the one that is co-simulated.
  [[nodiscard]] std::size_t representative(std::size_t point) const { return stands_for_[point]; }
  /// The source of a point's clocks as text: part of the key of its row.
  [[nodiscard]] std::string clocks_text(std::size_t index) const;
  /// The tools that a point's figures come from, with their versions: part of the key of its row.
  [[nodiscard]] std::string tools_text(std::size_t index) const;

 private:
  nlohmann::ordered_json accuracy(const SweepPoint& point, const PointWords& words);
  nlohmann::ordered_json speed(std::size_t index, const PointWords& words);
  nlohmann::ordered_json area(const SweepPoint& point);
  cosim::Model model_of(const SweepPoint& point);
  CellCount cells_of(const SweepPoint& point);
  Placement placement(const SweepPoint& point);
  ClockSample clocks_of(std::size_t index, const PointWords* given);
  ClockSample simulate(const SweepPoint& point, const PointWords& words);

  SweepScene* scene_;
  std::vector<SweepPoint> points_;
  SweepHow how_;
  std::vector<std::size_t> stands_for_;
  std::vector<bool> checked_;   // co-simulated besides
  std::shared_mutex alone_;     // held alone where time is measured
  std::mutex build_mutex_;      // one model at a time is built
  Kept<ClockSample> clocks_;    // by the point's number
  Kept<CellCount> counts_;      // by the configuration
  Kept<Placement> placements_;  // likewise
};

/// Whether the core's model is built, its cells are counted and it is placed: one with a processor for each of more
/// than 64 columns would take too long.
bool is_built(const Config& config);

/// The key under which a store keeps something: SHA-256 of all that decides it.
std::string key_of(const std::vector<std::string>& parts);

/// Identity of a build of this program: `name`, if it names a commit and nothing is changed, as results then follow
/// from it; else SHA-256 of the program's file besides.
std::string build_identity(const std::string& name);

/// The scene and size of a row, "courtyard at 320x240": rows are compared with those of the same.
std::string group_of(const nlohmann::ordered_json& row);

/// Marks the rows that no other row of the same scene and size beats. A row beats another if it is at least as good in
/// wrong pixels, error of colour, clocks a pixel and look-up tables, and better in one; figures are compared in steps
/// of 1 %. Rows have `scene`, `config` (with `width`, `height` in `look`), `accuracy`, `speed` and `area`.
std::vector<bool> pareto(const std::vector<nlohmann::ordered_json>& rows);

}  // namespace kage::explore
