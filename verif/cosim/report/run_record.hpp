// SPDX-License-Identifier: Apache-2.0
//
// Results of a run: the one record that kage cosim, kage regress and kage merge make. JSON, pages, JUnit and the text
// are made of it. docs/schema/cosim.json, regress.json and merge.json say what each key of the JSON means.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cosim/diverge/divergence.hpp"
#include "cosim/run.hpp"
#include "kage/defs.hpp"

namespace kage::report {

using Json = nlohmann::ordered_json;

/// Options that decide words and clocks besides scene, size, configuration and seed.
struct OptionsRecord {
  std::string fault;               ///< or empty
  std::string netlist;             ///< ice40, ecp5, or empty: the RTL itself
  std::string front_end = "host";  ///< host or rtl: who makes spans of polygons
  int idle = 0;                    ///< percent of clocks
  int backpressure = 0;            ///< percent of clocks
  bool stages = false;             ///< each stage of frames that come out the same is held too
  bool degrade = false;
  std::string order;
  double alpha = 1;
  bool cull = false;
  int samples = 0;
  int classes = 0;
  int max_shading = 0;
  int sub_bits = 0;
  bool all_spans = false;  ///< those without effect too

  bool operator==(const OptionsRecord&) const = default;
};

/// How a component of the scene was drawn, or so many neighbours: in how many frames by a unit, in how many by spans.
struct WayRecord {
  std::string object;
  std::uint64_t component = 0;   ///< the first one
  std::uint64_t components = 1;  ///< how many
  std::uint64_t unit_frames = 0;
  std::uint64_t span_frames = 0;
  std::optional<std::string> why;  ///< it became spans
};
using WayRecords = std::optional<std::vector<WayRecord>>;  ///< nothing where the configuration has no units

/// A frame that was compared.
struct FrameRecord {
  int frame = 0;
  bool same = true;
  bool taken = false;  ///< the verdict is that of an earlier run, and so are the clocks
  std::uint64_t cycles = 0;
  cosim::Stalls stalls;
  cosim::PhaseStalls phase_stalls{};
  std::uint64_t spans = 0;
  std::uint64_t span_pixels = 0;
  std::uint64_t segments = 0;
  std::uint64_t words = 0;
};

/// Where the RTL departs first: cosim::Divergence as it is told.
struct DivergenceRecord {
  int frame = 0;
  std::optional<int> line;
  std::optional<int> x;
  std::string module;
  std::string what;
  std::string field;
  std::string expected;
  std::string actual;
  std::uint64_t cycle = 0;
  std::uint64_t token = 0;
  std::optional<std::string> token_text;
  std::optional<std::string> source;
  std::optional<std::string> waits;
  std::optional<std::string> save_file;
  bool initial_state = false;
  std::string text;

  /// "rtl/pixel_banked.sv"
  [[nodiscard]] std::string file() const { return "rtl/" + module + ".sv"; }
};

/// The first difference of what came out: cosim::Difference as it is told, and what was found out about it.
struct DifferenceRecord {
  std::optional<int> frame;  ///< nothing: of the register check behind the frames
  std::optional<int> line;
  std::optional<int> x;
  std::string field;
  std::int64_t expected = 0;
  std::int64_t actual = 0;
  std::optional<std::string> assertion;
  std::optional<std::string> waveform;
  std::string text;
  bool searched = false;                     ///< the stage that differs first was looked for
  std::optional<std::string> no_divergence;  ///< and none was found: where to look
  std::optional<DivergenceRecord> divergence;
};

/// A frame that was kept as a stream file, as small as it could be made.
struct KeptRecord {
  std::string file;
  bool ahead = false;                ///< it is the frame that was put right ahead of the one in which that showed
  bool alone = false;                ///< it comes out different by itself
  std::optional<std::string> takes;  ///< what it takes besides, if it does not
  bool in_place = false;             ///< it does not, but --frame does it: `again` is that
  std::uint64_t lines = 0;
  std::uint64_t tokens = 0;
  int width = 0;
  std::uint64_t words = 0;
  std::uint64_t words_before = 0;
  std::string again;  ///< the command line that runs it
};

/// Verdicts of earlier runs.
struct VerdictsRecord {
  bool cached = false;  ///< they were taken and kept, where that may be
  std::vector<int> taken_frames;
  std::uint64_t kept = 0;
  std::optional<std::string> trouble;
};

struct CoveragePointRecord {
  std::string group;
  std::string name;
  std::uint64_t frames = 0;
};

struct CoverageRecord {
  std::uint64_t frames = 0;
  std::vector<CoveragePointRecord> points;
};

/// Shard `index`, from 1, of `count`.
struct ShardNumber {
  int index = 1;
  int count = 1;
};

/// Frames of a scene, and the run that compared them.
struct PartRecord {
  bool same = true;
  int frames = 0;  ///< compared; 0: a shard that has none of the scene, of which nothing but its name is known
  int first_frame = 0;
  int frame_step = 1;
  double golden_seconds = 0;
  double rtl_seconds = 0;
  std::string again;  ///< the command line
  std::string folder;
  std::string rtl;
  std::vector<std::string> versions;
  std::optional<std::string> page;  ///< report.html
  std::optional<std::string> page_crc32;
  WayRecords ways;
  std::optional<DifferenceRecord> first_difference;  ///< there unless it is the same
};

/// A shard's part of a joined scene.
struct ShardRecord : PartRecord {
  ShardNumber number;
  std::string file;  ///< that its report came from
};

/// Counts of a board's screen.
struct BoardScreenRecord {
  std::uint64_t shown = 0;            ///< screens that began a frame
  std::uint64_t late = 0;             ///< screens that had none to begin
  std::uint64_t underrun_frames = 0;  ///< these, and those with a line that ran short
  std::uint64_t underrun_lines = 0;
};

/// Frames of the link to a board.
struct BoardLinkRecord {
  std::uint64_t sent = 0;      ///< by the host, each time counted
  std::uint64_t resent = 0;    ///< of these, those that had been sent before
  std::uint64_t damaged = 0;   ///< that came from the board and were not whole
  std::uint64_t good = 0;      ///< that came to the board right, from the greeting on
  std::uint64_t bad = 0;       ///< likewise, others
  std::uint64_t overruns = 0;  ///< likewise, right ones for which there was no room
};

/// Frames that a board played over and over.
struct BoardLoopRecord {
  std::uint64_t frames = 0;
  std::uint64_t repetitions = 0;
  std::uint64_t lines = 0;
  std::uint64_t mismatches = 0;  ///< lines that differed
  double seconds = 0;
  bool left = false;  ///< the board goes on
  BoardScreenRecord screen;
};

/// Further results of a run on a board (kage board).
struct BoardRecord {
  std::string name;
  std::string port;
  std::uint64_t lines_compared = 0;
  std::uint64_t lines_different = 0;
  std::uint64_t registers_compared = 0;
  std::uint64_t runs = 0;
  std::uint64_t direct = 0;
  double seconds = 0;
  BoardScreenRecord screen;
  BoardLinkRecord link;
  std::optional<BoardLoopRecord> loop;
};

/// Results of a scene, by one run or, joined, by all shards of it.
struct SceneRecord : PartRecord {
  std::string scene;
  int total_frames = 0;
  std::optional<ShardNumber> shard;
  OptionsRecord options;
  std::string config_name;
  Config config;
  std::uint64_t seed = 0;
  int width = 0;            ///< of the widest frame
  int height = 0;           ///< of the highest one
  bool sizes_vary = false;  ///< JSON of a joined one does not say
  bool own_sizes = false;   ///< frames bring their sizes, as random ones do, and those of a stream file
  std::uint64_t pixels_compared = 0;
  std::uint64_t spans = 0;
  std::uint64_t span_pixels = 0;
  std::uint64_t segments = 0;
  std::uint64_t units = 0;
  std::uint64_t cycles = 0;
  cosim::Stalls stalls;
  std::vector<std::optional<double>> frame_seconds;  ///< of a joined one nothing where a frame was not compared
  std::vector<FrameRecord> each;                     ///< cosim::Report::each
  VerdictsRecord verdicts;
  double build_seconds = 0;
  std::vector<std::string> degraded;
  std::vector<std::string> pictures;
  std::optional<KeptRecord> kept;
  std::vector<std::string> notes;
  std::optional<CoverageRecord> coverage;
  std::optional<BoardRecord> board;  ///< the actual core was one on a board
  bool joined = false;               ///< by kage merge: again, folder, rtl, page and kept are the shards' own
  std::vector<ShardRecord> shards;

  /// Takes what cosim::run() reports of frames.
  void take(const cosim::Report& report);
};

/// Results of kage regress besides its runs.
struct RegressRecord {
  std::string again;
  int rounds = 0;
  std::uint64_t seed = 0;
  double seconds = 0;
  double build_seconds = 0;
  bool interrupted = false;
  std::optional<std::string> trouble;  ///< a run that came to no verdict ended it: which, and why

  /// Start of headlines, before the number of runs: "interrupted after ", or nothing where all went its way.
  [[nodiscard]] const char* ended() const {
    return trouble ? "ended by trouble after " : interrupted ? "interrupted after " : "";
  }
};

/// Sums over scenes that have frames.
struct TotalsRecord {
  bool same = true;
  std::uint64_t frames = 0;
  std::uint64_t total_frames = 0;  ///< of all scenes
  std::uint64_t pixels_compared = 0;
  std::uint64_t spans = 0;
  std::uint64_t span_pixels = 0;
  std::uint64_t segments = 0;
  std::uint64_t cycles = 0;
  cosim::Stalls stalls;
  bool cached = false;
  std::uint64_t taken = 0;  ///< frames whose verdicts are those of earlier runs
  std::uint64_t kept = 0;
  std::optional<std::string> trouble;
  double golden_seconds = 0;
  double rtl_seconds = 0;
  double build_seconds = 0;
};

/// Results of a run.
struct RunRecord {
  std::vector<SceneRecord> scenes;  ///< those of kage regress are its runs
  bool several = false;             ///< the JSON has `scenes`, and sums over them
  bool merged = false;              ///< by kage merge
  std::optional<std::string> page;  ///< the page over several scenes or shards
  std::optional<RegressRecord> regress;

  [[nodiscard]] TotalsRecord totals() const;
  /// The first scene that has frames. There is one in every run.
  [[nodiscard]] const SceneRecord& any() const;
  /// The first scene that has a difference, or nullptr.
  [[nodiscard]] const SceneRecord* different() const;
  /// The schema of its JSON: "kage.cosim/1".
  [[nodiscard]] std::string_view schema() const;

  /// Reads what to_json() made. Throws Error without a file's name: of another version, or "KEY is not what it should
  /// be", with its place. Values that the JSON has twice, as sums, are made anew. Unknown keys are passed over.
  static RunRecord from_json(const Json& json);
};

inline constexpr std::string_view kCosimSchema = "kage.cosim/1";
inline constexpr std::string_view kMergeSchema = "kage.merge/1";
inline constexpr std::string_view kRegressSchema = "kage.regress/1";

/// With "schema" as its first key.
Json to_json(const RunRecord& record);
Json to_json(const SceneRecord& record);
Json to_json(const FrameRecord& record);
Json to_json(const std::optional<DifferenceRecord>& record);
Json to_json(const WayRecords& ways);
/// The parameters as an object, in the order of the definition file.
Json to_json(const Config& config);

/// Throws Error, as RunRecord::from_json().
WayRecords ways_from_json(const Json& json);

/// The first difference of the pixels, and the stage that it came of where one was looked for and found.
std::optional<DifferenceRecord> difference_record(const std::optional<cosim::Difference>& difference,
                                                  const std::optional<cosim::Divergence>& divergence, bool searched);

}  // namespace kage::report
