// SPDX-License-Identifier: Apache-2.0
// kage render SCENE: draws frames with the golden model.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "command.hpp"
#include "cosim/session/frame_progress.hpp"
#include "cosim/session/source.hpp"
#include "explore/error_maps.hpp"
#include "inputs.hpp"
#include "kage/error.hpp"
#include "kage/pipeline.hpp"
#include "options.hpp"
#include "pipeline/frame_picture.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

struct RenderCommand : Options {
  bool exr = false;
  bool error_map = false;
  bool through_words = false;
};

std::string words_text(const TokenCounts& counts) {
  return fmt::format(", {} over {}{}", counted(counts.spans, "span"), counted(counts.span_pixels, "pixel"),
                     and_segments(counts.of_kind[static_cast<std::size_t>(Kind::SEG)]));
}

int run(const RenderCommand& o) {
  const OutFolder folder(o.out);
  check_json(o, o.json);
  refuse_random(o.input);
  refuse_pack(o.input);
  if (o.error_map && is_stream_file(o.input))
    throw Error(
        fmt::format("{}: --error-map: what is wrong is told from the scene, which a stream does not hold", o.input));
  cosim::Source source(o, terminal());
  std::optional<explore::ErrorMaps> errors;
  if (o.error_map) errors.emplace(o, source, terminal());
  Renderer renderer(source, o.through_words);
  std::optional<TokenCounts> counts;  // of frames that were drawn by words
  TempFiles files;
  Json names = Json::array();
  cosim::Size size;
  Progress progress;
  cosim::FrameProgress frame_progress(progress, source.name(), source.frames());
  for (int i = 0; i < source.frames(); ++i) {
    check_interrupt();
    frame_progress.next();
    const auto path =
        std::filesystem::path(o.out) / fmt::format("{}_{:04}.{}", source.name(), i, o.exr ? "exr" : "png");
    FramePicture picture(path);
    const FrameStatus status = renderer.frame(
        i, [&](int width, int height) { picture.size(width, height); },
        [&](int, std::span<const std::uint8_t> pixels) {
          check_interrupt();
          frame_progress.wait();
          picture.line(pixels);
        });
    if (status.error != ErrorCode::NONE) throw Error(fmt::format("{}: frame {}: {}", o.input, i, describe(status)));
    if (renderer.counts()) {
      if (!counts) counts.emplace();
      *counts += *renderer.counts();
    }
    size = {status.width, status.height};
    picture.close();
    picture.hand_over(files);
    names.push_back(path.string());
    if (errors) errors->frame(i, path, files);
  }
  progress.clear();

  Json j;
  j["frames"] = source.frames();
  j["width"] = size.width;
  j["height"] = size.height;
  j["through_words"] = counts.has_value() || o.through_words;
  j["spans"] = counts ? Json(counts->spans) : Json(nullptr);
  j["span_pixels"] = counts ? Json(counts->span_pixels) : Json(nullptr);
  j["golden_seconds"] = renderer.seconds();
  j["config"] = cli::to_json(source.config());
  j["degraded"] = source.degraded();
  j["files"] = names;
  j["errors"] = errors ? errors->json() : Json(nullptr);
  j["notes"] = source.notes();
  finish(o.json, {"kage.render/1", j}, files,
         notes_text(source) + (errors ? errors->text() : "") +
             fmt::format("{}, {}x{}{}: {}\n", counted(source.frames(), "frame"), size.width, size.height,
                         counts ? words_text(*counts) : "", shown(o.out)));
  if (json_only(o.json)) print_notes(source, o.json);
  return kSame;
}

}  // namespace

void add_render(Program& program, Action& action) {
  Command c = program.add("render", "Draw a scene or a stream with the golden model",
                          "  kage render courtyard --out pictures\n"
                          "  kage render horse.3ds --size 800x600 --frames 1\n"
                          "  kage render courtyard.kage --exr --json -\n"
                          "  kage render courtyard --sub-bits 4 --frames 1 --error-map\n"
                          "The pictures appear together when the last one is drawn.");
  const auto o = std::make_shared<RenderCommand>();
  o->out = "out";
  option_scene(c, *o);
  c.add_option("--out", o->out, "folder for the pictures, default out").type_name("DIR");
  c.add_flag("--exr", o->exr, "write EXR instead of PNG");
  c.add_flag(
      "--error-map", o->error_map,
      "show what is wrong in each picture of a scene, by the exact oracle and the finest picture: NAME_error.png; "
      "NAME_error_SOURCE.png for each source of error alone; NAME_error_light.png, by each light worked out at the "
      "pixel; docs/sweep.md has the colours");
  c.add_flag("--through-words", o->through_words,
             "draw by the words of docs/stream.md and the golden core, as the RTL is held against it; else pictures of "
             "scenes come straight from geometry, which gives the same bits (docs/architecture.md)");
  options_of_frames(c, *o);
  option_json(c, o->json);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
