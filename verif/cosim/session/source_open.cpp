// SPDX-License-Identifier: Apache-2.0
//
// How a source is opened: what its options may say, and which configuration it gets.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cosim/session/option_names.hpp"
#include "cosim/session/order_build.hpp"
#include "cosim/session/planned.hpp"
#include "cosim/session/source.hpp"
#include "file/inputs.hpp"
#include "kage/error.hpp"
#include "kage/frontend.hpp"
#include "kage/geometry.hpp"

namespace kage::cosim {
namespace {

// Random frames of a run that does not say how many.
constexpr int kRandomFrames = 200;

/// The configuration that the options name or have, if they do.
std::optional<NamedConfig> asked_config(const SourceOptions& options) {
  if (options.parameters) {
    NamedConfig config{options.config.empty() ? "given" : options.config, *options.parameters};
    validate(config.config, config.name);
    return config;
  }
  if (options.config.empty()) return std::nullopt;
  return load_config(options.config);
}

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

Scene load_scene(const std::string& input, const SourceOptions& options, Host& host) {
  return load_scene(input, options, host, options.alpha);
}

Scene load_scene(const std::string& input, const SourceOptions& options, Host& host, double alpha) {
  Scene scene = Scene::load(input, {alpha, options.allow_outside, [&host] { host.check(); }});
  for (const std::string& file : scene.files()) keep_input(file);
  return scene;
}

DrawOptions draw_options(const SourceOptions& options) {
  DrawOptions draw;
  draw.width = options.size.width;
  draw.height = options.size.height;
  draw.frames = options.frames;
  draw.look.translucent = options.order;
  draw.look.samples = options.samples;
  draw.look.seed = options.seed;
  draw.look.classes = options.classes;
  draw.look.max_shading = options.max_shading;
  draw.look.sub_bits = options.sub_bits;
  draw.look.cull = options.cull;
  draw.look.fit = options.degrade;
  draw.threads = options.threads;
  draw.level = options.level;
  draw.all_spans = options.all_spans;
  return draw;
}

Source::Source(const SourceOptions& options, Host& host) : host_(host), options_(options) {
  keep_input(options.input);
  keep_input(options.config);
  if (const auto manner = verif::random_manner(options.input)) {
    open_random(options, *manner);
    return;
  }
  if (options.scene) {
    if (options_.input.empty()) options_.input = options.scene->name();
    open_scene(options_);
    return;
  }
  refuse_order_tree(options.input);
  if (is_stream_file(options.input))
    open_stream(options);
  else
    open_scene(options);
}

void Source::open_random(const SourceOptions& options, verif::Manner manner) {
  const SourceOptions usual;
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
  refuse(options.max_shading != usual.max_shading, "--max-shading", "have no faces to be cut");
  refuse(options.sub_bits != usual.sub_bits, "--sub-bits", "have no positions to be rounded");
  refuse(options.cull, "--cull", "have no faces to be left out");
  refuse(options.all_spans, "--all-spans", "have no spans left out");
  refuse(options.alpha != usual.alpha, "--alpha", "have alphas of their own");
  refuse(options.allow_outside, "--allow-outside", "need no files");
  const std::optional<NamedConfig> asked = asked_config(options);
  config_ = asked ? *asked : load_config("default");
  if (!asked) notes_.push_back(fmt::format("configuration: {}", config_.name));
  add_front_end(options);
  name_ = options.input;
  std::replace(name_.begin(), name_.end(), ':', '_');
  frames_ = options.frames > 0 ? options.frames : kRandomFrames;
  random_.emplace(config_.config, manner, options.seed, options.level);
}

void Source::open_stream(const SourceOptions& options) {
  if (options.size_given) throw Error(fmt::format("{}: --size: a stream has its own size", options.input));
  if (options.units_only)
    throw Error(fmt::format("{}: --units-only: the stream file already says what goes to units", options.input));
  if (options.order != TranslucentWay::exact)
    throw Error(fmt::format("{}: --order: a stream has its own order", options.input));
  if (options.samples != SourceOptions{}.samples || options.classes != SourceOptions{}.classes)
    throw Error(fmt::format("{}: --samples, --classes: only a scene takes them, and this is a stream", options.input));
  if (options.max_shading != SourceOptions{}.max_shading)
    throw Error(fmt::format("{}: --max-shading: only a scene takes it, and this is a stream", options.input));
  if (options.sub_bits != SourceOptions{}.sub_bits)
    throw Error(fmt::format("{}: --sub-bits: only a scene takes it, and this is a stream", options.input));
  if (options.cull) throw Error(fmt::format("{}: --cull: only a scene takes it, and this is a stream", options.input));
  if (options.all_spans)
    throw Error(fmt::format("{}: --all-spans: only a scene takes it, and this is a stream", options.input));
  if (options.alpha != 1) throw Error(fmt::format("{}: --alpha: a stream has its own alphas", options.input));
  if (!options.level_option.empty())
    throw Error(fmt::format("{}: {}: a stream has its own level", options.input, options.level_option));
  if (options.max_fragments)
    throw Error(fmt::format("{}: --max-fragments: a stream has its fragments already", options.input));
  host_.maps(options.input);
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

NamedConfig stream_config(const SourceOptions& options, const StreamFile& stream) {
  const std::optional<NamedConfig> asked = asked_config(options);
  if (!asked) return {"of the stream", stream.config()};
  const NamedConfig& config = *asked;
  for (const ParamInfo& p : kParams)
    if (p.affects_pixels && config.config.*(p.member) != stream.config().*(p.member))
      throw Error(fmt::format("{}: {}: {} is {}, the stream's is {}", options.input, config.name, p.name,
                              config.config.*(p.member), stream.config().*(p.member)));
  return config;
}

void Source::open_scene(const SourceOptions& options) {
  load_scene(options);
  add_front_end(options);
  open_frames();
  remarks_.emplace(config_.config, options.size, options.cull);
}

void Source::add_front_end(const SourceOptions& options) {
  if (give_front_end(options.level, config_.config))
    notes_.push_back(fmt::format("ACTIVE: {} polygons at once, since {} has no front end", kUsualActive, config_.name));
}

void Source::load_scene(const SourceOptions& options) {
  scene_ =
      options.scene ? options.scene : std::make_shared<const Scene>(cosim::load_scene(options.input, options, host_));
  name_ = plain_name(scene_->name());
  frames_ = options.frames > 0 ? options.frames : scene_->frame_count();
  progress_ = host_.progress();
  if (options_.size.width > kMaxSize || options_.size.height > kMaxSize)
    throw Error(
        fmt::format("--size: {}x{}: at most {}x{}", options_.size.width, options_.size.height, kMaxSize, kMaxSize));
  const SceneFrame first = scene_->frame(0, frames_);
  notes_ = scene_notes(*scene_, first, options);
  const auto needed = [&] {
    return needs_of_frames(*scene_, frames_, options.size.width, options.size.height, options.samples,
                           [this] { host_.check(); });
  };
  const bool given = options.parameters.has_value();
  if (options.config.empty() && !given) {
    try {
      DrawOptions draw = draw_options(options);
      draw.frames = frames_;
      config_ = choose_config(*scene_, draw);
    } catch (const Error& e) {
      const std::string line = widened_config(needed());
      throw Error(fmt::format("{}: {}{}", options.input, e.what(),
                              line.empty() ? "" : "; --config FILE can, with this line in it: " + line));
    }
    notes_.push_back(fmt::format("configuration: {}", config_.name));
    return;
  }
  if (options.config == kPlanned && !given) {
    config_ = planned_config(options_, scene_, host_);
    notes_.push_back(fmt::format("configuration: plan ({})", config_.config.arrangement == 0
                                                                 ? "systolic"
                                                                 : fmt::format("LANES {}", config_.config.lanes)));
    return;
  }
  config_ = *asked_config(options);
  Needs needs = needed();
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
  draw.order = progress_ ? order_build(options_, host_, *progress_, name_ + ": order of translucent faces")
                         : order_build(options_, host_);
  draw.name = name_;
  scene_frames_ = std::make_unique<SceneFrames>(scene_, config_.config, std::move(draw));
}

}  // namespace kage::cosim
