// SPDX-License-Identifier: Apache-2.0
#include "explore/sweep_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "contract/kinds.hpp"
#include "cosim/model/model.hpp"
#include "cosim/model/rtl.hpp"
#include "cosim/model/sha256.hpp"
#include "cosim/run.hpp"
#include "cost/cells.hpp"
#include "cost/processors.hpp"
#include "cost/token_clocks.hpp"
#include "explore/sweep_accuracy.hpp"
#include "file/read_file.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "pipeline/stopwatch.hpp"
#include "plan/widths.hpp"
#include "stream/token_pieces.hpp"

namespace kage::explore {
namespace {

using Json = nlohmann::ordered_json;

// The golden core draws all frames so many times at least, and for so long, and the least time counts.
constexpr int kGoldenRuns = 3;
constexpr double kGoldenSeconds = 0.1;

// Points that are co-simulated besides those that stand for others.
constexpr std::size_t kChecks = 3;

double golden_seconds(const Config& config, const PointWords& words) {
  GoldenCore core(config);
  const LineSink nobody = [](int, std::span<const std::uint8_t>) {};
  double least = std::numeric_limits<double>::infinity();
  double all = 0;
  for (int run = 0; run < kGoldenRuns || all < kGoldenSeconds; ++run) {
    double seconds = 0;
    {
      const Stopwatch watch(seconds);
      for (const auto& frame : words.frames) {
        core.feed(frame, nobody);
        core.finish(nobody);
      }
    }
    least = std::min(least, seconds);
    all += seconds;
  }
  return least;
}

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

double mean(double sum, std::uint64_t of) { return of == 0 ? 0 : sum / static_cast<double>(of); }

double wrong_share(const Json& row) {
  const Json& a = row.at("accuracy");
  return (a.at("visible_wrong").get<double>() + a.at("shadow_wrong").get<double>()) / a.at("pixels").get<double>();
}

}  // namespace

Json light_json(const LightErrors& e) {
  return {{"pixels", e.pixels},
          {"shadowed", e.shadowed},
          {"shadow_mean", mean(e.shadow_sum, 3 * e.shadowed)},
          {"shadow_worst", e.shadow_worst},
          {"lit_mean", mean(e.lit_sum, 3 * (e.pixels - e.shadowed))},
          {"lit_worst", e.lit_worst},
          {"psnr", optional_json(psnr(e.squares, e.pixels))}};
}

Json error_json(const PictureError& e) {
  const auto pixels = static_cast<double>(e.pixels);
  return {{"visible_wrong", e.visible_wrong},
          {"shadow_wrong", e.shadow_wrong},
          {"color_wrong", e.color_wrong},
          {"shadow_share", e.shadow / pixels},
          {"mean_square", e.squares / (3 * pixels)},
          {"psnr", optional_json(psnr(e.squares, e.pixels))}};
}

bool is_built(const Config& c) { return c.arrangement != 0 || c.max_width <= kMostProcessors; }

/// Pixels along which depth goes on by steps, at most. They are of spans before the front end cuts them to what is
/// seen, for the rest goes on with the steps of the whole.
int longest_depth(SweepScene& scene, const SweepPoint& point) {
  int longest = 0;
  TokenPieces tokens(point.config);
  DrawOptions draw = scene.draw_options(point);
  draw.all_spans = true;
  SceneFrames frames(scene.scene(), point.config, draw);
  for (int i = 0; i < scene.frames(); ++i) {
    tokens.start();
    FrameParts parts;
    const auto take = [&](std::span<const std::uint32_t> piece) {
      tokens.feed(piece, [&](const Token& t) {
        if (t.kind == Kind::SEG) longest = std::max(longest, t.segment.dx);
        if (info_of(t.kind).depth) longest = std::max(longest, t.span.xr - t.span.xl);
      });
    };
    frames.frame(i, take, parts);
    longest = std::max(longest, plan::longest_diced(parts.geometry));
  }
  return longest;
}

PointWords words_of(SweepScene& scene, const SweepPoint& point) {
  PointWords out;
  out.longest_depth = longest_depth(scene, point);
  PhaseCounter counter(point.config);
  TokenPieces tokens(point.config);
  SceneFrames frames(scene.scene(), point.config, scene.draw_options(point));
  cosim::Sha256 hash;
  for (int i = 0; i < scene.frames(); ++i) {
    auto& words = out.frames.emplace_back();
    counter.start(point.width);
    tokens.start();
    FrameParts parts;
    const auto take = [&](std::span<const std::uint32_t> piece) {
      words.insert(words.end(), piece.begin(), piece.end());
      tokens.feed(piece, [&](const Token& t) { counter.token(t); });
    };
    frames.frame(i, take);
    out.words += words.size();
    out.foretold = std::accumulate(counter.lines().begin(), counter.lines().end(), out.foretold);
    hash.add(static_cast<std::uint64_t>(words.size()));
    hash.add_piece(std::span<const std::uint32_t>(words));
  }
  out.hash = hash.take();
  return out;
}

SweepRunner::SweepRunner(SweepScene& scene, std::vector<SweepPoint> points, SweepHow how)
    : scene_(&scene), points_(std::move(points)), how_(std::move(how)), checked_(points_.size(), false) {
  std::map<std::string, std::size_t> first;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::string features = features_text(points_[i].config) + (is_built(points_[i].config) ? "" : " unbuilt");
    const std::size_t stands = first.emplace(features, i).first->second;
    stands_for_.push_back(stands);
    if (is_built(points_[i].config) && !(points_[i].config == points_[stands].config)) others.push_back(i);
  }
  for (std::size_t k = 0; k < std::min(kChecks, others.size()); ++k)
    checked_[others[(2 * k + 1) * others.size() / (2 * std::min(kChecks, others.size()))]] = true;
}

PointWords SweepRunner::words(std::size_t index) {
  const std::shared_lock busy(alone_);
  return words_of(*scene_, points_[index]);
}

std::string SweepRunner::clocks_text(std::size_t index) const {
  if (!how_.cosim || !is_built(points_[index].config)) return "design";
  return fmt::format("{}{}", text_of(points_[stands_for_[index]]), checked_[index] ? ", checked" : "");
}

std::string SweepRunner::tools_text(std::size_t index) const {
  if (!is_built(points_[index].config)) return {};
  std::string text;
  if (how_.area) text += how_.tools.yosys + "\n";
  if (how_.cosim) text += how_.tools.model + "\n";
  if (how_.placer != nullptr) text += how_.placer->device() + "\n" + how_.placer->versions();
  return text;
}

void SweepRunner::know_clocks(std::size_t point, const ClockSample& sample) {
  clocks_.get(std::to_string(point), [&] { return sample; });
}

bool SweepRunner::needs_core(std::size_t index) const {
  return is_built(points_[index].config) && (how_.cosim || how_.area || how_.placer != nullptr);
}

void SweepRunner::prepare(std::size_t index) {
  const SweepPoint& point = points_[index];
  if (!needs_core(index)) return;
  if (how_.cosim) {
    const std::size_t stands = stands_for_[index];
    if (!clocks_.has(std::to_string(stands))) model_of(points_[stands]);
    if (checked_[index] && stands != index) model_of(point);
  }
  if (how_.area) cells_of(point);
  placement(point);
}

cosim::Model SweepRunner::model_of(const SweepPoint& point) {
  const std::lock_guard lock(build_mutex_);
  const std::shared_lock busy(alone_);
  return cosim::find_model(
      point.config, {.progress = [&](double seconds) {
        how_.wait();
        how_.doing(fmt::format("building the RTL model of {} {}: {:.0f} s", point.axis, point.value, seconds));
      }});
}

CellCount SweepRunner::cells_of(const SweepPoint& point) {
  return *counts_.get(to_yaml(point.config), [&] {
    const std::shared_lock busy(alone_);
    how_.doing(fmt::format("yosys counts the cells of {} {}", point.axis, point.value));
    return synthesize(point.config, how_.wait).cells;
  });
}

ClockSample SweepRunner::simulate(const SweepPoint& point, const PointWords& words) {
  const cosim::Model model = model_of(point);
  const std::unique_lock alone(alone_);
  const auto golden = cosim::make_golden(point.config);
  const auto rtl = cosim::make_rtl(model.library, point.config);
  const cosim::Feed feed = [&](int index, const WordSink& sink) {
    const auto& frame = words.frames[static_cast<std::size_t>(index)];
    sink(frame);
    return count_tokens(point.config, frame);
  };
  cosim::RunOptions options;
  options.wait = how_.wait;
  const cosim::Report report = cosim::run(static_cast<int>(words.frames.size()), feed, *golden, *rtl, options);
  if (!report.same)
    throw Error(fmt::format("{}: the RTL of {} {} differs from the golden core in frame {}: kage cosim finds out why",
                            scene_->name(), point.axis, point.value, report.frames));
  return {.cycles = report.cycles, .foretold = words.foretold, .seconds = report.actual_seconds};
}

ClockSample SweepRunner::clocks_of(std::size_t index, const PointWords* given) {
  return *clocks_.get(std::to_string(index), [&] {
    const SweepPoint& point = points_[index];
    const ClockSample sample = given != nullptr ? simulate(point, *given) : simulate(point, words(index));
    if (keep_clocks) keep_clocks(index, sample);
    return sample;
  });
}

Json SweepRunner::accuracy(const SweepPoint& point, const PointWords& words) {
  PointAccuracy sum;
  std::map<ErrorSource, PictureError> sources;
  for (int i = 0; i < scene_->frames(); ++i) {
    how_.wait();
    const DrawnFrame drawn = draw(scene_->frame(i), point.config, scene_->draw_options(point));
    sum += accuracy_of(*scene_, i, point, drawn, how_.flip);
    for (const ErrorSource s : kErrorSources) sources[s] += *scene_->error_of(i, point, s);
  }
  Json j;
  j["pixels"] = sum.by_truth.pixels;
  j["visible_wrong"] = sum.by_truth.visible_wrong;
  j["shadow_wrong"] = sum.by_truth.shadow_wrong;
  j["gross_wrong"] = sum.by_truth.gross_wrong;
  j["color_wrong"] = sum.by_truth.color_wrong;
  j["z_error_max_lsb"] = sum.z_error_max_lsb;
  j["z_error_bound_lsb"] = plan::depth_error(words.longest_depth, point.config.z_frac, point.width, point.height);
  j["psnr"] = optional_json(psnr(sum.all.squares, sum.all.pixels));
  j["flip"] = how_.flip ? Json(sum.flip / scene_->frames()) : Json(nullptr);
  j["rays"] = sum.ray_pixels == 0 ? Json(nullptr)
                                  : Json{{"pixels", sum.ray_pixels},
                                         {"visible_wrong", sum.ray_visible_wrong},
                                         {"shadow_pixels", sum.ray_shadow_pixels},
                                         {"shadow_wrong", sum.ray_shadow_wrong},
                                         {"shadow_share", mean(sum.ray_shadow_share, sum.ray_shadow_pixels)},
                                         {"layer_pixels", sum.ray_layer_pixels},
                                         {"layers_wrong", sum.ray_layers_wrong}};
  j["light"] = sum.light.pixels == 0 ? Json(nullptr)
                                     : Json{{"drawn", light_json(sum.light)}, {"finest", light_json(sum.finest_light)}};
  const std::optional<SoftShare> soft = soft_share(scene_->frame(0), point);
  j["steps"] = {{"seen", sum.steps.seen}, {"most", sum.steps.most}};
  j["soft_share"] = soft ? Json{{"rms", soft->rms}, {"worst", soft->worst}} : Json(nullptr);
  Json split;
  for (const ErrorSource s : kErrorSources) split[std::string(name_of(s))] = error_json(sources[s]);
  split["all"] = error_json(sum.all);
  j["sources"] = split;
  return j;
}

Json SweepRunner::speed(std::size_t index, const PointWords& words) {
  const SweepPoint& point = points_[index];
  const auto frames = static_cast<double>(words.frames.size());
  const double pixels = frames * point.width * point.height;
  std::optional<ClockSample> own;
  double cycles = static_cast<double>(words.foretold);
  std::optional<double> fps;
  std::string from = "design";
  if (how_.cosim && is_built(point.config)) {
    const std::size_t stands = stands_for_[index];
    const ClockSample of = clocks_of(stands, stands == index ? &words : nullptr);
    if (stands == index || checked_[index]) own = stands == index ? of : clocks_of(index, &words);
    cycles *= static_cast<double>(of.cycles) / static_cast<double>(of.foretold);
    from = "phases";
    if (of.seconds > 0) fps = frames * static_cast<double>(of.cycles) / (of.seconds * cycles);
  }
  Json j;
  {
    const std::unique_lock alone(alone_);
    j["golden_ns_per_pixel"] = 1e9 * golden_seconds(point.config, words) / pixels;
  }
  j["rtl_cycles_per_pixel"] = (own ? static_cast<double>(own->cycles) : cycles) / pixels;
  j["rtl_cycles_from"] = own ? "cosim" : from;
  j["phases_cycles_per_pixel"] = own && stands_for_[index] != index ? Json(cycles / pixels) : Json(nullptr);
  j["design_cycles_per_pixel"] = static_cast<double>(words.foretold) / pixels;
  j["cosim_frames_per_second"] = own && own->seconds > 0 ? Json(frames / own->seconds) : optional_json(fps);
  j["words_per_frame"] = static_cast<double>(words.words) / frames;
  return j;
}

Json SweepRunner::area(const SweepPoint& point) {
  const Cells cells = estimated_cells(point.config);
  Json j;
  if (how_.area && is_built(point.config)) {
    const CellCount counted = cells_of(point);
    j = {{"luts", counted.luts},
         {"ffs", counted.flip_flops},
         {"brams", counted.rams},
         {"dsps", counted.dsps},
         {"counted", true}};
  } else {
    j = {{"luts", cells.luts}, {"ffs", cells.flip_flops}, {"brams", nullptr}, {"dsps", nullptr}, {"counted", false}};
  }
  j["bits_per_pixel"] = cells.bits_per_pixel;
  j["ram_bits"] = cells.ram_bits;
  const Placement placed = placement(point);
  j["placed_on"] = how_.placer != nullptr ? Json(how_.placer->device()) : Json(nullptr);
  j["fmax_mhz"] = optional_json(placed.mhz);
  j["not_placed"] = placed.not_placed.empty() ? Json(nullptr) : Json(placed.not_placed);
  return j;
}

Placement SweepRunner::placement(const SweepPoint& point) {
  if (how_.placer == nullptr) return {};
  if (!is_built(point.config))
    return {.mhz = {},
            .not_placed = fmt::format("it has a processor for each of more than {} columns", kMostProcessors)};
  return *placements_.get(to_yaml(point.config), [&] {
    const std::shared_lock busy(alone_);
    return how_.placer->place(point.config, [&](const std::string& how_far) {
      how_.doing(fmt::format("placing {} {} on {}: {}", point.axis, point.value, how_.placer->device(), how_far));
    });
  });
}

Json SweepRunner::run(std::size_t index, const PointWords& words) {
  const SweepPoint& point = points_[index];
  Json j;
  {
    const std::shared_lock busy(alone_);
    j["accuracy"] = accuracy(point, words);
  }
  j["speed"] = speed(index, words);
  j["area"] = area(point);
  const Json& mhz = j["area"]["fmax_mhz"];
  const double cycles = j["speed"]["rtl_cycles_per_pixel"].get<double>() * point.width * point.height;
  j["speed"]["frames_per_second"] = mhz.is_null() ? Json(nullptr) : Json(1e6 * mhz.get<double>() / cycles);
  return j;
}

std::string key_of(const std::vector<std::string>& parts) {
  cosim::Sha256 hash;
  for (const std::string& part : parts) hash.add(part);
  return hash.take();
}

std::string build_identity(const std::string& name) {
  const bool whole = name.find('(') != std::string::npos && name.find("changed") == std::string::npos;
  return whole ? name : name + " " + key_of({read_file("/proc/self/exe")});
}

std::string group_of(const Json& row) {
  const Json& look = row.at("look");
  return fmt::format("{} at {}x{}", row.at("scene").get<std::string>(), look.at("width").get<int>(),
                     look.at("height").get<int>());
}

// Figures are compared in steps of 1 %: an estimate of cells, or a clock for a thousand pixels, tells no more. Steps,
// unlike a tolerance, leave some row of any that beat each other in a ring.
static double in_steps(double figure) { return figure > 0 ? std::floor(std::log(figure) / std::log(1.01)) : -INFINITY; }

std::vector<bool> pareto(const std::vector<Json>& rows) {
  std::vector<std::array<double, 4>> costs;
  std::vector<std::string> groups;
  for (const Json& row : rows) {
    costs.push_back({in_steps(wrong_share(row)),
                     in_steps(row.at("accuracy").at("sources").at("all").at("mean_square").get<double>()),
                     in_steps(row.at("speed").at("rtl_cycles_per_pixel").get<double>()),
                     in_steps(row.at("area").at("luts").get<double>())});
    groups.push_back(group_of(row));
  }
  std::vector<bool> out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    bool beaten = false;
    for (std::size_t k = 0; k < rows.size() && !beaten; ++k) {
      if (groups[k] != groups[i]) continue;
      bool as_good = true;
      bool better = false;
      for (std::size_t c = 0; c < costs[i].size(); ++c) {
        as_good = as_good && costs[k][c] <= costs[i][c];
        better = better || costs[k][c] < costs[i][c];
      }
      beaten = as_good && better;
    }
    out.push_back(!beaten);
  }
  return out;
}

}  // namespace kage::explore
