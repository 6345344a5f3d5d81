// SPDX-License-Identifier: Apache-2.0
#include "explore/error_maps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "cosim/session/order_build.hpp"
#include "explore/sweep_accuracy.hpp"
#include "explore/sweep_run.hpp"
#include "image/save.hpp"

namespace kage::explore {
namespace {

std::filesystem::path beside(const std::filesystem::path& picture, std::string_view what) {
  return picture.parent_path() / fmt::format("{}_error{}.png", picture.stem().string(), what);
}

/// The total that a number of shadowed samples is part of, if a light is soft.
std::string samples_text(const std::vector<int>& samples) {
  const int most = samples.empty() ? 1 : *std::max_element(samples.begin(), samples.end());
  return most > 1 ? fmt::format(" (of {} samples a light)", most) : "";
}

}  // namespace

ErrorMaps::ErrorMaps(const cosim::SourceOptions& options, const cosim::Source& source, cosim::Host& host)
    : host_(host) {
  DrawOptions draw = cosim::draw_options(options);
  draw.frames = source.frames();
  draw.name = source.name();
  draw.order = cosim::order_build(options, host);
  point_.config = source.config();
  point_.width = draw.width;
  point_.height = draw.height;
  point_.look = draw.look;
  point_.look.fit = true;
  scene_ = std::make_unique<SweepScene>(source.scene(), draw, point_, [&host] { host.check(); });
}

void ErrorMaps::frame(int index, const std::filesystem::path& picture, TempFiles& files) {
  const DrawnFrame drawn = draw(scene_->frame(index), point_.config, scene_->draw_options(point_));
  const ErrorMap map = error_map(*scene_, index, point_, drawn);
  const PictureError all = sum_of(map);
  const std::filesystem::path path = beside(picture, "");
  save_image(files, path, picture_of(map, drawn));
  report::Json sources;
  std::vector<std::string> told;
  for (const ErrorSource source : kErrorSources) {
    host_.check();
    const std::string name(name_of(source));
    const ErrorMap of_source = scene_->map_of(index, point_, source);
    const PictureError sum = sum_of(of_source);
    const std::filesystem::path own = beside(picture, "_" + name);
    sources[name] = error_json(sum);
    sources[name]["file"] = nullptr;
    if (sum.any()) {
      save_image(files, own, picture_of(of_source, drawn));
      sources[name]["file"] = own.string();
      told.push_back(fmt::format("{} {}/{}/{}", name, sum.visible_wrong, sum.shadow_wrong, sum.color_wrong));
    } else if (std::filesystem::exists(own)) {
      files.remove(own);
    }
  }
  const std::filesystem::path lit = beside(picture, "_light");
  LightErrors light;
  if (!point_.look.cull) {  // rays know nothing of it
    const auto truth = scene_->light(index, point_);
    light = light_errors(*truth, drawn);
    if (light.pixels > 0) save_image(files, lit, picture_of(light_map(*truth, drawn), drawn));
  }
  if (light.pixels == 0 && std::filesystem::exists(lit)) files.remove(lit);
  report::Json j;
  j["frame"] = index;
  j["pixels"] = all.pixels;
  j["visible_wrong"] = all.visible_wrong;
  j["shadow_wrong"] = all.shadow_wrong;
  j["gross_wrong"] = all.gross_wrong;
  j["color_wrong"] = all.color_wrong;
  j["file"] = path.string();
  j["sources"] = sources;
  j["light"] = nullptr;
  if (light.pixels > 0) {
    j["light"] = light_json(light);
    j["light"]["file"] = lit.string();
  }
  json_.push_back(j);
  text_ += fmt::format(
      "frame {}: wrong face {}, wrong shadow {}{}, other colour {}, gross (beyond any stated error) {}: {}\n", index,
      all.visible_wrong, all.shadow_wrong, samples_text(scene_->light_samples(index, point_)), all.color_wrong,
      all.gross_wrong, path.string());
  const std::string finest = samples_text(scene_->light_samples(index, scene_->finest(point_)));
  text_ += told.empty() ? "  no source has an error of its own\n"
                        : fmt::format("  each source alone against finest pictures{}, face/shadow/colour: {}: {}\n",
                                      finest, fmt::join(told, ", "), beside(picture, "_SOURCE").string());
  if (light.pixels > 0) {
    const auto figure = [&](const char* name) { return j["light"][name].get<double>(); };
    text_ += fmt::format(
        "  light at the pixel, of {} pixels {} in some shadow, is off by {:.2f} steps of 255 there and {:.2f} "
        "elsewhere, "
        "{} dB: {}\n",
        light.pixels, light.shadowed, figure("shadow_mean"), figure("lit_mean"),
        j["light"]["psnr"].is_null() ? "no error in" : fmt::format("{:.1f}", figure("psnr")), lit.string());
  }
  scene_->forget(index);
}

}  // namespace kage::explore
