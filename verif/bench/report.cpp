// SPDX-License-Identifier: Apache-2.0
// What the report page of a run costs beyond the run itself: time to pack the tokens while the frames are made, and to
// write the page. 640x480, the first eight frames of each scene; the golden model stands in for the RTL, whose time is
// no part of it.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>

#include "cosim/core.hpp"
#include "cosim/report/page.hpp"
#include "kage/config.hpp"
#include "kage/frontend.hpp"
#include "kage/scene.hpp"

namespace {

using namespace kage;

class Clock {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

int main() {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / fmt::format("kage-bench-report-{}", static_cast<long>(getpid()));
  fs::create_directory(folder);
  fmt::print("{:<13} {:<9} {:>6} {:>11} {:>10} {:>10} {:>12} {:>14}\n", "scene", "config", "frames", "words",
             "packing s", "writing s", "page bytes", "lines told %");
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    const NamedConfig config = load_config(name == "penumbra"       ? "soft"
                                           : name == "three-lights" ? "lights"
                                           : name == "glass"        ? "glass"
                                           : name == "polyhedra"    ? "polyhedra"
                                           : name == "knot"         ? "full"
                                                                    : "default");
    const Config& c = config.config;
    const int frames = std::min(8, scene.frame_count());
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
          make_frame(make_geometry(scene.frame(i, frames), c, 640, 480), c, static_cast<std::uint32_t>(i), words,
                     {.threads = 1});
          const TokenCounts counts = check_frame(c, words, name, 0);
          Clock clock;
          tokens.begin(i);
          tokens.words(words);
          tokens.end();
          packing += clock.lap();
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
    Clock clock;
    TempFiles files;
    report::write_page(files, folder / "report.html", page);
    files.commit();
    const double writing = clock.lap();
    int told = 0;
    for (const report::Band& b : tokens.bands()) told += b.line < 0 ? 0 : report::kBandLines;
    fmt::print("{:<13} {:<9} {:>6} {:>11} {:>10.3f} {:>10.3f} {:>12} {:>14.1f}\n", name, config.name, frames, count,
               packing, writing, fs::file_size(folder / "report.html"), 100.0 * told / (480.0 * frames));
  }
  fs::remove_all(folder);
  return 0;
}
