// SPDX-License-Identifier: Apache-2.0
// Cost of a co-simulation of courtyard: first each part, on one thread, golden model and RTL side by side; then the
// whole with several jobs.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <string>
#include <thread>

#include "bench/program.hpp"
#include "bench/timer.hpp"
#include "cosim/core.hpp"
#include "cosim/model/model.hpp"
#include "cosim/model/rtl.hpp"
#include "cosim/run.hpp"
#include "kage/config.hpp"
#include "kage/pipeline.hpp"

namespace {

using namespace kage;

/// Processor time of this process.
double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

/// Cost of the comparison on top of both cores, and of the monitors on top of the RTL. Runs take turns, so that other
/// load of the machine affects all alike.
void compare_cost(const std::shared_ptr<const Scene>& scene, const Config& config,
                  const std::filesystem::path& library) {
  SceneFrames source(scene, config, {.width = 640, .height = 480, .threads = 1});
  std::vector<std::vector<std::uint32_t>> frames;
  for (int i = 0; i < source.frames(); ++i) frames.push_back(source.words(i));
  const auto golden = cosim::make_golden(config);
  const auto rtl = cosim::make_rtl(library, config);
  const auto monitored = cosim::make_rtl(cosim::find_model(config, {.monitors = true}).library, config);
  std::uint64_t sum = 0;  // somebody reads the pixels
  const LineSink sink = [&sum](int, std::span<const std::uint8_t> pixels) { sum += pixels.back(); };
  const cosim::Feed feed = [&](int i, const WordSink& out) {
    out(frames[static_cast<std::size_t>(i)]);
    return TokenCounts{};
  };
  cosim::RunOptions options;
  options.two_threads = false;
  double both = 1e300;
  double compared = 1e300;
  double watched = 1e300;
  const auto time = [](double& best, auto work) {
    const double start = processor_seconds();
    work();
    best = std::min(best, processor_seconds() - start);
  };
  for (int run = 0; run < 9; ++run) {
    time(both, [&] {
      for (const auto& words : frames) {
        (void)golden->frame(words, sink);
        (void)rtl->frame(words, sink);
      }
    });
    time(compared, [&] { (void)cosim::run(source.frames(), feed, *golden, *rtl, options); });
    if (run % 3 == 0)
      time(watched, [&] {
        for (const auto& words : frames) (void)monitored->frame(words, sink);
      });
  }
  fmt::print(
      "both cores alone {:.1f} ms a pass, compared {:.1f} ms: the comparison adds {:+.1f} %; RTL built with monitors, "
      "none read: {:.1f} ms\n",
      both * 1e3, compared * 1e3, (compared / both - 1) * 100, watched * 1e3);
}

/// kage cosim with 1, 2, 4 and 8 jobs, as a program. Two things limit the speed-up. First the processors: one job alone
/// keeps a little more than one busy. Second the frame before each range but the first: it is run again, so that the
/// range finds the core as one job would. The processors' own limit is measured by as many programs of one job each,
/// run beside each other.
void jobs_cost() {
  namespace fs = std::filesystem;
  constexpr int kFrames = 96;
  const fs::path folder = fs::temp_directory_path() / fmt::format("kage-jobs-{}", getpid());
  fmt::print("\nkage cosim courtyard --frames {} --no-report --jobs N, on {} processors; least of 3 runs\n", kFrames,
             std::thread::hardware_concurrency());
  fmt::print("{:>4} {:>9} {:>9} {:>11} {:>15} {:>16} {:>9}\n", "jobs", "seconds", "frames/s", "against 1",
             "processor s", "processors busy", "MiB");
  const auto program = [&](int jobs, const std::string& out) {
    return bench::run_program({KAGE_PROGRAM, "cosim", "courtyard", "--frames", std::to_string(kFrames), "--no-report",
                               "--jobs", std::to_string(jobs), "--out", (folder / out).string()});
  };
  double one = 0;
  for (const int jobs : {1, 2, 4, 8}) {
    bench::ProgramCost least{1e300, 0, 0};
    for (int i = 0; i < 3; ++i) {
      const auto cost = program(jobs, "0");
      if (cost.seconds < least.seconds) least = cost;
    }
    if (jobs == 1) one = least.seconds;
    fmt::print("{:>4} {:>9.2f} {:>9.2f} {:>11.2f} {:>15.2f} {:>16.2f} {:>9.0f}\n", jobs, least.seconds,
               kFrames / least.seconds, one / least.seconds, least.processor, least.processor / least.seconds,
               least.mib);
  }
  const int processors = static_cast<int>(std::thread::hardware_concurrency());
  const double beside = bench::least_seconds(3, [&] {
    std::vector<std::thread> programs;
    for (int i = 0; i < processors; ++i) programs.emplace_back([&, i] { program(1, std::to_string(i)); });
    for (std::thread& t : programs) t.join();
  });
  fmt::print("{} programs of one job each beside each other: {:.2f} frames/s, {:.2f} times one\n", processors,
             processors * kFrames / beside, processors * one / beside);
  fs::remove_all(folder);
}

}  // namespace

int main() {
  constexpr int kWidth = 640;
  constexpr int kHeight = 480;
  constexpr double kPixels = double{kWidth} * kHeight;
  const Config config = load_config("default").config;
  const auto model = cosim::find_model(config);
  const bench::Timer timer;
  const auto scene = std::make_shared<const Scene>(Scene::load("courtyard"));
  const int frames = scene->frame_count();
  fmt::print("courtyard, {}x{}, {} frames, configuration default ({} lanes), one thread; least of 5 runs, RTL of 3\n",
             kWidth, kHeight, frames, config.lanes);
  fmt::print("scene loaded and model opened in {:.3f} s\n", timer.seconds());
  fmt::print("{:>5} {:>8} {:>11} {:>12} {:>12} {:>14} {:>12} {:>11} {:>10} {:>12} {:>9}\n", "frame", "spans",
             "span pixels", "geometry ms", "front end ms", "golden ns/pixel", "golden ms", "RTL clocks", "RTL ms",
             "clocks/pixel", "RTL/golden");
  double geometry_sum = 0;
  double front_sum = 0;
  double golden_sum = 0;
  double rtl_sum = 0;
  const auto golden = cosim::make_golden(config);
  const auto rtl = cosim::make_rtl(model.library, config);
  for (int i = 0; i < frames; ++i) {
    FrameGeometry g;
    const SceneFrame frame = scene->frame(i, frames);
    const double geometry = bench::least_seconds(5, [&] { g = make_geometry(frame, config, kWidth, kHeight); });
    std::vector<std::uint32_t> words;
    const double front = bench::least_seconds(5, [&] {
      words.clear();
      make_frame(g, config, static_cast<std::uint32_t>(i), words, {.threads = 1});
    });
    const TokenCounts counts = check_frame(config, words, "bench", 0);
    std::uint64_t sum = 0;  // somebody reads the pixels
    const LineSink sink = [&sum](int, std::span<const std::uint8_t> pixels) { sum += pixels.back(); };
    const double golden_time = bench::least_seconds(5, [&] { (void)golden->frame(words, sink); });
    std::uint64_t cycles = 0;
    const double rtl_time = bench::least_seconds(3, [&] { cycles = rtl->frame(words, sink).cycles; });
    fmt::print("{:>5} {:>8} {:>11} {:>12.2f} {:>12.2f} {:>15.2f} {:>12.2f} {:>11} {:>10.1f} {:>12.3f} {:>9.1f}\n", i,
               counts.spans, counts.span_pixels, geometry * 1e3, front * 1e3, golden_time * 1e9 / kPixels,
               golden_time * 1e3, cycles, rtl_time * 1e3, static_cast<double>(cycles) / kPixels,
               rtl_time / golden_time);
    geometry_sum += geometry;
    front_sum += front;
    golden_sum += golden_time;
    rtl_sum += rtl_time;
  }
  compare_cost(scene, config, model.library);
  const double n = frames;
  fmt::print(
      "golden: {:.2f} ns per pixel of the frame; RTL / golden: {:.1f}; co-simulation on one thread, pictures not "
      "counted: {:.2f} frames/s\n",
      golden_sum / n * 1e9 / kPixels, rtl_sum / golden_sum, n / (geometry_sum + front_sum + golden_sum + rtl_sum));
  jobs_cost();
  return 0;
}
