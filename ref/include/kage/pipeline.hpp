// SPDX-License-Identifier: Apache-2.0

/// @file
/// The whole way in one call: a scene, or a stream file, to words, and words to pixels. Each step has its own header
/// (scene.hpp, geometry.hpp, frontend.hpp, stream.hpp, core.hpp) for those who want to go between.
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

/// Takes the size of a picture, before its lines.
using SizeSink = std::function<void(int width, int height)>;

/// Frames of words, one after another. Not for use by two threads at once.
class FrameSource {
 public:
  FrameSource() = default;
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  /// @return what the words are for
  [[nodiscard]] virtual const Config& config() const = 0;

  /// @return how many frames there are
  [[nodiscard]] virtual int frames() const = 0;

  /// Makes a frame's words. Throws Error if the frame cannot be made, or breaks a rule of docs/stream.md.
  /// @param index 0 .. frames() - 1
  /// @param sink gets the words, piece by piece; what it throws ends the frame
  /// @return counts of the tokens
  virtual TokenCounts frame(int index, const WordSink& sink) = 0;

  /// Draws a frame without words between, where a source has such a way: the picture is that of a GoldenCore, bit for
  /// bit. Throws as frame().
  /// @param index 0 .. frames() - 1
  /// @param start gets the picture's size
  /// @param sink gets its lines from the top; what it throws ends the frame
  /// @return whether there is a way; if not, neither has been called
  virtual bool draw(int index, const SizeSink& start, const LineSink& sink);

  /// The words in memory. Throws as frame().
  /// @param index 0 .. frames() - 1
  /// @return all words of the frame
  std::vector<std::uint32_t> words(int index);
};

/// How a scene is drawn.
struct DrawOptions {
  int width = 320;               ///< of the picture in pixels, 1 .. kMaxSize
  int height = 240;              ///< likewise, in lines
  int frames = 0;                ///< equal steps through the scene's animation or orbit; 0: as many as the scene has
  Look look = {};                ///< what the picture's maker decides
  OrderBuildOptions order = {};  ///< of translucent faces
  int threads = 0;               ///< 0: one per processor. The words do not depend on it
  Level level = Level::spans;    ///< FrameOptions::level: with polygons, the configuration has ACTIVE > 0
  bool all_spans = false;        ///< FrameOptions::all_spans
  std::string name = {};         ///< what messages call the scene; empty: Scene::name()
};

/// Parts that a frame of a scene was made of.
struct FrameParts {
  SceneFrame scene;           ///< what is drawn
  FrameGeometry geometry;     ///< the same on the screen
  PolyhedraReport polyhedra;  ///< how polyhedra went to units
  PolygonReport polygons;     ///< how polygons went at the polygon level; filled when the frame has been made
  bool blank = false;         ///< of a frame drawn without words: nothing covers the centre of a pixel
};

/// The frames of a scene. Order and shadows that do not change are kept from frame to frame, which changes no word.
class SceneFrames : public FrameSource {
 public:
  /// Drawn with a configuration. Needs of the scene (needs_of()) that it lacks (lacks()) are left out of the picture.
  /// Throws Error if `options` are not as they say.
  /// @param scene what is drawn
  /// @param config a legal configuration
  /// @param options how it is drawn
  SceneFrames(std::shared_ptr<const Scene> scene, const Config& config, DrawOptions options = {});

  /// Drawn with the named configuration that choose_config() takes: the first that has all that the frames need, or a
  /// later one that costs a tenth less. Throws Error if none has all.
  /// @param scene what is drawn
  /// @param options how it is drawn
  explicit SceneFrames(const std::shared_ptr<const Scene>& scene, const DrawOptions& options = {});
  /// The same for a scene that no one else needs.
  /// @param scene what is drawn
  /// @param options how it is drawn
  explicit SceneFrames(Scene scene, const DrawOptions& options = {});

  /// @return what the scene is drawn with
  [[nodiscard]] const Config& config() const override { return config_; }
  [[nodiscard]] int frames() const override { return frames_; }
  /// As FrameSource::frame(). Error and TooManyFragments begin with the scene's name and the frame.
  /// @param index 0 .. frames() - 1
  /// @param sink gets the words, piece by piece
  /// @return counts of the tokens
  TokenCounts frame(int index, const WordSink& sink) override;

  /// The same, and what the frame was made of.
  /// @param index 0 .. frames() - 1
  /// @param sink gets the words, piece by piece
  /// @param parts filled before `sink` gets the first words
  /// @return counts of the tokens
  TokenCounts frame(int index, const WordSink& sink, FrameParts& parts);

  /// As FrameSource::draw(): there is a way unless the configuration has UNITS, or the frames are at the polygon level.
  /// @param index 0 .. frames() - 1
  /// @param start gets the picture's size
  /// @param sink gets its lines from the top
  /// @return whether there is a way
  bool draw(int index, const SizeSink& start, const LineSink& sink) override;

  /// The same, and what the frame was made of.
  /// @param index 0 .. frames() - 1
  /// @param start gets the picture's size
  /// @param sink gets its lines from the top
  /// @param parts filled before `start` is called, but for `blank`, which is known at the end
  /// @return whether there is a way
  bool draw(int index, const SizeSink& start, const LineSink& sink, FrameParts& parts);

  /// Tells what the tokens of a frame come from.
  /// @param index 0 .. frames() - 1
  /// @param sink gets the frame's words, which are not checked once more
  /// @param all_spans DrawOptions::all_spans of this frame
  /// @return the frame's geometry with the names behind it
  Provenance provenance(int index, const WordSink& sink, bool all_spans);

  /// @return what is drawn
  [[nodiscard]] const Scene& scene() const { return *scene_; }

 private:
  /// How a frame's words are wanted; with origins they are not checked.
  struct Wanted {
    bool all_spans;
    FrameOrigins* origins;
  };
  TokenCounts make(int index, const WordSink& sink, FrameParts& parts, const Wanted& wanted);
  template <class Make>
  void guarded(int index, FrameParts& parts, Make make);

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
  /// The frames of a file that is open.
  /// @param file what is read
  explicit StreamFrames(std::shared_ptr<const StreamFile> file);

  /// @return the file's configuration
  [[nodiscard]] const Config& config() const override { return config_; }
  [[nodiscard]] int frames() const override { return file_->frame_count(); }

  /// Each piece is a copy: whatever happens to the file, all who read the piece read the same words.
  /// @param index 0 .. frames() - 1
  /// @param sink gets the words, piece by piece
  /// @return counts of the tokens
  TokenCounts frame(int index, const WordSink& sink) override;

 private:
  std::shared_ptr<const StreamFile> file_;
  Config config_;
};

/// Judges what drawing a scene takes, by one of its frames. Panes and colours out of view ask for nothing. A lone
/// convex body seen from outside asks for no shadows.
/// @param scene what is drawn
/// @param frame one of its frames
/// @param width of the picture, in pixels
/// @param height of the picture, in lines
/// @param samples of a light that is no point, 1 .. kMaxSamples
/// @return what a configuration must have
Needs needs_of(const Scene& scene, const SceneFrame& frame, int width, int height, int samples = Look{}.samples);

/// Judges what drawing frames of a scene takes. How far light is off without a table, or without smooth colour, is
/// judged by the first of them, all else by each.
/// @param scene what is drawn
/// @param frames how many of it there are
/// @param width of the picture, in pixels
/// @param height of the picture, in lines
/// @param samples of a light that is no point, 1 .. kMaxSamples
/// @param step called before each frame but the first; what it throws goes through
/// @return what a configuration must have
Needs needs_of_frames(const Scene& scene, int frames, int width, int height, int samples = Look{}.samples,
                      const std::function<void()>& step = {});

/// Chooses among the named configurations. It takes the first in listed order that has all the
/// frames need, unless a later one costs a tenth less. The cost is the clocks of the first frame at 640x480 times the
/// core's look-up tables, so the size that is asked for only decides which configurations have room for it.
/// Configurations with UNITS, or with a processor for each pixel, are taken only where no other serves. Throws Error if
/// none has all; it names the one that lacks the fewest things, and those.
/// @param scene what is drawn
/// @param draw how it is drawn
/// @return what it is drawn with
NamedConfig choose_config(const Scene& scene, const DrawOptions& draw);

/// Draws frames: without words where the source has a way (FrameSource::draw()), else with the golden core.
class Renderer {
 public:
  /// Draws the frames of a source.
  /// @param source must outlive the renderer
  /// @param through_words always by words and the golden core
  explicit Renderer(FrameSource& source, bool through_words = false);

  /// Draws a frame, line by line from the top. An error in the words is a status, and background pixels. Throws as
  /// FrameSource::frame().
  /// @param index 0 .. frames() - 1 of the source
  /// @param start gets the picture's size before its lines, unless the frame's header has an error
  /// @param sink gets the lines
  /// @return how the frame ended
  FrameStatus frame(int index, const SizeSink& start, const LineSink& sink);

  /// Draws a frame into memory. Throws Error where its words have an error.
  /// @param index 0 .. frames() - 1 of the source
  /// @return the picture
  Image image(int index);

  /// @return counts of the frame that was drawn last; nothing if it was drawn without words
  [[nodiscard]] const std::optional<TokenCounts>& counts() const { return counts_; }

  /// @return wall time that drawing has taken for all frames so far, in seconds, without that of the lines' sink. With
  /// words it is the golden core's, without that of the source; else geometry is in it
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  FrameStatus through_words(int index, const SizeSink& start, const LineSink& sink);

  FrameSource* source_;
  bool through_words_;
  std::optional<GoldenCore> core_;
  std::optional<TokenCounts> counts_;
  double seconds_ = 0;
};

}  // namespace kage
