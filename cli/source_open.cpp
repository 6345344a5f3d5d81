// SPDX-License-Identifier: Apache-2.0
//
// How a source is opened: what its options may say, and which configuration it gets.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "kage/error.hpp"
#include "kage/geometry.hpp"
#include "mapped.hpp"
#include "options.hpp"
#include "order_build.hpp"
#include "planned.hpp"
#include "progress.hpp"
#include "signals.hpp"
#include "source.hpp"
#include "vectors/pack.hpp"

namespace kage::cli {
namespace {

// Random frames of a run that does not say how many.
constexpr int kRandomFrames = 200;

}  // namespace

std::string plain_name(const std::filesystem::path& path) {
  std::string name = path.stem().string();
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '_';
  return name;
}

void refuse_order_tree(const std::string& path) {
  if (is_order_file(path)) throw Error(fmt::format("{}: a visibility order's tree; kage order takes it", path));
}

void refuse_pack(const std::string& input) {
  const std::filesystem::path folder(input);
  std::error_code e;
  if (std::filesystem::is_directory(folder, e) && std::filesystem::exists(folder / vectors::kManifest, e))
    throw Error(fmt::format(
        "{}: a folder of kage vectors is no scene: kage board plays it, kage vectors --check reads it", input));
}

void refuse_repeated(const std::vector<std::string>& inputs) {
  for (auto it = inputs.begin(); it != inputs.end(); ++it)
    if (std::find(inputs.begin(), it, *it) != it) throw Error(fmt::format("{}: given twice", *it));
}

void refuse_random(const std::string& input) {
  if (verif::random_manner(input))
    throw Error(fmt::format("{}: random frames are for kage cosim, kage explain and kage vectors", input));
}

Scene load_scene(const std::string& input, const Options& options) { return load_scene(input, options, options.alpha); }

Scene load_scene(const std::string& input, const Options& options, double alpha) {
  Scene scene = Scene::load(input, {alpha, options.allow_outside, check_interrupt});
  reads_files(scene.files());
  return scene;
}

DrawOptions draw_options(const Options& options) {
  DrawOptions draw;
  draw.width = options.size.width;
  draw.height = options.size.height;
  draw.frames = options.frames;
  draw.look.translucent = options.order;
  draw.look.samples = options.samples;
  draw.look.seed = options.seed;
  draw.look.classes = options.classes;
  draw.look.sub_bits = options.sub_bits;
  draw.look.cull = options.cull;
  draw.look.fit = options.degrade;
  draw.threads = options.threads;
  draw.level = options.level;
  return draw;
}

Source::Source(const Options& options) : options_(options) {
  if (const auto manner = verif::random_manner(options.input)) {
    open_random(options, *manner);
    return;
  }
  refuse_order_tree(options.input);
  refuse_pack(options.input);
  if (is_stream_file(options.input))
    open_stream(options);
  else
    open_scene(options);
}

void Source::open_random(const Options& options, verif::Manner manner) {
  const Options usual;
  const auto refuse = [&](bool given, const char* option, const char* why) {
    if (given) throw Error(fmt::format("{}: {}: random frames {}", options.input, option, why));
  };
  refuse(options.size_given, "--size", "have sizes of their own");
  refuse(options.degrade, "--degrade", "need nothing that a configuration could lack");
  refuse(options.units_only, "--units-only", "have no polyhedra that could go by spans");
  refuse(options.order != usual.order, "--order", "have translucent spans in an order of their own");
  refuse(options.max_fragments.has_value(), "--max-fragments", "have no faces to be put in order");
  refuse(options.samples != usual.samples, "--samples", "have light samples of their own");
  refuse(options.classes != usual.classes, "--classes", "have light tables of their own");
  refuse(options.sub_bits != usual.sub_bits, "--sub-bits", "have no positions to be rounded");
  refuse(options.cull, "--cull", "have no faces to be left out");
  refuse(options.alpha != usual.alpha, "--alpha", "have alphas of their own");
  refuse(options.allow_outside, "--allow-outside", "need no files");
  config_ = load_config(options.config.empty() ? "default" : options.config);
  if (options.config.empty()) notes_.push_back(fmt::format("configuration: {}", config_.name));
  add_front_end(options);
  name_ = options.input;
  std::replace(name_.begin(), name_.end(), ':', '_');
  frames_ = options.frames > 0 ? options.frames : kRandomFrames;
  random_.emplace(config_.config, manner, options.seed, options.level);
}

void Source::open_stream(const Options& options) {
  if (options.size_given) throw Error(fmt::format("{}: --size: a stream has its own size", options.input));
  if (options.units_only)
    throw Error(fmt::format("{}: --units-only: the stream file already says what goes to units", options.input));
  if (options.order != TranslucentWay::exact)
    throw Error(fmt::format("{}: --order: a stream has its own order", options.input));
  if (options.samples != Options{}.samples || options.classes != Options{}.classes)
    throw Error(fmt::format("{}: --samples, --classes: only a scene takes them, and this is a stream", options.input));
  if (options.sub_bits != Options{}.sub_bits)
    throw Error(fmt::format("{}: --sub-bits: only a scene takes it, and this is a stream", options.input));
  if (options.cull) throw Error(fmt::format("{}: --cull: only a scene takes it, and this is a stream", options.input));
  if (options.alpha != 1) throw Error(fmt::format("{}: --alpha: a stream has its own alphas", options.input));
  if (!options.level_option.empty())
    throw Error(fmt::format("{}: {}: a stream has its own level", options.input, options.level_option));
  if (options.max_fragments)
    throw Error(fmt::format("{}: --max-fragments: a stream has its fragments already", options.input));
  guard_mapped(options.input);
  stream_ = std::make_shared<const StreamFile>(options.input);
  stream_ways_ = ways_of(*stream_, options.input);
  open_frames();
  name_ = plain_name(options.input);
  frames_ = stream_->frame_count();
  if (options.frames > frames_)
    throw Error(fmt::format("{}: --frames {}: the stream has {}", options.input, options.frames, frames_));
  if (options.frames > 0) frames_ = options.frames;
  config_ = stream_config(options, *stream_);
}

NamedConfig stream_config(const Options& options, const StreamFile& stream) {
  if (options.config.empty()) return {"of the stream", stream.config()};
  NamedConfig config = load_config(options.config);
  for (const ParamInfo& p : kParams)
    if (p.affects_pixels && config.config.*(p.member) != stream.config().*(p.member))
      throw Error(fmt::format("{}: {}: {} is {}, the stream's is {}", options.input, config.name, p.name,
                              config.config.*(p.member), stream.config().*(p.member)));
  return config;
}

void Source::open_scene(const Options& options) {
  load_scene(options);
  add_front_end(options);
  open_frames();
  remarks_.emplace(config_.config, options.size, options.cull);
}

void Source::add_front_end(const Options& options) {
  if (give_front_end(options, config_.config))
    notes_.push_back(fmt::format("ACTIVE: {} polygons at once, since {} has no front end", kUsualActive, config_.name));
}

void Source::load_scene(const Options& options) {
  scene_ = std::make_shared<const Scene>(cli::load_scene(options.input, options));
  name_ = plain_name(scene_->name());
  frames_ = options.frames > 0 ? options.frames : scene_->frame_count();
  progress_ = std::make_unique<Progress>();
  if (options_.size.width > kMaxSize || options_.size.height > kMaxSize)
    throw Error(
        fmt::format("--size: {}x{}: at most {}x{}", options_.size.width, options_.size.height, kMaxSize, kMaxSize));
  const SceneFrame first = scene_->frame(0, frames_);
  notes_ = scene_notes(*scene_, first, options);
  Needs needs = needs_of(*scene_, first, options.size.width, options.size.height, options.samples);
  if (options.config.empty()) {
    try {
      DrawOptions draw = draw_options(options);
      draw.frames = frames_;
      config_ = choose_config(*scene_, draw);
    } catch (const Error& e) {
      const std::string line = widened_config(needs);
      throw Error(fmt::format("{}: {}{}", options.input, e.what(),
                              line.empty() ? "" : "; --config FILE can, with this line in it: " + line));
    }
    notes_.push_back(fmt::format("configuration: {}", config_.name));
    return;
  }
  if (options.config == kPlanned) {
    config_ = planned_config(options_, scene_);
    notes_.push_back(fmt::format("configuration: plan ({})", config_.config.arrangement == 0
                                                                 ? "systolic"
                                                                 : fmt::format("LANES {}", config_.config.lanes)));
    return;
  }
  config_ = load_config(options.config);
  std::vector<std::string> missing = lacks(config_.config, needs);
  if (!missing.empty() && options.degrade) {
    degraded_ = missing;
    needs.shadows = needs.smooth = needs.color = needs.translucency = false;
    needs.lights = needs.samples = 1;
    missing = lacks(config_.config, needs);
    std::erase_if(degraded_,
                  [&](const std::string& m) { return std::find(missing.begin(), missing.end(), m) != missing.end(); });
  }
  if (!missing.empty())
    throw Error(fmt::format("{}: configuration {} lacks {}{}", options.input, config_.name, fmt::join(missing, ", "),
                            needs.width > config_.config.max_width
                                ? fmt::format("; --size up to {} wide fits", config_.config.max_width)
                                : ""));
  if (!degraded_.empty()) notes_.push_back(fmt::format("drawn without {}", fmt::join(degraded_, ", ")));
}

// Each source has its own, which keep what does not change from frame to frame.
void Source::open_frames() {
  if (stream_) {
    stream_frames_ = std::make_unique<StreamFrames>(stream_);
    return;
  }
  DrawOptions draw = draw_options(options_);
  draw.frames = frames_;
  draw.order =
      progress_ ? order_build(options_, *progress_, name_ + ": order of translucent faces") : order_build(options_);
  draw.name = name_;
  scene_frames_ = std::make_unique<SceneFrames>(scene_, config_.config, std::move(draw));
}

}  // namespace kage::cli
