// SPDX-License-Identifier: Apache-2.0

/// @file
/// Co-simulation: every frame of a scene or a stream file goes through golden core and RTL, and every pixel is
/// compared. `kage cosim` and `kage regress` are made of what stands here.
///
/// The RTL is simulated by a model that Verilator makes of it on first use. That takes Verilator, a C++ compiler, and
/// kage's data (kage/paths.hpp); models are kept in ~/.cache/kage/models.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kage/defs.hpp"
#include "kage/geometry.hpp"
#include "kage/scene.hpp"

namespace kage::cosim {

/// The most frames of a run, and the most shards.
inline constexpr int kMostFrames = 1000000;

/// Thrown by Host::check() to end a run. It is no std::exception, so that no handler of errors takes it for one.
struct Interrupted {};

/// How far some work has come, for a person.
class Progress {
 public:
  virtual ~Progress() = default;

  /// Called up to several times a second, each text in place of the one before.
  /// @param text one line, without its end
  virtual void show(const std::string& text) = 0;

  /// The work is over, or something else is to be told: the line goes.
  virtual void clear() = 0;
};

/// The program in which a run takes place, as the run knows it. The functions are called by several threads. This one
/// is silent and never ends a run.
class Host {
 public:
  virtual ~Host() = default;

  /// Asked several times a second. Throws Interrupted to end the run; files are then as they were before. After the
  /// verdict it ends only what is found out about it.
  virtual void check() {}

  /// Whether check() would throw.
  /// @return true to end what is made better only with time
  [[nodiscard]] virtual bool interrupted() { return false; }

  /// Tells what is no result: that a model was damaged, what the RTL writes.
  /// @param text lines, each with its end
  virtual void say(const std::string& text);

  /// Some work begins.
  /// @return where it tells how far it is
  virtual std::unique_ptr<Progress> progress();

  /// A stream file is about to be mapped into memory: should it become shorter, reading it would end the program, which
  /// a host may guard against.
  /// @param path the file
  virtual void maps(const std::string& path);
};

/// A picture's size, in pixels.
struct Size {
  int width = 640;   ///< 1 to kMaxSize
  int height = 480;  ///< 1 to kMaxSize
};

/// Where frames come from, and how they are made. Each member is the option of `kage cosim` of that name.
struct SourceOptions {
  std::string input;                             ///< a built-in scene, a file, or random, random:damaged, random:mixed
  std::shared_ptr<const Scene> scene;            ///< it is drawn, and `input` only names it in messages
  Size size;                                     ///< of a scene's pictures
  bool size_given = false;                       ///< it was asked for: a stream, which has its own, refuses it
  int frames = 0;                                ///< 0: as many as the scene has
  std::string config;                            ///< a named configuration, a YAML file, or "plan"; empty: a cheap name
  std::optional<Config> parameters;              ///< the core's, in place of those of `config`, which only names them
  std::uint64_t seed = 1;                        ///< of everything random
  int threads = 0;                               ///< 0: one per processor
  bool degrade = false;                          ///< leave out what the configuration lacks, instead of refusing
  bool units_only = false;                       ///< polyhedra that find no unit are an error
  bool all_spans = false;                        ///< spans that have no effect on any pixel are written too
  TranslucentWay order = TranslucentWay::exact;  ///< of translucent faces
  double alpha = 1;                              ///< 1/255 to 1, multiplies that of every material
  bool cull = false;           ///< faces are not drawn if the eye sees the side that their material does not show
  bool allow_outside = false;  ///< files that a scene's file names may lie outside its folder
  std::optional<std::uint64_t> max_fragments;  ///< that the order of translucent faces may cut; none: order.hpp's
  int samples = Look{}.samples;                ///< of a light that is no point
  int classes = Look{}.classes;                ///< that a light table tells apart
  int max_shading = Look{}.max_shading;        ///< past which faces are diced, in steps of 255; 0: never
  int sub_bits = Look{}.sub_bits;              ///< of snapped positions
  Level level = Level::spans;                  ///< of the frames that are made
  std::string level_option;                    ///< by which a person asked for `level`, for messages; empty: no one did
};

/// How the RTL is run.
struct RtlRun {
  std::string fault;     ///< a deliberate defect of verif/cosim/model/faults.yaml; empty: none
  std::string netlist;   ///< ice40 or ecp5: the cells that yosys makes of the RTL run in its place
  int mutant = 0;        ///< from 1: a defect of verif/mutants; 0: none
  int idle = 0;          ///< 0 to 95 percent of clocks at random in which no input is offered
  int backpressure = 0;  ///< 0 to 95 percent of clocks at random in which no output is taken
};

/// The part of the frames that a run has. The frames of all its scenes, in the order given, are one list; of N shards,
/// shard I has the entries I - 1, I - 1 + N, I - 1 + 2 N, ... Frames that take long lie side by side, so shards that
/// take turns have equal work. The frames of a shard depend on nothing but I, N and the list.
struct Shard {
  int index = 1;       ///< from 1
  int count = 1;       ///< 1 to kMostFrames
  bool given = false;  ///< it was asked for, so that reports tell it

  /// @param before how many frames the scenes before it have
  /// @return its first frame of a scene; every `count`th follows
  [[nodiscard]] int first(std::int64_t before = 0) const {
    const std::int64_t first = index - 1 - before % count;
    return static_cast<int>(first < 0 ? first + count : first);
  }

  /// @param of a scene's frames
  /// @param before how many frames the scenes before it have
  /// @return how many of them are its own
  [[nodiscard]] int frames(int of, std::int64_t before = 0) const {
    const int own = first(before);
    return of <= own ? 0 : (of - 1 - own) / count + 1;
  }
};

/// Command lines that repeat a run or tell more of it, for those who read its report. Where they are empty, run() makes
/// them of the options.
struct CommandLines {
  std::string again;     ///< all of it
  std::string in_place;  ///< all of it, without --frame, --out and what decides which frames are run
  std::string rtl;       ///< its options on the RTL: "--fault stuck_flag --idle 30"
  std::string explain;   ///< its options that kage explain has, without those of `rtl`
};

/// A co-simulation: its scenes, and how they are run. Each member is the option of `kage cosim` of that name.
struct CosimOptions : SourceOptions {
  std::vector<std::string> inputs;  ///< several scenes, each as `input`; empty: `input`, or `scene`
  std::string out;                  ///< a folder for pictures and report.html; empty: no file is written
  int jobs = 0;                     ///< models at a time; 0: one per processor, as far as memory allows
  bool no_divergence = false;       ///< after a difference do not look for the stage that differs first
  bool stages = false;          ///< of frames that come out the same, hold what passes between the RTL's modules too
  RtlRun rtl;                   ///< how the RTL is run
  Shard shard;                  ///< which of the frames
  bool no_report = false;       ///< write pictures, and no report.html
  bool coverage = false;        ///< tell what the frames reach
  int frame = -1;               ///< the only one of each scene, on a core that has seen none before; -1: all
  bool no_shrink = false;       ///< a random frame that comes out different is kept as it is
  bool silent = false;          ///< no progress and nothing of what the RTL writes is told
  bool cache_verdicts = false;  ///< take and keep verdicts of frames (docs/ci.md)
  /// Asked before each frame but the first, and while registers are read; true ends the run there. It may be called by
  /// several threads.
  std::function<bool()> enough;
  CommandLines lines;  ///< for reports
};

/// The stage of the RTL that departs first from what the golden core does.
struct FirstDivergence {
  std::string module;       ///< "pixel_banked"
  std::string field;        ///< of what passes there
  std::string expected;     ///< its value in the golden core
  std::string actual;       ///< its value in the RTL
  int frame = 0;            ///< in which it is, which may be one before that of the first difference
  std::uint64_t cycle = 0;  ///< of the model's life
  std::uint64_t token = 0;  ///< its number in the frame
  std::string text;         ///< all of it, in one line
};

/// The first difference of a scene.
struct FirstDifference {
  std::optional<int> frame;                   ///< nothing: of registers, which random:mixed reads behind the frames
  std::optional<int> line;                    ///< from 0
  std::optional<int> x;                       ///< of a pixel, from 0
  std::string field;                          ///< "red", "line", "status" ...
  std::int64_t expected = 0;                  ///< of the golden core
  std::int64_t actual = 0;                    ///< of the RTL
  std::string text;                           ///< all of it, in one line
  std::optional<FirstDivergence> divergence;  ///< if it was looked for and found
};

/// The result of a scene.
struct SceneResult {
  std::string scene;                          ///< its name
  std::string config;                         ///< the configuration's name
  bool same = true;                           ///< nothing differs
  int frames = 0;                             ///< that were compared
  std::uint64_t pixels = 0;                   ///< that were compared
  std::uint64_t spans = 0;                    ///< of the frames compared
  std::uint64_t segments = 0;                 ///< of the frames compared
  std::uint64_t cycles = 0;                   ///< of the RTL
  std::optional<FirstDifference> difference;  ///< there unless it is the same
  std::vector<std::string> pictures;          ///< files, in `out`: of the frames, or of those that differ
  std::vector<std::string> notes;             ///< sentences for a person
};

/// The result of a run.
struct CosimResult {
  bool same = true;                 ///< of all scenes
  bool interrupted = false;         ///< after the verdict, while more was found out about it
  std::vector<SceneResult> scenes;  ///< in the order of the inputs
  std::string json;                 ///< what `kage cosim --json` writes: docs/schema/cosim.json
};

/// Compares all frames of all scenes. Where there is a difference it ends its scene and is looked into. Files in `out`
/// appear together at the end. Throws Error where there can be no verdict: a scene or configuration that cannot be
/// read, a model that cannot be built; and Interrupted.
/// @param options what is run
/// @param host the program, which must outlive the call
/// @return what came of it
CosimResult run(const CosimOptions& options, Host& host);

/// The same without a word, and without an end before its own.
/// @param options what is run
/// @return what came of it
CosimResult run(const CosimOptions& options);

}  // namespace kage::cosim
