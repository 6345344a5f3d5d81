// SPDX-License-Identifier: Apache-2.0
//
// A scene of a co-simulation: its frames, run by one thread or several, and what is found out about a difference.
#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cosim/diverge/divergence.hpp"
#include "cosim/model/model.hpp"
#include "cosim/ranges.hpp"
#include "cosim/recall.hpp"
#include "cosim/session/cores.hpp"
#include "cosim/session/frame_progress.hpp"
#include "cosim/session/models.hpp"
#include "cosim/session/run_page.hpp"
#include "cosim/session/source.hpp"
#include "file/out_folder.hpp"
#include "kage/cosim.hpp"
#include "stimulus/coverage.hpp"

namespace kage::cosim {

/// Where the line that repeats a run writes to: a folder beside the evidence in `out`, because a run removes what an
/// earlier one left in its own.
inline std::string again_folder(const std::filesystem::path& out) { return (out / "again").string(); }

/// As many jobs as processors, but no more than half of the machine's memory holds with 256 MiB a job.
int default_jobs();

/// A scene of the run. The steps come in this order; ranges run beside each other, in threads.
class SceneRun {
 public:
  /// Opens the scene; `o` names it as its input. `host` and `cores` must outlive it.
  SceneRun(const CosimOptions& o, Host& host, Cores& cores, std::int64_t frames_before);

  [[nodiscard]] const Source& source() const { return *source_; }
  [[nodiscard]] const CosimOptions& options() const { return o_; }
  [[nodiscard]] int total() const { return total_; }  ///< its frames
  /// How many of them the shard has.
  [[nodiscard]] int frames() const { return o_.frame >= 0 ? 1 : o_.shard.frames(total_, before_); }

  /// Makes its folder, its model, and so many ranges of its frames, or fewer.
  void prepare(int ranges);
  [[nodiscard]] int ranges() const { return static_cast<int>(parts_.size()); }

  /// Compares a range's frames. Failures are kept for finish().
  void run(int range);

  /// All ranges have ended: looks for the stage that differs first, and writes the page. The scene's files get their
  /// names with the others of `files`. Returns the scene's record; throws what ended a range before any difference.
  report::SceneRecord finish(TempFiles& files);

  /// After finish():
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  void note(std::string text) { notes_.push_back(std::move(text)); }
  [[nodiscard]] bool interrupted() const { return interrupted_; }  ///< after its verdict
  void interrupt() { interrupted_ = true; }

 private:
  /// The initial state in which the first frame is run besides.
  static constexpr std::uint64_t kOtherState = 1;
  /// Takes what the RTL writes in a frame that is run once more.
  static void unheard(int /*frame*/, std::string_view /*text*/) {}

  /// A range, and what its thread has for itself.
  struct Part {
    FrameRange range;
    std::unique_ptr<Source> share;  // none: the scene's own source
    std::unique_ptr<Listener> ear;  // likewise that of the report
    std::unique_ptr<verif::Coverage> coverage;
    TempFiles files;
    Report report;
    std::string rtl_text;  // what the RTL wrote in its frames, and is told by join()
    int begun = 0;         // of its frames: those compared, and what was made ahead of the comparison
    std::exception_ptr error;
  };

  [[nodiscard]] std::unique_ptr<Part> part_of(const FrameRange& range) const;
  void count_again(Part& part);
  void check_registers(Report& report);
  RunOptions run_options(const FrameRange& range, TempFiles& files);
  Feed heard_feed(Part& part);
  Report simulate(Part& part, const FrameRange& range);
  /// The report of frames that ran behind all those before them: nothing is left to try. Throws Error if a frame before
  /// them failed.
  static Report settled(Report report);
  Report run_rtl(Part& part, const FrameRange& range, const Feed& feed, Core& golden, RunOptions& options);
  void take_rtl_text(Part& part, std::string_view text) const;
  /// How many frames of the run come before the range.
  [[nodiscard]] int frames_before(const FrameRange& range) const {
    return (range.steps.first - steps_.first) / steps_.step;
  }
  [[nodiscard]] Source& source_of(Part& part) { return part.share ? *part.share : *source_; }

  // Verdicts of earlier runs: scene_recall.cpp.
  void open_verdicts();
  void no_verdicts(std::string why);
  Report recall(Part& part);
  Report simulate_and_keep(Part& part, const FrameRange& range, TempFiles& files);
  const Model& model();
  [[nodiscard]] report::VerdictsRecord verdicts_of(const Report& r) const;
  Report join(TempFiles& files);
  [[nodiscard]] ReplayOptions replay(ModelFor what) const;

  // After the verdict: scene_finish.cpp, scene_kept.cpp.
  struct Search {
    std::optional<Divergence> divergence;
    bool made = false;                     // the stage that differs first was looked for
    ModelFor model = ModelFor::kMonitors;  // by this model
  };
  bool after_verdict(const std::function<void()>& say);
  void look_into(TempFiles& files, const Report& r, Search& search);
  std::optional<Divergence> find_divergence(int frame, ModelFor model);
  void check_stages(Report& report, Search& search);
  void write_waveform(TempFiles& files, Divergence& divergence, int frame, ModelFor model);
  void write_page(TempFiles& files, const Report& r, const Search& search, report::SceneRecord& record);
  [[nodiscard]] bool differs_alone(const std::vector<std::uint32_t>& words, int number, bool prelude) const;
  void look_for_needs(report::KeptRecord& kept, const Difference& difference) const;
  report::KeptRecord keep_frame(TempFiles& files, const Difference& difference);
  [[nodiscard]] report::SceneRecord record_of(const Report& r) const;

  Host& host_;
  Cores& cores_;
  CosimOptions o_;  // with its input and its folder
  RtlOptions rtl_;
  std::unique_ptr<Source> source_;
  int total_ = 0;
  std::int64_t before_ = 0;  // frames of the scenes before it
  FrameSteps steps_;
  std::unique_ptr<OutFolder> folder_;
  Model model_;
  std::mutex model_mutex_;
  std::exception_ptr model_error_;
  std::optional<RunReport> report_;
  std::unique_ptr<verif::Coverage> coverage_;  // of all parts
  std::vector<std::unique_ptr<Part>> parts_;
  RunState state_;
  std::optional<RecallOptions> recall_;  // verdicts of earlier runs are taken, and kept for later ones
  std::string model_key_;                // of the RTL that they are of
  std::string no_verdicts_;              // why none is taken or kept though it was asked for
  std::atomic<int> verdicts_kept_{0};
  std::mutex progress_mutex_;
  std::unique_ptr<Progress> progress_;
  std::optional<FrameProgress> frame_progress_;
  std::vector<std::string> notes_;
  bool interrupted_ = false;
};

}  // namespace kage::cosim
