// SPDX-License-Identifier: Apache-2.0
#include "cosim/run.hpp"

#include <fmt/format.h>

#include <future>

#include "image/save.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

class Pictures {
 public:
  Pictures(const RunOptions& options, Report& report) : options_(options), report_(report) {}

  void save(int frame, const char* suffix, const Image& image) {
    if (options_.out.empty() || image.data.empty()) return;
    const auto path = options_.out / fmt::format("{}_{:04}{}.png", options_.name, frame, suffix);
    save_image(files_, path, image);
    report_.pictures.push_back(path.string());
  }

  void commit() { files_.commit(); }

 private:
  const RunOptions& options_;
  Report& report_;
  TempFiles files_;
};

}  // namespace

Report run(int frames, const Feed& feed, Core& expected, Core& actual, const RunOptions& options) {
  Report report;
  Pictures pictures(options, report);
  std::vector<std::uint32_t> words;
  std::vector<std::uint32_t> next;
  const auto fetch = [&](int index, std::vector<std::uint32_t>& to) {
    const auto from = feed(index);
    to.assign(from.begin(), from.end());
  };
  for (int i = 0; i < frames; ++i) {
    if (options.begin) options.begin(i);
    if (i == 0) fetch(0, words);
    auto other = std::async(options.two_threads ? std::launch::async : std::launch::deferred,
                            [&] { return actual.frame(words); });
    const FrameResult e = expected.frame(words);
    pictures.save(i, "", e.image);
    if (i + 1 < frames) fetch(i + 1, next);
    const FrameResult a = other.get();

    ++report.frames;
    report.width = e.image.width;
    report.height = e.image.height;
    report.pixels_compared += static_cast<std::uint64_t>(e.image.width) * static_cast<std::uint64_t>(e.image.height);
    report.cycles += a.cycles;
    report.starved += a.starved;
    report.blocked += a.blocked;
    report.expected_seconds += e.seconds;
    report.actual_seconds += a.seconds;
    report.first_difference = first_difference(i, e, a);
    if (report.first_difference) {
      report.same = false;
      pictures.save(i, "_expected", e.image);
      pictures.save(i, "_actual", a.image);
      if (!e.image.data.empty()) pictures.save(i, "_difference", difference_picture(e.image, a.image));
      pictures.commit();
      return report;
    }
    // Both refuse the header alike, so there is nothing that could have been compared: no verdict, and never "same".
    if (e.image.data.empty()) throw Error(fmt::format("frame {}: the cores refuse it: {}", i, describe(e.status)));
    words.swap(next);
  }
  if (report.frames == 0) throw Error("no frame to compare");
  pictures.commit();
  return report;
}

}  // namespace kage::cosim
