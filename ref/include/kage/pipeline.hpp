// SPDX-License-Identifier: Apache-2.0
//
// The whole way in one call: a scene, or a stream file, to words, and words to pixels. Each step has its own header
// (scene.hpp, geometry.hpp, frontend.hpp, stream.hpp, core.hpp) for those who want to go between.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/frontend.hpp"
#include "kage/geometry.hpp"
#include "kage/image.hpp"
#include "kage/provenance.hpp"
#include "kage/scene.hpp"
#include "kage/stream.hpp"

namespace kage {

/// Frames of words, one after another. Not for use by two threads at once.
class FrameSource {
 public:
  FrameSource() = default;
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  /// What the words are for.
  [[nodiscard]] virtual const Config& config() const = 0;

  /// How many frames there are.
  [[nodiscard]] virtual int frames() const = 0;

  /// Hands the words of frame `index`, 0 .. frames() - 1, to `sink`, piece by piece, and returns their counts. What
  /// `sink` throws ends the frame. Throws Error if the frame cannot be made, or breaks a rule of docs/stream.md.
  virtual TokenCounts frame(int index, const WordSink& sink) = 0;

  /// All words of frame `index`.
  std::vector<std::uint32_t> words(int index);
};

/// How a scene is drawn.
struct DrawOptions {
  int width = 320;  ///< of the picture in pixels, 1 .. kMaxSize
  int height = 240;
  int frames = 0;  ///< equal steps through the scene's animation or orbit; 0: as many as the scene has
  Look look = {};
  OrderBuildOptions order = {};  ///< of translucent faces
  int threads = 0;               ///< 0: one per processor. The words do not depend on it
  std::string name = {};         ///< what messages call the scene; empty: Scene::name()
};

/// What a frame of a scene was made of.
struct FrameParts {
  SceneFrame scene;
  FrameGeometry geometry;
  PolyhedraReport polyhedra;
};

/// The frames of a scene. Order and shadows that do not change are kept from frame to frame, which changes no word.
class SceneFrames : public FrameSource {
 public:
  /// Drawn with `config`. Throws Error if `options` are not as they say. What `config` lacks of the scene's needs
  /// (needs_of(), lacks()) is left out of the picture.
  SceneFrames(std::shared_ptr<const Scene> scene, const Config& config, DrawOptions options = {});

  /// Drawn with the first named configuration that has all that the first frame needs. Throws Error if none has.
  explicit SceneFrames(std::shared_ptr<const Scene> scene, const DrawOptions& options = {});
  explicit SceneFrames(Scene scene, const DrawOptions& options = {});

  [[nodiscard]] const Config& config() const override { return config_; }
  [[nodiscard]] int frames() const override { return frames_; }
  TokenCounts frame(int index, const WordSink& sink) override;

  /// As frame(); `parts` is filled before `sink` gets the first words.
  TokenCounts frame(int index, const WordSink& sink, FrameParts& parts);

  /// What the tokens of frame `index` come from. `sink` gets the frame's words, which are not checked once more.
  Provenance provenance(int index, const WordSink& sink);

  [[nodiscard]] const Scene& scene() const { return *scene_; }

 private:
  TokenCounts make(int index, const WordSink& sink, FrameParts& parts, FrameOrigins* origins);

  std::shared_ptr<const Scene> scene_;
  Config config_;
  DrawOptions options_;
  int frames_ = 0;
  TranslucentOrder order_;
  ShadowCache shadows_;
};

/// The frames of a stream file.
class StreamFrames : public FrameSource {
 public:
  explicit StreamFrames(std::shared_ptr<const StreamFile> file);

  [[nodiscard]] const Config& config() const override { return config_; }
  [[nodiscard]] int frames() const override { return file_->frame_count(); }

  /// Each piece is a copy: whatever happens to the file, all who read the piece read the same words.
  TokenCounts frame(int index, const WordSink& sink) override;

 private:
  std::shared_ptr<const StreamFile> file_;
  Config config_;
};

/// What drawing `scene` takes, judged by one of its frames. `samples`: of a light that is no point.
Needs needs_of(const Scene& scene, const SceneFrame& frame, int width, int height, int samples = Look{}.samples);

/// Draws frames with the golden core.
class Renderer {
 public:
  /// `source` must outlive the renderer.
  explicit Renderer(FrameSource& source);

  /// Frame `index`, line by line from the top. An error in the words is a status, and background pixels. `words`, if
  /// given, gets the frame's words too, each piece before the lines that come of it.
  FrameStatus frame(int index, const LineSink& sink, const WordSink& words = {});

  /// Frame `index`. Throws Error where its words have an error.
  Image image(int index);

  /// Counts of the frame that was drawn last.
  [[nodiscard]] const TokenCounts& counts() const { return counts_; }

  /// Wall time that the golden core has taken for all frames so far; that of source and sink is not in it.
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  FrameSource* source_;
  GoldenCore core_;
  TokenCounts counts_;
  double seconds_ = 0;
};

}  // namespace kage
