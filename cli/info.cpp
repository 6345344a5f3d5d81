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
    for (const Json& w : ways.is_array() ? ways : Json::array())
      fmt::print("\n{}, {} {}: by segments in {}, by spans in {}{}", w.value("object", "?"),
                 w.value("components", 1) == 1 ? "component" : counted(w.value("components", 1), "component") + " from",
                 w.value("component", 0), counted(w.value("unit_frames", 0), "frame"),
                 counted(w.value("span_frames", 0), "frame"),
                 w["why"].is_string() ? fmt::format(": {}", w["why"].get<std::string>()) : std::string());
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
