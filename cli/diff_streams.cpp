// SPDX-License-Identifier: Apache-2.0
// kage diff of two stream files.
#include <fmt/format.h>

#include <algorithm>

#include "command.hpp"
#include "cosim/report/junit.hpp"
#include "diff.hpp"
#include "kage/stream_diff.hpp"
#include "mapped.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

/// "frame 0, line 3, token 41, field z"
std::string place(const StreamPlace& p) {
  std::string text = fmt::format("frame {}", p.frame);
  if (p.line) text += fmt::format(", line {}", *p.line);
  return text + fmt::format(", token {}, field {}", p.token, p.field);
}

std::string both(const StreamPlace& p) { return fmt::format("  A: {}\n  B: {}\n", p.a, p.b); }

Json to_json(const StreamDiff& d) {
  const auto number = [&](std::uint64_t value) { return d.tokens_compared ? Json(value) : Json(nullptr); };
  Json j;
  j["same"] = d.same;
  for (const char* name : {"width", "height", "channels", "different_pixels", "max_lsb"}) j[name] = nullptr;
  j["first"] = nullptr;
  if (d.first) {
    const StreamPlace& p = *d.first;
    j["first"] = Json{{"frame", p.frame}, {"line", p.line ? Json(*p.line) : Json(nullptr)},
                      {"token", p.token}, {"field", p.field},
                      {"a", p.a},         {"b", p.b}};
  }
  j["frames_a"] = d.frames_a;
  j["frames_b"] = d.frames_b;
  j["expanded_frames"] = d.expanded_frames;
  j["different_frames"] = number(d.different_frames);
  j["different_lines"] = number(d.different_lines);
  j["different_tokens"] = number(d.different_tokens);
  j["config"] = Json::array();
  for (const StreamDiff::Parameter& p : d.parameters)
    j["config"].push_back(Json{{"parameter", p.name}, {"a", p.a}, {"b", p.b}});
  j["sections"] = Json::array();
  for (const StreamDiff::Section& s : d.sections) j["sections"].push_back(Json{{"section", s.tag}, {"differs", s.how}});
  j["reason"] = d.reason.empty() ? Json(nullptr) : Json(d.reason);
  return j;
}

std::string describe(const StreamDiff& d) {
  std::string text = d.same ? fmt::format("same: {}", counted(d.frames_a, "frame")) : "different: " + d.reason;
  if (d.different_frames != 0 && d.tokens_compared)
    text +=
        fmt::format(", {} and {} in them", counted(d.different_lines, "line"), counted(d.different_tokens, "token"));
  text += '\n';
  if (d.expanded_frames != 0)
    text +=
        fmt::format("{} at the polygon level in one stream alone: compared by the spans that the polygons come to\n",
                    counted(d.expanded_frames, "frame"));
  if (!d.tokens_compared) text += "tokens are not compared: the same words mean others in the two configurations\n";
  for (const StreamDiff::Parameter& p : d.parameters)
    text += fmt::format("configuration: {} is {} in A, {} in B\n", p.name, p.a, p.b);
  if (d.first) text += fmt::format("first difference: {}\n{}", place(*d.first), both(*d.first));
  if (!d.same && d.sections.empty()) text += "sections other than configuration and frames are the same\n";
  return text;
}

}  // namespace

std::pair<bool, std::string> compare_streams(const std::string& a, const std::string& b) {
  guard_mapped(a);
  guard_mapped(b);
  const StreamDiff d = diff_streams(StreamFile(a), StreamFile(b), [](const FrameDiff&) {
    check_interrupt();
    check_mapped();
  });
  check_mapped();
  return {d.same, describe(d)};
}

int diff_two_streams(const DiffCommand& o) {
  guard_mapped(o.a);
  guard_mapped(o.b);
  const StreamFile a(o.a);
  const StreamFile b(o.b);
  TempFiles files;
  report::JUnitWriter junit(files, o.junit, "kage diff");
  const int frames = std::max(a.frame_count(), b.frame_count());
  Progress progress;
  Stopwatch watch;
  const StreamDiff d = diff_streams(a, b, [&](const FrameDiff& frame) {
    check_interrupt();
    check_mapped();
    progress.show(fmt::format("frame {}/{}", frame.frame + 1, frames));
    const std::string name = fmt::format("frame {}", frame.frame);
    if (!frame.compared)
      junit.skip(name, "not compared: the configurations are unlike");
    else if (frame.same)
      junit.pass(name, watch.seconds());
    else
      junit.fail(name, watch.seconds(),
                 fmt::format("{} and {} differ, the first at {}", counted(frame.different_lines, "line"),
                             counted(frame.different_tokens, "token"), place(*frame.first)),
                 both(*frame.first));
    watch = Stopwatch();
  });
  check_mapped();
  progress.clear();
  if (d.parameters.empty())
    junit.pass("configuration", 0);
  else
    junit.fail("configuration", 0, d.reason);
  if (d.sections.empty())
    junit.pass("sections", 0);
  else
    junit.fail("sections", 0, d.reason);
  junit.close();
  finish(o.json, {"kage.diff-streams/1", to_json(d)}, files, describe(d));
  return d.same ? kSame : kDifferent;
}

}  // namespace kage::cli
