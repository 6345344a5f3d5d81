// SPDX-License-Identifier: Apache-2.0
// kage diff A B: compares two pictures.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>

#include "common.hpp"
#include "image/save.hpp"
#include "kage/image.hpp"

namespace kage::cli {
namespace {

struct DiffCommand : Options {
  std::string a;
  std::string b;
  DiffOptions limits;
};

std::string describe(const DiffResult& r) {
  const auto pixels = static_cast<std::uint64_t>(r.width) * static_cast<std::uint64_t>(r.height);
  if (r.width == 0) return fmt::format("different: {}", r.reason);
  std::string text =
      fmt::format("{}: {}x{}, {} compared", r.same ? "same" : "different", r.width, r.height, counted(pixels, "pixel"));
  if (r.different_pixels != 0) text += fmt::format(", {} differ", r.different_pixels);
  if (r.max_lsb != 0) text += fmt::format(", by up to {} LSB", r.max_lsb);
  if (r.nan_pixels != 0) text += fmt::format(", {} hold a NaN", r.nan_pixels);
  if (r.first) text += fmt::format(", the first at x {}, y {}, channel {}", r.first->x, r.first->y, r.first->channel);
  return text;
}

Json to_json(const DiffResult& r) {
  const bool compared = r.width != 0;
  const auto number = [&](auto value) { return compared ? Json(value) : Json(nullptr); };
  Json j;
  j["same"] = r.same;
  j["width"] = number(r.width);
  j["height"] = number(r.height);
  j["channels"] = number(r.channels);
  j["different_pixels"] = number(r.different_pixels);
  j["nan_pixels"] = number(r.nan_pixels);
  j["max_lsb"] = number(r.max_lsb);
  j["first"] = r.first ? Json{{"x", r.first->x}, {"y", r.first->y}, {"channel", r.first->channel}} : Json(nullptr);
  j["reason"] = r.reason.empty() ? Json(nullptr) : Json(r.reason);
  return j;
}

/// Keeps standard error quiet while it lives: libpng writes there by itself what OpenImageIO reports anyway.
class QuietStderr {
 public:
  QuietStderr() : kept_(fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3)) {
    const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (kept_ >= 0 && null >= 0) dup2(null, STDERR_FILENO);
    if (null >= 0) close(null);
  }
  ~QuietStderr() {
    if (kept_ < 0) return;
    std::fflush(stderr);
    dup2(kept_, STDERR_FILENO);
    close(kept_);
  }
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  int kept_;
};

int run(const DiffCommand& o) {
  check_json(o);
  Image heat;
  const DiffResult result = [&] {
    const QuietStderr quiet;
    return diff_files(o.a, o.b, o.limits, o.out.empty() ? nullptr : &heat);
  }();
  TempFiles files;
  if (!o.out.empty() && heat.width != 0) save_image(files, o.out, heat);
  write_json(o, to_json(result), files);
  if (!json_only(o)) fmt::print("{}\n", describe(result));
  return result.same ? kSame : kDifferent;
}

}  // namespace

void add_diff(CLI::App& app, Action& action) {
  CLI::App* c = add_command(
      app, "diff", "Compare two pictures, exactly unless told otherwise",
      "  kage diff a.png b.png\n"
      "  kage diff a.exr b.exr --lsb 1 --max-percent 0.01 --out heat.png --json -\n"
      "An LSB is one step of the file's pixel type; for floats, of the representable numbers.\n"
      "A NaN on either side, or unlike size, channels or pixel type, is a difference that no option tolerates.");
  const auto o = std::make_shared<DiffCommand>();
  const CLI::Validator finite(
      [](const std::string& text) {
        return text.find_first_not_of("0123456789.eE+-") == std::string::npos ? std::string()
                                                                              : text + " is not a number";
      },
      "", "finite");
  c->add_option("A", o->a, "a picture: PNG, EXR or any other that OpenImageIO reads")->required();
  c->add_option("B", o->b, "another")->required();
  c->add_option("--lsb", o->limits.lsb, "a pixel is the same if no channel is further apart than N LSB, default 0")
      ->check(whole_number())
      ->type_name("N");
  c->add_option("--max-pixels", o->limits.max_pixels, "same if at most N pixels differ, default 0")
      ->check(whole_number())
      ->type_name("N");
  c->add_option("--max-percent", o->limits.max_percent, "same if at most P percent of the pixels differ")
      ->check(finite)
      ->check(CLI::Range(0.0, 100.0))
      ->type_name("P");
  c->add_option("--out", o->out, "write a picture of the differences: A dimmed, red where they differ")
      ->type_name("FILE");
  option_json(*c, *o);
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
