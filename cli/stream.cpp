// SPDX-License-Identifier: Apache-2.0
// kage stream SCENE --out FILE: writes a stream file.
#include "kage/stream.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "command.hpp"
#include "cosim/session/frame_progress.hpp"
#include "cosim/session/option_names.hpp"
#include "cosim/session/source.hpp"
#include "inputs.hpp"
#include "json/json_text.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "standard_files.hpp"
#include "stream/finish.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

/// Whether the stream goes to standard output.
bool piped(const Options& o) { return is_standard_output(o.out); }

int run(const Options& o) {
  if (piped(o) && isatty(STDOUT_FILENO) != 0)
    throw Error("--out -: standard output is a terminal, which cannot show a stream: send it to a file or a program");
  if (piped(o) && json_only(o.json)) throw Error("--out - and --json -: both are standard output");
  check_json(o, o.json);
  check_output(file_named(o.out));
  refuse_random(o.input);
  refuse_pack(o.input);
  cosim::Source source(o, terminal());
  if (source.is_stream()) source.note("copied from a stream file");
  const Config& config = source.config();
  StreamFileWriter writer =
      piped(o) ? StreamFileWriter(STDOUT_FILENO, "standard output", config) : StreamFileWriter(o.out, config);
  TokenCounts counts;
  Progress progress;
  cosim::FrameProgress frame_progress(progress, source.name(), source.frames());
  for (int i = 0; i < source.frames(); ++i) {
    check_interrupt();
    frame_progress.next();
    if (source.is_unchecked(i))
      writer.begin_port_frame();
    else
      writer.begin_frame();
    // A file's frames are right for the core that they were written for; another one may have less room.
    std::optional<FrameChecker> other_core;
    if (source.is_stream() && !o.config.empty() && !source.is_unchecked(i))
      other_core.emplace(config, fmt::format("{}, for {}", o.input, o.config), 0);
    counts += source.frame(i, [&](std::span<const std::uint32_t> words) {
      check_interrupt();
      frame_progress.wait();
      if (other_core) other_core->feed(words);
      writer.words(words);
    });
    if (other_core) other_core->finish();
    writer.end_frame();
  }
  progress.clear();
  Json origin;
  origin["scene"] = source.name();
  origin["polyhedra"] = report::to_json(source.ways());
  if (!origin["polyhedra"].is_null()) writer.origin(json_text(origin));
  TempFiles files;
  kage::finish(writer, files);
  Json j;
  j["file"] = piped(o) ? Json(nullptr) : Json(o.out);
  j["frames"] = source.frames();
  j["spans"] = counts.spans;
  j["span_pixels"] = counts.span_pixels;
  j["segments"] = counts.of_kind[static_cast<std::size_t>(Kind::SEG)];
  j["words"] = counts.words;
  j["level"] = cosim::name_of(source.level());
  j["polygons"] = o.level == Level::polygons ? source.polygons().json() : Json(nullptr);
  j["config"] = report::to_json(config);
  j["degraded"] = source.degraded();
  j["notes"] = source.notes();
  const Document document("kage.stream/1", j);
  std::string text = fmt::format(
      "{}{}: {}, {} over {}{}, {}", notes_text(source), piped(o) ? "standard output" : shown(o.out),
      counted(source.frames(), "frame"), counted(counts.spans, "span"), counted(counts.span_pixels, "pixel"),
      and_segments(counts.of_kind[static_cast<std::size_t>(Kind::SEG)]), counted(counts.words, "word"));
  text += o.level == Level::polygons
              ? fmt::format(" ({})\n{}", counted(counts.words * 4, "byte"), source.polygons().text())
              : "\n";
  if (piped(o)) {
    finish(o.json, document, files, "");
    say(text);
    return kSame;
  }
  finish(o.json, document, files, text);
  if (json_only(o.json)) print_notes(source, o.json);
  return kSame;
}

}  // namespace

void add_stream(Program& program, Action& action) {
  Command c =
      program.add("stream", "Write the frames of a scene as a stream file",
                  "  kage stream courtyard --out courtyard.kage\n"
                  "  kage stream model.glb --size 320x240 --frames 4 --config full --out model.kage\n"
                  "  kage stream courtyard.kage --frames 2 --out short.kage\n"
                  "  kage stream courtyard --out - | gzip >courtyard.kage.gz\n"
                  "  kage stream courtyard --level polygons --out small.kage\n"
                  "A stream file is checked and copied: --frames takes its first ones, and --config may change\n"
                  "what affects no pixel. Frames that are kept unchecked (PORT) stay so.");
  const auto o = std::make_shared<Options>();
  option_scene(c, *o);
  c.add_option("--out", o->out, "the stream file; - is standard output, which gets frame after frame, as a pipe does")
      .required()
      .type_name(std::string("FILE") + kOrStandardOutput);
  options_of_frames(c, *o);
  option_level(c, *o);
  option_json(c, o->json);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
