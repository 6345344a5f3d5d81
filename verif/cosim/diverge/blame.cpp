// SPDX-License-Identifier: Apache-2.0
#include "cosim/diverge/blame.hpp"

#include <fmt/format.h>

#include <string_view>

#include "contract/kinds.hpp"

namespace kage::cosim {
namespace {

std::string pixels(const Config& config) { return config.arrangement == 1 ? "pixel_banked" : "pixel_systolic"; }

// An error that is not the expected one, or not where it should be. Which rule has failed says who keeps it.
std::string blame_error(const Clue& clue) {
  const auto code = [](std::uint64_t value) { return static_cast<ErrorCode>(value); };
  const ErrorCode expected = clue.expected ? code(clue.expected->value[at::error::code]) : ErrorCode::NONE;
  const ErrorCode actual = clue.actual ? code(clue.actual->value[at::error::code]) : ErrorCode::NONE;
  const auto any = [&](auto is) { return is(expected) || is(actual); };
  const auto either = [&](ErrorCode e) { return expected == e || actual == e; };
  if (either(ErrorCode::PLACE) || either(ErrorCode::ACTIVE_FULL)) return "front_end";
  if (clue.again) return "token_stage";  // which lets no token in behind the first error
  if (clue.actual && clue.value == at::error::code && clue.actual->value[at::error::line] != clue.lines)
    return "frame_control";
  if (clue.value >= at::error::token)
    return is_of_unit(expected) ? "segment_check" : clue.polygons ? "front_end" : "token_stage";
  if (clue.value > at::error::code) return "frame_control";
  if (either(ErrorCode::HEADER) || either(ErrorCode::SIZE) || either(ErrorCode::PARAMS)) return "token_stage";
  if (either(ErrorCode::LAST_LATE) &&
      (expected == ErrorCode::NONE || expected == ErrorCode::LAST_LATE))  // the flag that it comes of is token_reader's
    return clue.at_last == (expected == ErrorCode::LAST_LATE) ? "token_reader" : "token_check";
  if (any(is_of_unit)) return "segment_check";
  if (!clue.kind) return "token_check";
  const bool table = *clue.kind == Kind::TABLE;
  const KindInfo& info = info_of(*clue.kind);
  if (either(ErrorCode::LINE) && *clue.kind == Kind::TREE)
    return "segment_check";  // no other rule asks TREE for a line
  if (either(ErrorCode::ORDER) && clue.lines_done) return "token_check";
  const bool of_line = !info.state && *clue.kind != Kind::END;  // line_phase judges these, and no others
  if (either(ErrorCode::ORDER))
    return table ? "table_check" : info.tree ? "segment_check" : of_line ? "line_phase" : "token_check";
  if (either(ErrorCode::RANGE)) return table ? "table_check" : info.tree ? "segment_check" : "token_check";
  return "token_check";
}

// A command that is not the expected one.
std::string blame_command(const Clue& clue) {
  if (!clue.expected || !clue.actual) return "frame_control";
  if (clue.expected->load) return "pixel_loads";
  using namespace at::command;
  const auto same = [&](std::size_t i) {
    return (clue.expected->cares >> i & 1U) == 0 || clue.expected->value[i] == clue.actual->value[i];
  };
  // It should not have asked for one, unless it is the expected one but for its range: z and dz say which it is.
  if (clue.actual->value[xl] >= clue.actual->value[xr] && !(same(kind) && same(z) && same(dz))) return "frame_control";
  if (clue.value == kind) {  // another command altogether has another range, most often
    const bool same_range = same(xl) && same(xr);
    // frame_control asks for what a token does, or for a line to be painted first.
    const bool asked_for = clue.kind && (clue.actual->value[kind] == static_cast<std::uint64_t>(*clue.kind) ||
                                         clue.actual->value[kind] == static_cast<std::uint64_t>(Kind::RESOLVE));
    return same_range && !asked_for && clue.expected->value[kind] != static_cast<std::uint64_t>(Kind::EOL)
               ? "token_command"
               : "frame_control";
  }
  return "token_command";
}

}  // namespace

std::string part_name(const Config& config, const kage_rtl_event& event) {
  const std::uint64_t part = event.value[at::part::part];
  return part == static_cast<std::uint64_t>(Part::pixels) ? pixels(config) : std::string(kParts.at(part).module);
}

std::string blame(const Config& config, const Clue& clue) {
  const Stage stage = clue.expected ? clue.expected->stage : static_cast<Stage>(clue.actual->stage);
  switch (stage) {
    case Stage::token:
      return clue.polygons ? "front_end" : "token_reader";
    case Stage::unit:
      return "expansion_unit";
    case Stage::tree:
      return "tree_core";  // compare_tree is watched from its ports
    case Stage::command:
      return blame_command(clue);
    case Stage::error:
      return blame_error(clue);
    case Stage::pixel:
    case Stage::exit:
      return pixels(config);
    case Stage::load:
    case Stage::out:
      return "line_out";
    case Stage::part:
      return part_name(config, *clue.actual);
    case Stage::state:
      return "line_phase";
    case Stage::segment:
      // Whether it goes is segment_check's to say, what of the token goes is not.
      return clue.of_token || !clue.actual ? "segment_check" : "frame_control";
    case Stage::end:
      return clue.dropping ? "token_reader" : "frame_control";
    default:
      return "frame_control";
  }
}

Waiting waiting(const Config& config, const Handshakes& handshakes) {
  Waiting w;
  for (const PortInfo& p : kPorts) {
    if (!handshakes.waits(p.port)) continue;
    const auto name = [&](std::string_view n) { return n == "pixel_core" ? pixels(config) : std::string(n); };
    const std::string to = name(p.to);
    w.text += fmt::format("{}{}'s {} waits for {}", w.text.empty() ? "" : "; ", name(p.from), p.name, to);
    if (p.port != Port::video) w.module = to;
  }
  if (w.module != "line_out" || handshakes.waits(Port::return_line) || handshakes.valid(Port::line) ||
      !handshakes.ready(Port::line))
    return w;
  // The way out has no line to work on, so it may wait too.
  w.text += "; line_out has no line from frame_control";
  w.lacks_line = true;
  return w;
}

}  // namespace kage::cosim
