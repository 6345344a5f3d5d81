// SPDX-License-Identifier: Apache-2.0
#include "kage/cosim.hpp"

#include <optional>

#include "cosim/report/report_lock.hpp"
#include "cosim/session/command_lines.hpp"
#include "cosim/session/session.hpp"
#include "file/out_folder.hpp"
#include "json/json_text.hpp"

namespace kage::cosim {
namespace {

FirstDivergence told(const report::DivergenceRecord& d) {
  return {.module = d.module,
          .field = d.field,
          .expected = d.expected,
          .actual = d.actual,
          .frame = d.frame,
          .cycle = d.cycle,
          .token = d.token,
          .text = d.text};
}

FirstDifference told(const report::DifferenceRecord& d) {
  return {.frame = d.frame,
          .line = d.line,
          .x = d.x,
          .field = d.field,
          .expected = d.expected,
          .actual = d.actual,
          .text = d.text,
          .divergence = d.divergence ? std::optional(told(*d.divergence)) : std::nullopt};
}

SceneResult told(const report::SceneRecord& s) {
  SceneResult r;
  r.scene = s.scene;
  r.config = s.config_name;
  r.same = s.same;
  r.frames = s.frames;
  r.pixels = s.pixels_compared;
  r.spans = s.spans;
  r.segments = s.segments;
  r.cycles = s.cycles;
  if (s.first_difference) r.difference = told(*s.first_difference);
  r.pictures = s.pictures;
  r.notes = s.notes;
  return r;
}

}  // namespace

CosimResult run(const CosimOptions& options, Host& host) {
  CosimOptions o = options;
  if (o.lines.again.empty()) o.lines = command_lines(o);
  std::optional<OutFolder> folder;
  std::optional<report::ReportLock> lock;
  if (!o.out.empty()) folder.emplace(o.out);
  if (!o.out.empty() && !o.no_report) lock.emplace(o.out);
  Session session(o, host);
  session.compare();
  TempFiles files;
  const report::RunRecord record = session.finish(files);
  files.place();
  files.settle();
  CosimResult result;
  result.same = record.totals().same;
  result.interrupted = session.interrupted();
  for (const report::SceneRecord& s : record.scenes) result.scenes.push_back(told(s));
  result.json = json_text(report::to_json(record), 2) + "\n";
  return result;
}

CosimResult run(const CosimOptions& options) {
  Host silent;
  return run(options, silent);
}

}  // namespace kage::cosim
