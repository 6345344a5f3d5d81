// SPDX-License-Identifier: Apache-2.0
// kage info STREAM: describes and checks a stream file. kage info SCENE is in info_scene.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "command.hpp"
#include "cosim/session/frame_progress.hpp"
#include "cosim/session/source.hpp"
#include "cost/line_clocks.hpp"
#include "file/extension.hpp"
#include "info_scene.hpp"
#include "inputs.hpp"
#include "kage/error.hpp"
#include "kage/explain.hpp"
#include "kage/stream.hpp"
#include "mapped.hpp"
#include "number/packed_color.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

struct InfoCommand : Options {
  int tokens = -1;      // the frame whose tokens are printed
  bool clocks = false;  // whether those of its lines are counted
};

/// "gem, component 2: by segments in 7 frames, by spans in 1 frame: why"; frames in which it is not seen are in
/// neither.
std::string describe_way(const report::WayRecord& w) {
  std::string text =
      fmt::format("{}, {}: ", shown(w.object),
                  w.components == 1 ? fmt::format("component {}", w.component)
                                    : fmt::format("components {} to {}", w.component, w.component + w.components - 1));
  if (w.unit_frames > 0) text += "by segments in " + counted(w.unit_frames, "frame") + (w.span_frames > 0 ? ", " : "");
  if (w.span_frames > 0) text += "by spans in " + counted(w.span_frames, "frame");
  if (w.unit_frames == 0 && w.span_frames == 0) text += "not seen";
  if (w.why) text += ": " + shown(*w.why);
  return text;
}

/// A frame's header in words, which an unchecked frame may have cut or of another core.
std::string header_text(const Config& config, std::span<const std::uint32_t> words) {
  if (words.size() < kHeaderWords)
    return fmt::format("header of {} words, cut after {}: {}", kHeaderWords, words.size(), words_text(words));
  const FrameHeader h = FrameHeader::read(words);
  std::string text = fmt::format("header: {}x{}, background {}, frame number {}", h.width, h.height,
                                 color_text(config, unpacked_levels(h.background, 8)), h.frame);
  std::array<std::uint32_t, 1> ours{};
  FrameHeader{}.write(ours);
  if (h.level() == Level::polygons) text += ", at the polygon level";
  if (!h.known()) text += fmt::format(", magic_version {:#010x} and not {:#010x}", words[0], ours[0]);
  if (h.param_hash != param_hash(config))
    text += fmt::format(", param_hash {:#010x} and not {:#010x}", h.param_hash, param_hash(config));
  return text;
}

/// Frame `frame` token by token, with the indices by which errors name them, then as words what is no token.
void print_tokens(const StreamFile& file, int frame) {
  constexpr std::size_t kWordsOfALine = 8;
  const Config& config = file.config();
  const Layout layout(config);
  const auto words = file.frame(frame);
  fmt::print("frame {}{}:\n{:>8}  {}\n", frame, file.is_port_frame(frame) ? ", unchecked (PORT)" : "", 0,
             header_text(config, words));
  TokenWalk walk(layout, words);
  std::uint64_t index = 1;
  for (auto token = walk.next(); !token.empty(); token = walk.next(), ++index) {
    if (index % 4096 == 0) check_interrupt();
    fmt::print("{:>8}  {}\n", index, to_string(config, decode(config, layout, token, walk.level())));
  }
  auto rest = walk.rest();
  if (!rest.empty()) fmt::print("{:>8}  {}; the words from here on:\n", index, walk.rest_text());
  while (!rest.empty()) {
    check_interrupt();
    const auto line = rest.first(std::min(rest.size(), kWordsOfALine));
    fmt::print("{:>8}  {}\n", "", words_text(line));
    rest = rest.subspan(line.size());
  }
  check_mapped();
}

struct Counted {
  TokenCounts tokens;
  int unchecked = 0;  // frames
  int polygons = 0;   // frames at the polygon level
};

/// Checks all frames, and counts their tokens, and what `clocks` counts.
Counted count_tokens(const InfoCommand& o, const StreamFile& file, std::optional<LineClockCounter>& clocks) {
  Counted all;
  Progress progress;
  cosim::FrameProgress frame_progress(progress, std::filesystem::path(o.input).filename().string(), file.frame_count());
  for (int i = 0; i < file.frame_count(); ++i) {
    check_interrupt();
    frame_progress.next();
    const auto words = file.frame(i, &all.tokens);
    if (file.is_port_frame(i)) ++all.unchecked;
    if (FrameHeader::read(words).level() == Level::polygons) ++all.polygons;
    if (!clocks || file.is_port_frame(i)) continue;
    try {
      clocks->add(i, words);
    } catch (const Error& e) {
      throw Error(fmt::format("{}: {}", o.input, e.what()));
    }
  }
  check_mapped();
  progress.clear();
  return all;
}

std::string to_text(const Config& c, const LineClocks& clocks) {
  if (clocks.frames == 0) return "clocks: no frame is sound, so none has clocks";
  return fmt::format(
      "clocks of a line at most (LANES {}, BEAT_WORDS {}): mean {:.0f}, worst {} (line {} of frame {}), worst {} "
      "neighbours {:.0f} each\nclocks of the worst frame: {}",
      c.lanes, c.beat_words, clocks.mean(), clocks.worst.clocks, clocks.worst.line, clocks.worst.frame, clocks.window,
      clocks.worst_window, clocks.worst_frame);
}

Json to_json(const Config& config, const LineClocks& clocks) {
  Json j;
  j["config"] = cli::to_json(config);
  j["frames"] = clocks.frames;
  j["height"] = clocks.height;
  j["mean_line"] = clocks.mean();
  j["worst_line"] = {{"clocks", clocks.worst.clocks}, {"frame", clocks.worst.frame}, {"line", clocks.worst.line}};
  j["worst_window"] = {{"lines", clocks.window}, {"clocks_each", clocks.worst_window}};
  j["worst_frame"] = clocks.worst_frame;
  return j;
}

int describe_stream(const InfoCommand& o) {
  if (o.size_given) throw Error(fmt::format("{}: --size: a stream has its own size", o.input));
  guard_mapped(o.input);
  const StreamFile file(o.input);
  if (o.tokens >= file.frame_count())
    throw Error(
        fmt::format("{}: --tokens {}: the stream has frames 0 to {}", o.input, o.tokens, file.frame_count() - 1));
  std::optional<LineClockCounter> clocks;
  if (o.clocks) clocks.emplace(cosim::stream_config(o, file).config);
  const auto [counts, unchecked, polygons] = count_tokens(o, file, clocks);
  Json tokens = Json::object();
  for (std::size_t k = 0; k < counts.of_kind.size(); ++k)
    if (counts.of_kind[k] != 0) tokens[std::string(kKindNames[k])] = counts.of_kind[k];
  const std::uint64_t lines = counts.of_kind[static_cast<std::size_t>(Kind::EOL)];
  Json j;
  j["version"] = polygons > 0 ? kPolygonVersion : kStreamVersion;
  j["config"] = cli::to_json(file.config());
  j["frames"] = file.frame_count();
  j["unchecked_frames"] = unchecked;
  j["polygon_frames"] = polygons;
  j["lines"] = lines;
  j["tokens"] = tokens;
  j["spans"] = counts.spans;
  j["made_spans"] = counts.made;
  j["active"] = counts.active;
  j["span_pixels"] = counts.span_pixels;
  j["segments"] = counts.of_kind[static_cast<std::size_t>(Kind::SEG)];
  j["units"] = counts.units;
  const report::WayRecords ways = cosim::ways_of(file, o.input);
  j["polyhedra"] = to_json(ways);
  j["bytes"] = file.bytes();
  j["checksum_ok"] = true;  // a wrong one has ended this with an error
  if (clocks) j["clocks"] = to_json(clocks->config(), clocks->sums());
  write_json(o.json, {"kage.info-stream/1", j});
  if (!json_only(o.json)) {
    fmt::print("{}: {}{}, {}, {} over {}, {}, checksums right\n", shown(o.input), counted(file.frame_count(), "frame"),
               unchecked > 0
                   ? fmt::format(" ({} in sections PORT: these may break rules, and are not checked)", unchecked)
                   : "",
               counted(lines, "line"), counted(counts.spans, "span"), counted(counts.span_pixels, "pixel"),
               counted(file.bytes(), "byte"));
    fmt::print("tokens:");
    for (const auto& [name, n] : tokens.items()) fmt::print(" {} {}", name, n.get<std::uint64_t>());
    if (polygons > 0)
      fmt::print("\nlevel: {} at the polygon level, {} of the spans made of polygons, {} at once at most",
                 counted(polygons, "frame"), counts.made, counted(counts.active, "polygon"));
    for (const report::WayRecord& w : ways.value_or(std::vector<report::WayRecord>()))
      fmt::print("\n{}", describe_way(w));
    fmt::print("\nconfiguration:");
    for (const ParamInfo& p : kParams) fmt::print(" {} {}", p.name, file.config().*(p.member));
    fmt::print("\n");
    if (clocks) fmt::print("{}\n", to_text(clocks->config(), clocks->sums()));
    if (o.tokens >= 0) print_tokens(file, o.tokens);
  }
  return kSame;
}

int run(const InfoCommand& o) {
  check_json(o, o.json);
  refuse_random(o.input);
  if (!o.config.empty() && !o.clocks)
    throw Error("--config: kage info takes it with --clocks, of a stream, because clocks depend on the core");
  // A stream file that is damaged at its very beginning, or missing, is still no scene.
  if (is_stream_file(o.input) || lower_extension(o.input) == ".kage") return describe_stream(o);
  if (o.tokens >= 0) throw Error(fmt::format("{}: --tokens: only a stream file has tokens", o.input));
  if (o.clocks) throw Error(fmt::format("{}: --clocks: only a stream file has tokens that take clocks", o.input));
  cosim::refuse_order_tree(o.input);
  return describe_scene(o);
}

}  // namespace

void add_info(Program& program, Action& action) {
  Command c = program.add(
      "info", "Describe a scene, or describe and check a stream file",
      "  kage info model.glb              what is drawn of it, what is ignored, which configurations draw it\n"
      "  kage info courtyard.kage\n"
      "  kage info courtyard.kage --json -\n"
      "  kage info courtyard.kage --tokens 0 | less\n"
      "  kage info courtyard.kage --clocks --config four-lanes.yaml\n"
      "A token's index is the one by which errors name it; docs/stream.md says what tokens mean.");
  const auto o = std::make_shared<InfoCommand>();
  option_scene(c, *o);
  option_size(c, *o);
  c.add_option("--tokens", o->tokens, "of a stream: print frame N, from 0, token by token (not with --json -)")
      .check(whole_number(0, std::numeric_limits<int>::max()))
      .type_name("N");
  c.add_flag("--clocks", o->clocks,
             "of a stream: how many clocks a core takes for a line at most: mean, worst line, worst neighbours; at the "
             "polygon level those of the core behind the front end alone (docs/timing.md)");
  option_config(c, *o);
  option_outside(c, *o);
  option_json(c, o->json);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
