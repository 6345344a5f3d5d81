// SPDX-License-Identifier: Apache-2.0
// kage info STREAM: describes and checks a stream file.
#include <fmt/format.h>

#include <memory>

#include "common.hpp"
#include "kage/stream.hpp"
#include "mapped.hpp"
#include "source.hpp"

namespace kage::cli {
namespace {

/// "gem, component 2: by segments in 7 frames, by spans in 1 frame: why"; frames in which it is not seen are in
/// neither.
std::string describe_way(const Json& w) {
  const auto first = w.value("component", std::uint64_t{0});
  const auto count = w.value("components", std::uint64_t{1});
  std::string text = fmt::format(
      "{}, {}: ", w.value("object", "?"),
      count == 1 ? fmt::format("component {}", first) : fmt::format("components {} to {}", first, first + count - 1));
  const auto by_units = w.value("unit_frames", 0);
  const auto by_spans = w.value("span_frames", 0);
  if (by_units > 0) text += "by segments in " + counted(by_units, "frame") + (by_spans > 0 ? ", " : "");
  if (by_spans > 0) text += "by spans in " + counted(by_spans, "frame");
  if (by_units == 0 && by_spans == 0) text += "not seen";
  if (w["why"].is_string()) text += ": " + w["why"].get<std::string>();
  return text;
}

int run(const Options& o) {
  check_json(o);
  guard_mapped(o.input);
  const StreamFile file(o.input);
  TokenCounts counts;
  Progress progress;
  for (int i = 0; i < file.frame_count(); ++i) {
    check_interrupt();
    progress.show(fmt::format("frame {}/{}", i + 1, file.frame_count()));
    (void)file.frame(i, &counts);
  }
  check_mapped();
  progress.clear();

  Json tokens = Json::object();
  for (std::size_t k = 0; k < counts.of_kind.size(); ++k)
    if (counts.of_kind[k] != 0) tokens[std::string(kKindNames[k])] = counts.of_kind[k];
  const std::uint64_t lines = counts.of_kind[static_cast<std::size_t>(Kind::EOL)];
  Json j;
  j["version"] = kStreamVersion;
  j["config"] = to_json(file.config());
  j["frames"] = file.frame_count();
  j["lines"] = lines;
  j["tokens"] = tokens;
  j["spans"] = counts.spans;
  j["span_pixels"] = counts.span_pixels;
  j["segments"] = counts.of_kind[static_cast<std::size_t>(Kind::SEG)];
  j["units"] = counts.units;
  const Json ways = ways_of(file);
  j["polyhedra"] = ways;
  j["bytes"] = file.bytes();
  j["checksum_ok"] = true;  // a wrong one has ended this with an error
  write_json(o, j);
  if (!json_only(o)) {
    fmt::print("{}: {}, {}, {} over {}, {}, checksums right\n", o.input, counted(file.frame_count(), "frame"),
               counted(lines, "line"), counted(counts.spans, "span"), counted(counts.span_pixels, "pixel"),
               counted(file.bytes(), "byte"));
    fmt::print("tokens:");
    for (const auto& [name, n] : tokens.items()) fmt::print(" {} {}", name, n.get<std::uint64_t>());
    for (const Json& w : ways.is_array() ? ways : Json::array()) fmt::print("\n{}", describe_way(w));
    fmt::print("\nconfiguration:");
    for (const ParamInfo& p : kParams) fmt::print(" {} {}", p.name, file.config().*(p.member));
    fmt::print("\n");
  }
  return kSame;
}

}  // namespace

void add_info(CLI::App& app, Action& action) {
  CLI::App* c = add_command(app, "info", "Describe and check a stream file",
                            "  kage info courtyard.kage\n"
                            "  kage info courtyard.kage --json -");
  const auto o = std::make_shared<Options>();
  c->add_option("STREAM", o->input, "a stream file, as kage stream writes it")->required();
  option_json(*c, *o);
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
