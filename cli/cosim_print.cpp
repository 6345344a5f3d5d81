// SPDX-License-Identifier: Apache-2.0
#include "cosim_print.hpp"

#include <fmt/format.h>

#include <cerrno>

#include "ci.hpp"
#include "cosim/recall.hpp"
#include "kage/error.hpp"
#include "results.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

/// Where the pictures are; after a difference, which to look at.
std::string pictures_of(const Json& report, const std::string& folder) {
  const auto last = report["pictures"].back().get<std::string>();
  if (report["same"].get<bool>()) return folder;
  return last + (last.ends_with("_difference.png") ? ", with _expected and _actual beside it" : "");
}

void print_difference(const Json& d) {
  fmt::print("first difference: {}\n", d["text"].get<std::string>());
  const Json& by = d["divergence"];
  if (!by.is_null()) {
    fmt::print("first divergence: {}\n", by["text"].get<std::string>());
    if (!d["waveform"].is_null())
      fmt::print("waveform: {}; {}\n", d["waveform"].get<std::string>(),
                 gtkwave_line(by["save_file"].get<std::string>()));
  } else if (!d["no_divergence"].is_null()) {
    fmt::print("{}\n", d["no_divergence"].get<std::string>());
  }
}

/// The frame that was kept, and how to run it again.
void print_kept(const Json& kept) {
  const auto number = [&](const char* key) { return kept[key].get<std::uint64_t>(); };
  fmt::print("the frame: {}: {}, {}, {} wide, {} of {}\n", kept["file"].get<std::string>(),
             counted(number("lines"), "line"), counted(number("tokens"), "token"), counted(number("width"), "pixel"),
             number("words"), counted(number("words_before"), "word"));
  if (kept["alone"].get<bool>())
    fmt::print("that frame again: {}\n", kept["again"].get<std::string>());
  else
    fmt::print("alone, on a new core, it comes out the same: it takes the frames before it, or stalls of its place\n");
}

/// What the frames reached, and what none did.
void print_coverage(const Json& coverage) {
  const auto frames = coverage["frames"].get<std::uint64_t>();
  std::string group;
  for (const Json& p : coverage["points"]) {
    if (p["group"] != group) fmt::print("{}:\n", group = p["group"].get<std::string>());
    const auto hits = p["frames"].get<std::uint64_t>();
    fmt::print("  {:<50} {}\n", p["name"].get<std::string>(),
               hits == 0 ? std::string("not reached")
                         : fmt::format("{} of {} ({:.1f} %)", hits, counted(frames, "frame"),
                                       100.0 * static_cast<double>(hits) / static_cast<double>(frames)));
  }
}

}  // namespace

ReportLock::ReportLock(const std::string& folder) : lock_(folder, O_RDONLY | O_DIRECTORY) {
  // Where the file system knows no locks nothing is kept out.
  if (!lock_.try_lock() && errno == EWOULDBLOCK)
    throw Error(
        fmt::format("{}: another run writes its report there: give one of them a folder of its own by --out", folder));
}

void print_verdict(const Json& report, const std::string& who) {
  const auto number = [&](const char* key) { return report[key].get<std::uint64_t>(); };
  fmt::print("{}{}: {}{}, {}{}x{}, {} compared, {}{}, {}, golden {:.3f} s, RTL {:.3f} s, seed {}\n", who,
             report["same"].get<bool>() ? "same" : "different", counted(number("frames"), "frame"),
             cosim::taken_text(taken_of(report)), report["sizes_vary"].get<bool>() ? "up to " : "", number("width"),
             number("height"), counted(number("pixels_compared"), "pixel"), counted(number("spans"), "span"),
             and_segments(number("segments")), counted(number("cycles"), "cycle"),
             report["golden_seconds"].get<double>(), report["rtl_seconds"].get<double>(), number("seed"));
}

void print_report(const Json& report, const std::string& who, const std::string& folder) {
  if (!has_frames(report)) {
    fmt::print("{}no frame in this shard\n", who);
    return;
  }
  print_verdict(report, who);
  if (report.contains("coverage")) print_coverage(report["coverage"]);
  if (!report["same"].get<bool>()) print_difference(report["first_difference"]);
  if (const Json& kept = report["kept"]; !kept.is_null()) print_kept(kept);
  if (!report["pictures"].empty()) fmt::print("pictures: {}\n", pictures_of(report, folder));
  if (!report["report"].is_null()) fmt::print("report: {}\n", report["report"].get<std::string>());
}

}  // namespace kage::cli
