// SPDX-License-Identifier: Apache-2.0
// Cost of the report page beyond the run itself: time to pack the tokens while the frames are made, and to write the
// page. 640x480, the first eight frames of each scene. The golden model stands in for the RTL, whose time is no part of
// the cost.
#include <fmt/format.h>
#include <unistd.h>

#include "bench/timer.hpp"
#include "cosim/core.hpp"
#include "cosim/report/page.hpp"
#include "kage/config.hpp"
#include "kage/pipeline.hpp"

int main() {
  using namespace kage;
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / fmt::format("kage-bench-report-{}", static_cast<long>(getpid()));
  fs::create_directory(folder);
  fmt::print("{:<13} {:<12} {:>6} {:>11} {:>10} {:>10} {:>12} {:>14}\n", "scene", "config", "frames", "words",
             "packing s", "writing s", "page bytes", "lines told %");
  for (const std::string& name : builtin_scenes()) {
    const auto scene = std::make_shared<const Scene>(Scene::load(name));
    const int frames = std::min(8, scene->frame_count());
    // No scene needs segments; the page is to show some.
    const DrawOptions draw{.width = 640, .height = 480, .frames = frames, .threads = 1};
    const NamedConfig config = name == "polyhedra" ? load_config(name) : choose_config(*scene, draw);
    const Config& c = config.config;
    SceneFrames source(scene, c, draw);
    report::TokenStore tokens(c, report::kPageBytes);
    double packing = 0;
    std::uint64_t count = 0;
    const auto golden = cosim::make_golden(c);
    const auto other = cosim::make_golden(c);
    cosim::RunOptions options;
    options.out = folder;
    const cosim::Report run = cosim::run(
        frames,
        [&](int i, const WordSink& sink) {
          std::vector<std::uint32_t> words;
          const TokenCounts counts = source.frame(
              i, [&](std::span<const std::uint32_t> piece) { words.insert(words.end(), piece.begin(), piece.end()); });
          const bench::Timer timer;
          tokens.begin(i);
          tokens.words(words);
          tokens.end();
          packing += timer.seconds();
          count += words.size();
          sink(words);
          return counts;
        },
        *golden, *other, options);
    report::Page page;
    page.record.take(run);
    page.record.scene = name;
    page.record.config_name = config.name;
    page.record.config = c;
    page.run = &run;
    page.tokens = &tokens;
    const bench::Timer timer;
    TempFiles files;
    report::write_page(files, folder / "report.html", page);
    files.commit();
    const double writing = timer.seconds();
    int told = 0;
    for (const report::Band& b : tokens.bands()) told += b.line < 0 ? 0 : report::kBandLines;
    fmt::print("{:<13} {:<12} {:>6} {:>11} {:>10.3f} {:>10.3f} {:>12} {:>14.1f}\n", name, config.name, frames, count,
               packing, writing, fs::file_size(folder / "report.html"), 100.0 * told / (480.0 * frames));
  }
  fs::remove_all(folder);
  return 0;
}
