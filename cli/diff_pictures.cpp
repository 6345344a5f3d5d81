// SPDX-License-Identifier: Apache-2.0
// kage diff of two pictures, and the words for what came of it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "command.hpp"
#include "cosim/report/junit.hpp"
#include "diff.hpp"
#include "file/quiet_stderr.hpp"
#include "file/real_path.hpp"
#include "image/blink.hpp"
#include "image/save.hpp"
#include "kage/error.hpp"
#include "results.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

namespace fs = std::filesystem;

/// Whether `path` is `in` or, that being a folder, lies in it, by whatever name.
bool within(const std::string& path, const std::string& in) { return lies_in(real_path(path), real_path(in)); }

}  // namespace

void check_outputs(const DiffCommand& o) {
  std::vector<std::string> written;
  for (const std::string* path : {&o.out, &o.blink, &o.junit, &o.json}) {
    if (file_named(*path).empty()) continue;
    for (const std::string* read : {&o.a, &o.b, &o.mask})
      if (!read->empty() && within(*path, *read))
        throw Error(fmt::format("{}: this output would overwrite an input", *path));
    written.push_back(*path);
  }
  refuse_twice(written);
}

DiffResult compare_files(const fs::path& a, const fs::path& b, const DiffOptions& limits, DiffViews* views) {
  const QuietStderr quiet;  // libpng writes there by itself what OpenImageIO reports anyway
  return diff_files(a, b, limits, views);
}

std::string describe(const DiffResult& r) {
  if (r.width == 0) return fmt::format("different: {}", r.reason);
  const auto pixels = static_cast<std::uint64_t>(r.width) * static_cast<std::uint64_t>(r.height);
  std::string text = fmt::format("{}: {}x{}, ", r.same ? "same" : "different", r.width, r.height);
  if (r.compared_pixels != pixels) text += fmt::format("{} of ", r.compared_pixels);
  text += counted(pixels, "pixel") + " compared";
  if (r.different_pixels != 0)
    text += fmt::format(", {} {}", r.different_pixels, r.different_pixels == 1 ? "differs" : "differ");
  if (r.different_pixels == 0 && (r.max_lsb.value_or(0) != 0 || r.max_ulp.value_or(0) != 0))
    text += ", all within the threshold";
  if (r.same && r.different_pixels != 0) text += ", no more than allowed";
  if (r.max_lsb.value_or(0) != 0) text += fmt::format(", by up to {} LSB", *r.max_lsb);
  if (r.max_ulp.value_or(0) != 0)
    text +=
        *r.max_abs == 0 ? ", only in the sign of 0" : fmt::format(", by up to {}, or {} ULP", *r.max_abs, *r.max_ulp);
  if (r.nan_pixels != 0) text += fmt::format(", {} {} a NaN", r.nan_pixels, r.nan_pixels == 1 ? "holds" : "hold");
  if (r.first) text += fmt::format(", the first at x {}, y {}, channel {}", r.first->x, r.first->y, r.first->channel);
  return text;
}

std::string details(const DiffResult& r) {
  std::string text;
  constexpr std::size_t kShown = 4;
  for (std::size_t i = 0; i < std::min(r.regions.size(), kShown); ++i) {
    const DiffResult::Region& region = r.regions[i];
    text += fmt::format("{}{}x{}+{}+{} ({})", i == 0 ? "regions: " : ", ", region.box.width, region.box.height,
                        region.box.x, region.box.y, counted(region.pixels, "pixel"));
  }
  if (r.region_count > kShown) text += fmt::format(", and {} more", r.region_count - kShown);
  if (!r.regions.empty()) text += '\n';
  std::vector<std::string> measures;
  if (r.psnr) measures.push_back(fmt::format("PSNR {:.2f} dB", *r.psnr));
  if (r.flip) measures.push_back(fmt::format("FLIP mean {:.4f}, at most {:.4f}", r.flip->mean, r.flip->most));
  if (r.perceptual_pixels)
    measures.push_back(fmt::format("{} told apart by the perceptual measure", counted(*r.perceptual_pixels, "pixel")));
  if (!measures.empty()) text += fmt::format("for diagnosis: {}\n", fmt::join(measures, ", "));
  return text;
}

Json to_json(const DiffResult& r) {
  const bool compared = r.width != 0;
  const auto number = [&](auto value) { return compared ? Json(value) : Json(nullptr); };
  const auto maybe = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
  Json j;
  j["same"] = r.same;
  j["width"] = number(r.width);
  j["height"] = number(r.height);
  j["channels"] = number(r.channels);
  j["compared_pixels"] = number(r.compared_pixels);
  j["different_pixels"] = number(r.different_pixels);
  j["nan_pixels"] = number(r.nan_pixels);
  j["max_lsb"] = maybe(r.max_lsb);
  j["max_abs"] = r.max_abs && !std::isfinite(*r.max_abs) ? Json("infinite") : maybe(r.max_abs);
  j["max_ulp"] = maybe(r.max_ulp);
  j["first"] = r.first ? Json{{"x", r.first->x}, {"y", r.first->y}, {"channel", r.first->channel}} : Json(nullptr);
  j["regions"] = Json::array();
  for (const DiffResult::Region& region : r.regions)
    j["regions"].push_back(Json{{"x", region.box.x},
                                {"y", region.box.y},
                                {"width", region.box.width},
                                {"height", region.box.height},
                                {"pixels", region.pixels}});
  j["region_count"] = number(r.region_count);
  j["psnr"] = maybe(r.psnr);
  j["perceptual"] = maybe(r.perceptual_pixels);
  j["flip"] = r.flip ? Json{{"mean", r.flip->mean}, {"max", r.flip->most}} : Json(nullptr);
  j["reason"] = r.reason.empty() ? Json(nullptr) : Json(r.reason);
  return j;
}

int diff_two_pictures(const DiffCommand& o) {
  TempFiles files;
  report::JUnitWriter junit(files, o.junit, "kage diff");
  DiffOptions limits = o.limits;
  DiffViews views;
  const Stopwatch watch;
  const DiffResult result = [&] {
    const QuietStderr quiet;
    if (!o.mask.empty()) limits.mask = load_mask(o.mask, limits.max_bytes);
    return diff_files(o.a, o.b, limits, o.out.empty() && o.blink.empty() ? nullptr : &views);
  }();
  const std::string line = describe(result);
  const std::string name = fmt::format("{} {}", o.a, o.b);
  if (result.same)
    junit.pass(name, watch.seconds());
  else
    junit.fail(name, watch.seconds(), line, details(result));
  junit.close();
  const bool heat = !o.out.empty() && views.heat.width != 0;
  if (heat) save_image(files, o.out, views.heat);
  if (!o.blink.empty()) save_blink(files, o.blink, views.a, views.b);
  std::string text = line + "\n" + details(result);
  if (heat) text += fmt::format("heat map: {}\n", o.out);
  if (!o.out.empty() && !heat) text += "no heat map: the pictures are unlike\n";
  if (!o.blink.empty()) text += fmt::format("blink picture: {}\n", o.blink);
  finish(o.json, {"kage.diff-pictures/1", to_json(result)}, files, text);
  return result.same ? kSame : kDifferent;
}

}  // namespace kage::cli
