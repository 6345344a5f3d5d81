// SPDX-License-Identifier: Apache-2.0
#include "cosim_print.hpp"

#include <fmt/format.h>

#include <cerrno>

#include "cosim/diverge/waveform.hpp"
#include "cosim/recall.hpp"
#include "kage/error.hpp"
#include "results.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

/// Where the pictures are; after a difference, which to look at.
std::string pictures_of(const report::SceneRecord& scene, const std::string& folder) {
  const std::string& last = scene.pictures.back();
  if (scene.same) return folder;
  return last + (last.ends_with("_difference.png") ? ", with _expected and _actual beside it" : "");
}

void print_difference(const report::DifferenceRecord& d) {
  fmt::print("first difference: {}\n", shown(d.text));
  if (d.divergence)
    fmt::print("first divergence: {}\n", shown(d.divergence->text));
  else if (d.no_divergence)
    fmt::print("{}\n", shown(*d.no_divergence));
}

void print_waveform(const report::DifferenceRecord& d) {
  if (d.waveform && d.divergence)
    fmt::print("waveform: {}; {}\n", shown(*d.waveform),
               shown(cosim::gtkwave_line(d.divergence->save_file.value_or(""))));
}

/// The frame that was kept, and how to run it again.
void print_kept(const report::KeptRecord& kept) {
  fmt::print("{}: {}: {}, {}, {} wide, {} of {}\n", kept.ahead ? "the frame right ahead of it" : "the frame",
             shown(kept.file), counted(kept.lines, "line"), counted(kept.tokens, "token"), counted(kept.width, "pixel"),
             kept.words, counted(kept.words_before, "word"));
  if (kept.takes) fmt::print("alone, on a new core, it comes out the same: it takes {}\n", *kept.takes);
  if (kept.alone || kept.in_place) fmt::print("that frame again: {}\n", shown(kept.again));
}

}  // namespace

void print_verdict(const report::SceneRecord& s, const std::string& who) {
  if (s.board) {
    const report::BoardRecord& b = *s.board;
    fmt::print("{}{}: {}, {}{}x{}, {} compared, {}{}, {}, {}, board {} {:.3f} s\n", who, s.same ? "same" : "different",
               counted(s.frames, "frame"), s.sizes_vary ? "up to " : "", s.width, s.height,
               counted(s.pixels_compared, "pixel"), counted(s.spans, "span"), and_segments(s.segments),
               counted(b.lines_compared, "line"), counted(b.registers_compared, "register"), b.name, b.seconds);
    return;
  }
  fmt::print("{}{}: {}{}, {}{}x{}, {} compared, {}{}, {}, golden {:.3f} s, {} {:.3f} s, seed {}\n", who,
             s.same ? "same" : "different", counted(s.frames, "frame"),
             cosim::taken_text(s.verdicts.taken_frames.size()), s.sizes_vary ? "up to " : "", s.width, s.height,
             counted(s.pixels_compared, "pixel"), counted(s.spans, "span"), and_segments(s.segments),
             counted(s.cycles, "cycle"), s.golden_seconds,
             s.options.netlist.empty() ? "RTL" : "cells of " + s.options.netlist, s.rtl_seconds, s.seed);
}

void print_coverage(const report::CoverageRecord& coverage, const std::string& who) {
  std::string group;
  for (const report::CoveragePointRecord& p : coverage.points) {
    if (p.group != group) fmt::print("{}{}:\n", who, group = p.group);
    fmt::print("  {:<50} {}\n", p.name,
               p.frames == 0
                   ? std::string("not reached")
                   : fmt::format("{} of {} ({:.1f} %)", p.frames, counted(coverage.frames, "frame"),
                                 100.0 * static_cast<double>(p.frames) / static_cast<double>(coverage.frames)));
  }
}

void print_finding(const report::SceneRecord& s, const std::string& who) {
  print_verdict(s, who);
  if (s.first_difference) print_difference(*s.first_difference);
}

void print_report(const report::SceneRecord& s, const std::string& who, const std::string& folder) {
  if (s.frames == 0) {
    fmt::print("{}no frame in this shard\n", who);
    return;
  }
  print_verdict(s, who);
  if (s.coverage) print_coverage(*s.coverage, "");
  if (s.first_difference) {
    print_difference(*s.first_difference);
    print_waveform(*s.first_difference);
  }
  if (s.kept) print_kept(*s.kept);
  if (!s.pictures.empty()) fmt::print("pictures: {}\n", shown(pictures_of(s, folder)));
  if (s.page) fmt::print("report: {}\n", shown(*s.page));
}

}  // namespace kage::cli
