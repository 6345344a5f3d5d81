// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cosim/report/run_record.hpp"
#include "cosim/session/component_ways.hpp"
#include "cosim/session/polygon_ways.hpp"
#include "cosim/session/remarks.hpp"
#include "kage/config.hpp"
#include "kage/cosim.hpp"
#include "kage/pipeline.hpp"
#include "kage/scene.hpp"
#include "kage/stream.hpp"
#include "stimulus/random_frames.hpp"

namespace kage::cosim {

/// The name of pictures and of lines of output: a line break in a file's name would begin a line of its own.
std::string plain_name(const std::filesystem::path& path);

/// Throws Error if a file is a visibility order's tree: no command but order takes one.
void refuse_order_tree(const std::string& path);

/// Loads a scene. Throws Error too if the run writes a file that the scene consists of.
Scene load_scene(const std::string& input, const SourceOptions& options, Host& host);
Scene load_scene(const std::string& input, const SourceOptions& options, Host& host, double alpha);

/// How a scene is drawn, as the options say. Building an order of translucent faces says nothing and asks for no
/// interruption: DrawOptions::order is for the caller to set.
DrawOptions draw_options(const SourceOptions& options);

/// The configuration of the core that a stream goes to: the stream's own, or --config, of which only the implementation
/// parameters may differ from the stream's. Throws Error if another one does.
NamedConfig stream_config(const SourceOptions& options, const StreamFile& stream);

/// Where frames come from: a scene, drawn as the options say, a stream file, or chance. A few bands of a frame are in
/// memory at a time.
class Source : public FrameSource {
 public:
  /// Opens options.input and settles the configuration: --config, else the stream's own, else the first named one that
  /// has what the scene needs. Throws Error if a configuration lacks what the scene needs and --degrade is not given.
  /// `host` must outlive it.
  Source(const SourceOptions& options, Host& host);

  /// Another source of the same frames, for a thread of its own: both read one scene or stream. It counts
  /// notes for frames after `last` only.
  [[nodiscard]] std::unique_ptr<Source> share(int last) const;

  /// Adds the counts of a share. Shares come in the order of their frames.
  void absorb(const Source& share);

  /// Nothing is counted yet, as of a share of frames behind `last`.
  void count_anew(int last);

  [[nodiscard]] const Config& config() const override { return config_.config; }
  [[nodiscard]] const NamedConfig& named_config() const { return config_; }
  [[nodiscard]] int frames() const override { return frames_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Sentences for the person: what was ignored or added, which configuration was chosen, and in how many of the frames
  /// made so far nothing is to be seen.
  [[nodiscard]] std::vector<std::string> notes() const;

  /// Adds a note.
  void note(std::string text) { notes_.push_back(std::move(text)); }

  /// The scene; nothing if the frames are no scene's.
  [[nodiscard]] std::shared_ptr<const Scene> scene() const { return scene_; }

  /// Whether the frames come from a stream file.
  [[nodiscard]] bool is_stream() const { return stream_ != nullptr; }

  /// Whether frame `index` may break rules: a random one, or one that a stream file has as a port brings it.
  [[nodiscard]] bool is_unchecked(int index) const;

  /// Whether a core may refuse some of them: any is unchecked.
  [[nodiscard]] bool may_be_refused() const;

  /// The frames that random:mixed puts ahead of some: RtlOptions::prelude. Other sources have none.
  [[nodiscard]] std::function<std::vector<std::uint32_t>(int)> prelude() const;

  /// Whether they are random.
  [[nodiscard]] bool is_random() const { return random_.has_value(); }

  /// The level of the frames' tokens; a stream's is that of its first frame.
  [[nodiscard]] Level level() const;

  /// The features that --degrade left out.
  [[nodiscard]] const std::vector<std::string>& degraded() const { return degraded_; }

  /// How each component of the scene went in the frames made so far, if the configuration has units. An entry has
  /// object and component; in how many frames a unit had it; in how many it became spans, and why in the last of those.
  /// Neighbours that can be no polyhedron for the same reason are one entry, with their number and the first one's why:
  /// a soup of triangles has as many components as faces. For a stream, as the file has it, if it has.
  [[nodiscard]] report::WayRecords ways() const;

  /// How polygons went in the frames of a scene made so far, at the polygon level.
  [[nodiscard]] const PolygonWays& polygons() const { return polygons_; }

  /// Most units in use in a frame.
  [[nodiscard]] int units() const { return units_; }

  /// Hands the words of frame `index` to `sink`, piece by piece, and returns their counts. Host::check() may end it
  /// between the pieces, and while translucent faces are put in order, which shows its own progress.
  TokenCounts frame(int index, const WordSink& sink) override;

  /// Draws frame `index` of a scene without words, unless its configuration has units or its level is that of polygons.
  bool draw(int index, const SizeSink& start, const LineSink& sink) override;

  /// The origins of the tokens of frame `index`; nothing if the frames are a stream's.
  [[nodiscard]] std::optional<Provenance> provenance(int index);

  /// Tells what frame `index` leaves out at a pixel, whose history in it is `kept`. Nothing if no frame leaves anything
  /// out: with --all-spans, of streams, and of chance.
  [[nodiscard]] std::optional<std::vector<LeftOut>> left_out(int index, const ToldHistory& kept);

 private:
  Provenance provenance(int index, bool all_spans, const WordSink& sink);
  TokenCounts frame_of_stream(int index, const WordSink& sink);
  TokenCounts frame_of_scene(int index, const WordSink& sink);
  void record(int index, const FrameParts& parts);
  void count_frame(int index, bool blank);
  TokenCounts frame_of_chance(int index, const WordSink& sink);
  void open_stream(const SourceOptions& options);
  void open_random(const SourceOptions& options, verif::Manner manner);
  void open_scene(const SourceOptions& options);
  void load_scene(const SourceOptions& options);
  void add_front_end(const SourceOptions& options);

  explicit Source(Host& host) : host_(host) {}
  void open_frames();

  Host& host_;
  SourceOptions options_;
  NamedConfig config_;
  int frames_ = 0;
  std::string name_;
  std::vector<std::string> notes_;
  std::vector<std::string> degraded_;
  std::shared_ptr<const StreamFile> stream_;
  report::WayRecords stream_ways_;
  std::shared_ptr<const Scene> scene_;
  std::optional<verif::RandomFrames> random_;
  std::unique_ptr<Progress> progress_;  // of the order's build; a share is silent
  std::unique_ptr<SceneFrames> scene_frames_;
  std::unique_ptr<StreamFrames> stream_frames_;
  int last_ = -1;  // the highest frame made: a run goes up, so one up to it is a replay, which counts no more
  bool again_ = false;
  int made_ = 0;                         // frames
  int blank_ = 0;                        // of those, without any opaque span or segment
  int unfit_ = 0;                        // of those, with fewer shadow volumes than the scene has
  std::optional<FrameRemarks> remarks_;  // of a scene
  ComponentWays ways_;
  PolygonWays polygons_;
  int units_ = 0;
};

}  // namespace kage::cosim
