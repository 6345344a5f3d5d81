// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/command_lines.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <type_traits>

#include "cosim/session/option_names.hpp"
#include "file/shown.hpp"

namespace kage::cosim {
namespace {

/// Options, each behind a blank.
class Line {
 public:
  template <class Value>
  void option(std::string_view name, const Value& value, const Value& usual) {
    if (value == usual) return;
    if constexpr (std::is_same_v<Value, std::string>)
      text_ += fmt::format(" {} {}", name, quoted(value));
    else
      text_ += fmt::format(" {} {}", name, value);
  }
  void flag(std::string_view name, bool given) {
    if (given) text_ += fmt::format(" {}", name);
  }
  [[nodiscard]] const std::string& text() const { return text_; }
  /// Without the first blank.
  [[nodiscard]] std::string alone() const { return text_.empty() ? text_ : text_.substr(1); }

 private:
  std::string text_;
};

/// In the order of kage cosim --help, so that lines made here are those that the program makes of its own.
void pictures(Line& line, const SourceOptions& o) {
  const SourceOptions usual;
  line.option("--config", o.config, usual.config);
  line.flag("--degrade", o.degrade);
  line.flag("--units-only", o.units_only);
  line.flag("--all-spans", o.all_spans);
  if (o.size_given || o.size.width != usual.size.width || o.size.height != usual.size.height)
    line.option("--size", fmt::format("{}x{}", o.size.width, o.size.height), std::string());
  line.option("--frames", o.frames, usual.frames);
  line.option("--order", name_of(o.order), name_of(usual.order));
  line.option("--alpha", o.alpha, usual.alpha);
  line.flag("--cull", o.cull);
  if (o.max_fragments) line.option("--max-fragments", fmt::to_string(*o.max_fragments), std::string());
  line.option("--samples", o.samples, usual.samples);
  line.option("--classes", o.classes, usual.classes);
  line.option("--max-shading", o.max_shading, usual.max_shading);
  line.option("--sub-bits", o.sub_bits, usual.sub_bits);
  line.option("--seed", fmt::to_string(o.seed), std::string());
}

void front_end(Line& line, const SourceOptions& o) {
  line.flag("--allow-outside", o.allow_outside);
  if (!o.level_option.empty() || o.level != SourceOptions().level)
    line.option("--front-end", front_end_of(o.level), std::string());
}

void stalls(Line& line, const RtlRun& rtl) {
  line.option("--idle", rtl.idle, 0);
  line.option("--backpressure", rtl.backpressure, 0);
}

void defects(Line& line, const RtlRun& rtl) {
  line.option("--fault", rtl.fault, std::string());
  line.option("--mutant", rtl.mutant, 0);
}

/// The line of kage cosim: whole, or without the options that say which frames are run, by how many jobs, and where
/// files go (CommandLines::in_place).
std::string cosim_line(const CosimOptions& o, bool whole) {
  Line line;
  if (o.inputs.empty()) line.flag(quoted(o.input), true);
  for (const std::string& input : o.inputs) line.flag(quoted(input), true);
  if (whole) line.option("--out", o.out, std::string());
  pictures(line, o);
  line.option("--threads", o.threads, 0);
  front_end(line, o);
  stalls(line, o.rtl);
  line.option("--netlist", o.rtl.netlist, std::string());
  defects(line, o.rtl);
  if (whole) line.option("--jobs", o.jobs, 0);
  line.flag("--no-divergence", o.no_divergence);
  line.flag("--stages", o.stages);
  if (whole && o.shard.given) line.option("--shard", fmt::format("{}/{}", o.shard.index, o.shard.count), std::string());
  if (whole) line.option("--frame", o.frame, -1);
  line.flag("--no-shrink", o.no_shrink);
  if (whole) line.flag("--coverage", o.coverage);
  line.flag("--no-report", o.no_report);
  return "kage cosim" + line.text();
}

}  // namespace

CommandLines command_lines(const CosimOptions& options) {
  if (options.scene || options.parameters) return {};
  Line rtl;
  defects(rtl, options.rtl);
  rtl.option("--netlist", options.rtl.netlist, std::string());
  stalls(rtl, options.rtl);
  Line explain;
  pictures(explain, options);
  front_end(explain, options);
  return {.again = cosim_line(options, true),
          .in_place = cosim_line(options, false),
          .rtl = rtl.alone(),
          .explain = explain.alone()};
}

}  // namespace kage::cosim
