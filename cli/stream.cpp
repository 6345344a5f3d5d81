// SPDX-License-Identifier: Apache-2.0
// kage stream SCENE --out FILE: writes a stream file.
#include <fmt/format.h>

#include <memory>

#include "common.hpp"
#include "progress.hpp"
#include "source.hpp"

namespace kage::cli {
namespace {

int run(const Options& o) {
  Source source(o);
  if (source.is_stream()) source.note("copied from a stream file");
  StreamFileWriter writer(o.out, source.config().config);
  TokenCounts counts;
  Progress progress;
  FrameProgress frame_progress(progress, source.name(), source.frames());
  for (int i = 0; i < source.frames(); ++i) {
    check_interrupt();
    frame_progress.next();
    writer.begin_frame();
    counts += source.frame(i, [&](std::span<const std::uint32_t> words) { writer.words(words); });
    writer.end_frame();
  }
  progress.clear();
  Json origin;
  origin["scene"] = source.name();
  origin["polyhedra"] = source.ways();
  if (!origin["polyhedra"].is_null()) writer.origin(origin.dump(-1, ' ', false, Json::error_handler_t::replace));
  writer.finish();
  print_notes(source, o);
  fmt::print("{}: {}, {} over {}{}, {}\n", o.out, counted(source.frames(), "frame"), counted(counts.spans, "span"),
             counted(counts.span_pixels, "pixel"), and_segments(counts.of_kind[static_cast<std::size_t>(Kind::SEG)]),
             counted(counts.words, "word"));
  return kSame;
}

}  // namespace

void add_stream(CLI::App& app, Action& action) {
  CLI::App* c =
      add_command(app, "stream", "Write the frames of a scene as a stream file",
                  "  kage stream courtyard --out courtyard.kage\n"
                  "  kage stream model.glb --size 320x240 --frames 4 --config full --out model.kage\n"
                  "  kage stream courtyard.kage --frames 2 --out short.kage\n"
                  "A stream file is checked and copied: --frames takes its first ones, and --config may change\n"
                  "what affects no pixel.");
  const auto o = std::make_shared<Options>();
  option_scene(*c, *o);
  c->add_option("--out", o->out, "the stream file")->required()->type_name("FILE");
  options_of_frames(*c, *o);
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
