// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/run_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "cosim/diverge/waveform.hpp"
#include "cosim/model/model.hpp"
#include "file/shown.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

/// So many pixels of a different frame are told with what the RTL did: the first, and one of each region.
constexpr std::size_t kToldPixels = 8;
/// No further one is begun after so many seconds.
constexpr double kTellSeconds = 3;

/// The first pixel of each region that differs, the region with most pixels first.
std::vector<std::pair<int, int>> pixels_of(const Report& run, const TempFiles& made) {
  std::vector<std::pair<int, int>> pixels;
  if (run.first_difference->x >= 0 && run.first_difference->line >= 0)
    pixels.emplace_back(run.first_difference->x, run.first_difference->line);
  const auto picture = [&](std::string_view end) {
    for (const std::string& p : run.pictures)
      if (p.ends_with(end)) return load_image(made.now(p));
    return Image();
  };
  const Image expected = picture("_expected.png");
  const Image actual = picture("_actual.png");
  if (!run.difference || expected.data.size() != actual.data.size()) return pixels;
  const auto differs = [&](int x, int y) {
    const std::size_t at = expected.index(x, y);
    return !std::equal(expected.data.begin() + static_cast<std::ptrdiff_t>(at),
                       expected.data.begin() + static_cast<std::ptrdiff_t>(at) + expected.channels,
                       actual.data.begin() + static_cast<std::ptrdiff_t>(at));
  };
  for (const DiffResult::Region& r : run.difference->regions) {
    bool found = false;
    for (int y = r.box.y; y < r.box.y + r.box.height && !found; ++y)
      for (int x = r.box.x; x < r.box.x + r.box.width && !found; ++x) {
        found = differs(x, y);
        if (found && std::find(pixels.begin(), pixels.end(), std::pair(x, y)) == pixels.end())
          pixels.emplace_back(x, y);
      }
  }
  if (pixels.size() > kToldPixels) pixels.resize(kToldPixels);
  return pixels;
}

/// The bands with a line in which the pictures differ.
std::set<int> bands_that_differ(const Report& run) {
  std::set<int> bands;
  if (!run.difference) return bands;
  for (const DiffResult::Region& r : run.difference->regions)
    for (int y = r.box.y; y < r.box.y + r.box.height; ++y) bands.insert(y / report::kBandLines * report::kBandLines);
  return bands;
}

}  // namespace

std::vector<std::string> versions() {
  std::vector<std::string> all = model_tools();
  all.insert(all.begin(), fmt::format("kage {}", KAGE_VERSION));
  return all;
}

Listener::Listener(Source& source) : source_(source) {
  keep([&] { tokens_.emplace(source.config(), report::kPageBytes); });
}

void Listener::keep(const std::function<void()>& step) {
  if (!trouble_.empty()) return;
  try {
    step();
  } catch (const Error& e) {
    trouble_ = e.what();
    tokens_.reset();
  }
}

TokenCounts Listener::frame(int index, const WordSink& sink) {
  if (frames_++ >= cosim::kFrameResults) return source_.frame(index, sink);
  keep([&] { tokens_->begin(index); });
  const TokenCounts counts = source_.frame(index, [&](std::span<const std::uint32_t> words) {
    keep([&] { tokens_->words(words); });
    sink(words);
  });
  keep([&] { tokens_->end(); });
  return counts;
}

void Listener::absorb(const Listener& later) {
  keep([&] {
    if (!later.tokens_) throw Error(later.trouble_);
    tokens_->append(*later.tokens_, cosim::kFrameResults - std::min(cosim::kFrameResults, frames_));
  });
  frames_ += later.frames_;
}

const report::TokenStore& Listener::tokens() const {
  if (!tokens_) throw Error(trouble_);
  return *tokens_;
}

RunReport::RunReport(Source& source, CommandLines lines, Host& host)
    : source_(source), lines_(std::move(lines)), host_(host), listener_(source) {}

void RunReport::tell_pixels(report::Page& page, const std::optional<Divergence>& divergence, const Watch& watch) {
  const int frame = page.run->first_difference->frame;
  const auto pixels = pixels_of(*page.run, *page.made);
  if (pixels.empty()) return;
  const std::vector<std::uint32_t> words = source_.words(frame);
  const auto feed = [&](int i, const WordSink& sink) { return source_.frame(i, sink); };
  const Config& config = page.record.config;
  const ReplayOptions options = watch ? watch() : ReplayOptions();
  const auto provenance = source_.provenance(frame);
  // State that an earlier frame left in the core shows only behind that frame.
  const int from = divergence ? std::min(frame, divergence->from) : frame;
  const auto begin = std::chrono::steady_clock::now();
  for (const auto& [x, y] : pixels) {
    host_.check();
    report::ToldPixel told;
    told.frame = frame;
    told.history = explain_pixel(config, words, x, y);
    if (provenance) {
      const auto sources = provenance->of_history(config, words, told.history);
      for (const auto& [nth, source] : sources) told.from[nth] = source.text();
      told.left_out = source_.left_out(frame, {&told.history, &sources}).value_or(std::vector<LeftOut>());
    }
    try {
      if (watch) told.rtl = cosim::watch_pixel(from, frame, feed, config, options, x, y);
    } catch (const Error& e) {
      // The verdict stands without it.
      source_.note(fmt::format("pixel {},{}: the RTL could not be watched: {}", x, y, e.what()));
    }
    page.told.push_back(std::move(told));
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > kTellSeconds) break;
  }
}

std::string RunReport::write(TempFiles& files, const std::string& folder, const Report& run,
                             const report::SceneRecord& record, const std::optional<Divergence>& divergence,
                             const Watch& watch) {
  report::Page page;
  page.tokens = &listener_.tokens();
  page.record = record;
  page.run = &run;
  page.made = &files;
  if (divergence && !divergence->save_file.empty()) page.gtkwave = gtkwave_line(divergence->save_file);
  page.explain = lines_.explain;
  page.rtl_options = lines_.rtl;
  page.explain_rtl = (page.rtl_options.empty() ? "" : " " + page.rtl_options) + " --rtl";
  page.polygons = source_.level() == Level::polygons;
  std::optional<report::TokenStore> wanted;
  if (run.first_difference && run.first_difference->frame != cosim::kBehindFrames) {
    const std::set<int> bands = bands_that_differ(run);
    const int frame = run.first_difference->frame;
    wanted.emplace(record.config, report::kPageBytes);
    wanted->choose([&](int, int line) { return line < 0 || bands.count(line) != 0; });
    wanted->begin(frame);
    source_.frame(frame, [&](std::span<const std::uint32_t> words) { wanted->words(words); });
    wanted->end();
    page.wanted = &*wanted;
    tell_pixels(page, divergence, watch);
  }
  page.record.notes = source_.notes();
  const auto path = std::filesystem::path(folder) / "report.html";
  TempFiles own;  // half a page is not to be among the others
  report::write_page(own, path, page);
  files.take(own);
  return path.string();
}

}  // namespace kage::cosim
