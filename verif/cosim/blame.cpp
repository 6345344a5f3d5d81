// SPDX-License-Identifier: Apache-2.0
#include "cosim/blame.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace kage::cosim {
namespace {

struct Port {
  int bit;  // of its ready; valid is above
  const char* name;
  const char* from;
  const char* to;
};
constexpr int kLine = 10;
constexpr int kReturn = 20;
// From the way in to the way out.
constexpr std::array<Port, 11> kPorts{{{0, "token", "token_reader", "frame_control"},
                                       {2, "segment", "frame_control", "expansion_unit"},
                                       {4, "tree", "compare_tree", "pixel_core"},
                                       {6, "command", "frame_control", "pixel_loads"},
                                       {8, "command", "pixel_loads", "pixel_core"},
                                       {kLine, "line", "frame_control", "line_out"},
                                       {12, "load", "line_out", "pixel_loads"},
                                       {14, "video", "line_out", "the sink"},
                                       {16, "frame", "frame_control", "tree_core"},
                                       {18, "line", "pixel_core", "line_out"},
                                       {kReturn, "line that comes back", "frame_control", "line_out"}}};

std::string pixels(const Config& config) { return config.arrangement == 1 ? "pixel_banked" : "pixel_systolic"; }

bool is_of_segments(ErrorCode e) {
  return e == ErrorCode::SEGMENT || e == ErrorCode::UNIT_LONG || e == ErrorCode::UNIT_SHORT;
}

// An error that is not the expected one, or not where it should be. Which rule has failed says who keeps it.
std::string blame_error(const Clue& clue) {
  const auto code = [](std::uint64_t value) { return static_cast<ErrorCode>(value & 15U); };
  const ErrorCode expected = clue.expected ? code(clue.expected->value[0]) : ErrorCode::NONE;
  const ErrorCode actual = clue.actual ? code(clue.actual->value[0]) : ErrorCode::NONE;
  const auto any = [&](auto is) { return is(expected) || is(actual); };
  const auto either = [&](ErrorCode e) { return expected == e || actual == e; };
  if (clue.again || (clue.actual && clue.value == 0 && clue.actual->value[2] != clue.lines)) return "frame_control";
  if (clue.value > 0) return is_of_segments(expected) && clue.value >= 3 ? "segment_check" : "frame_control";
  if (either(ErrorCode::HEADER) || either(ErrorCode::SIZE) || either(ErrorCode::PARAMS)) return "frame_control";
  if (either(ErrorCode::LAST_LATE) &&
      (expected == ErrorCode::NONE || expected == ErrorCode::LAST_LATE))  // the flag that it comes of is token_reader's
    return clue.at_last == (expected == ErrorCode::LAST_LATE) ? "token_reader" : "token_check";
  if (any(is_of_segments)) return "segment_check";
  if (!clue.kind) return "token_check";
  const bool table = *clue.kind == Kind::TABLE;
  const bool segment = *clue.kind == Kind::SEG || *clue.kind == Kind::FACE || *clue.kind == Kind::TREE;
  if (either(ErrorCode::LINE) && *clue.kind == Kind::TREE)
    return "segment_check";  // no other rule asks TREE for a line
  if (either(ErrorCode::ORDER) && (clue.lines_done || *clue.kind == Kind::SHADE || *clue.kind == Kind::END))
    return "token_check";
  if (either(ErrorCode::ORDER)) return table ? "table_check" : segment ? "segment_check" : "line_phase";
  if (either(ErrorCode::RANGE)) return table ? "table_check" : segment ? "segment_check" : "token_check";
  return "token_check";
}

// A command that is not the expected one.
std::string blame_command(const Clue& clue) {
  if (!clue.expected || !clue.actual) return "frame_control";
  if (clue.expected->load) return "pixel_loads";
  const auto same = [&](unsigned i) {
    return (clue.expected->cares >> i & 1U) == 0 || clue.expected->value[i] == clue.actual->value[i];
  };
  // It should not have asked for one, unless it is the expected one but for its range: z and dz say which it is.
  if (clue.actual->value[1] >= clue.actual->value[2] && !(same(0) && same(4) && same(5))) return "frame_control";
  if (clue.value == 0) {  // another command altogether has another range, most often
    const bool same_range = same(1) && same(2);
    // frame_control asks for what a token does, or for a line to be painted first.
    const bool asked_for = clue.kind && (clue.actual->value[0] == static_cast<std::uint64_t>(*clue.kind) ||
                                         clue.actual->value[0] == static_cast<std::uint64_t>(Kind::RESOLVE));
    return same_range && !asked_for && clue.expected->value[0] != static_cast<std::uint64_t>(Kind::EOL)
               ? "token_command"
               : "frame_control";
  }
  return "token_command";
}

}  // namespace

std::string part_name(const Config& config, const kage_rtl_event& event) {
  if (event.value[0] == KAGE_PART_PIXELS) return pixels(config);
  static constexpr std::array<std::string_view, 16> kNames{"ram_1r1w",     "stream_fifo",    "skid_buffer",
                                                           "compare_cell", "light_resolve",  "pixel_loads",
                                                           "lane_ramp",    "token_command",  "",
                                                           "tree_core",    "kage_top",       "pixel_core",
                                                           "compare_tree", "expansion_unit", "frame_control",
                                                           "table_check"};
  return std::string(kNames.at(event.value[0]));
}

std::string blame(const Config& config, const Clue& clue) {
  const Stage stage = clue.expected ? clue.expected->stage : static_cast<Stage>(clue.actual->stage);
  switch (stage) {
    case Stage::token:
      return "token_reader";
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

Waiting waiting(const Config& config, std::uint32_t handshakes) {
  Waiting w;
  for (const Port& p : kPorts) {
    const bool valid = (handshakes >> (p.bit + 1) & 1U) != 0;
    const bool ready = (handshakes >> p.bit & 1U) != 0;
    if (!valid || ready) continue;
    const auto name = [&](const char* n) { return std::string_view(n) == "pixel_core" ? pixels(config) : n; };
    const std::string to = name(p.to);
    w.text += fmt::format("{}{}'s {} waits for {}", w.text.empty() ? "" : "; ", name(p.from), p.name, to);
    if (std::string_view(p.to) != "the sink") w.module = to;
  }
  const auto bit = [&](int i) { return (handshakes >> i & 1U) != 0; };
  const bool returns = bit(kReturn + 1) && !bit(kReturn);  // it has been told to send a line back
  if (w.module != "line_out" || returns || bit(kLine + 1) || !bit(kLine)) return w;
  // The way out has no line to work on, so it may wait too.
  w.text += "; line_out has no line from frame_control";
  w.lacks_line = true;
  return w;
}

}  // namespace kage::cosim
