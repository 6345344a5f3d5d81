// SPDX-License-Identifier: Apache-2.0
#include "source.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "kage/error.hpp"
#include "kage/geometry.hpp"
#include "mapped.hpp"
#include "options.hpp"
#include "order_build.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"

namespace kage::cli {
namespace {

/// What pictures and lines of output are called by: a line break in a file's name would begin a line of its own.
std::string plain_name(const std::filesystem::path& path) {
  std::string name = path.stem().string();
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '_';
  return name;
}

// Shapes of pictures that differ by less are the same to the eye.
constexpr double kShapeTolerance = 0.01;

// Random frames of a run that does not say how many.
constexpr int kRandomFrames = 200;

}  // namespace

void refuse_order_tree(const std::string& path) {
  if (is_order_file(path)) throw Error(fmt::format("{}: a visibility order's tree; kage order takes it", path));
}

void refuse_random(const std::string& input) {
  if (verif::random_manner(input))
    throw Error(fmt::format("{}: random frames are for kage cosim and kage explain", input));
}

Source::Source(const Options& options) : options_(options) {
  if (const auto manner = verif::random_manner(options.input)) {
    open_random(options, *manner);
    return;
  }
  refuse_order_tree(options.input);
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
  refuse(options.cull, "--cull", "have no faces to be left out");
  refuse(options.alpha != usual.alpha, "--alpha", "have alphas of their own");
  refuse(options.allow_outside, "--allow-outside", "need no files");
  config_ = load_config(options.config.empty() ? "default" : options.config);
  if (options.config.empty()) notes_.push_back(fmt::format("configuration: {}", config_.name));
  name_ = options.input;
  std::replace(name_.begin(), name_.end(), ':', '_');
  frames_ = options.frames > 0 ? options.frames : kRandomFrames;
  random_.emplace(config_.config, manner, options.seed);
}

void Source::open_stream(const Options& options) {
  if (options.size_given) throw Error(fmt::format("{}: --size: a stream has its own size", options.input));
  if (options.units_only)
    throw Error(fmt::format("{}: --units-only: in a stream it is settled what goes to units", options.input));
  if (options.order != TranslucentWay::exact)
    throw Error(fmt::format("{}: --order: a stream has its own order", options.input));
  if (options.samples != Options{}.samples || options.classes != Options{}.classes)
    throw Error(fmt::format("{}: --samples, --classes: in a stream they are settled", options.input));
  if (options.cull) throw Error(fmt::format("{}: --cull: in a stream it is settled what is drawn", options.input));
  if (options.alpha != 1) throw Error(fmt::format("{}: --alpha: a stream has its own alphas", options.input));
  if (options.max_fragments)
    throw Error(fmt::format("{}: --max-fragments: a stream has its fragments already", options.input));
  guard_mapped(options.input);
  stream_ = std::make_shared<const StreamFile>(options.input);
  open_frames();
  name_ = plain_name(options.input);
  frames_ = stream_->frame_count();
  if (options.frames > frames_)
    throw Error(fmt::format("{}: --frames {}: the stream has {}", options.input, options.frames, frames_));
  if (options.frames > 0) frames_ = options.frames;
  config_ = {"of the stream", stream_->config()};
  if (options.config.empty()) return;
  config_ = load_config(options.config);
  for (const ParamInfo& p : kParams)
    if (p.affects_pixels && config_.config.*(p.member) != stream_->config().*(p.member))
      throw Error(fmt::format("{}: {}: {} is {}, the stream's is {}", options.input, config_.name, p.name,
                              config_.config.*(p.member), stream_->config().*(p.member)));
}

void Source::open_scene(const Options& options) {
  load_scene(options);
  open_frames();
  remarks_.emplace(config_.config, options.size, options.cull);
}

void Source::load_scene(const Options& options) {
  scene_ = std::make_shared<const Scene>(
      Scene::load(options.input, {options.alpha, options.allow_outside, check_interrupt}));
  name_ = plain_name(scene_->name());
  notes_ = scene_->notes();
  frames_ = options.frames > 0 ? options.frames : scene_->frame_count();
  progress_ = std::make_unique<Progress>();
  if (options_.size.width > kMaxSize || options_.size.height > kMaxSize)
    throw Error(
        fmt::format("--size: {}x{}: at most {}x{}", options_.size.width, options_.size.height, kMaxSize, kMaxSize));
  const SceneFrame first = scene_->frame(0, frames_);
  const double shape = static_cast<double>(options_.size.width) / options_.size.height;
  const double asked = first.camera.aspect;
  if (!options.size_given && asked > 0 && std::abs(shape / asked - 1) > kShapeTolerance)
    notes_.push_back(
        fmt::format("the camera's own pictures are {:.3g} times as wide as high, these {:.3g}: --size is "
                    "to be had in its shape",
                    asked, shape));
  Needs needs = needs_of(*scene_, first, options.size.width, options.size.height, options.samples);
  if (options.config.empty()) {
    try {
      config_ = choose_config(needs);
    } catch (const Error& e) {
      const std::string line = widened_config(needs);
      throw Error(fmt::format("{}: {}{}", options.input, e.what(),
                              line.empty() ? "" : "; --config FILE can, with this line in it: " + line));
    }
    notes_.push_back(fmt::format("configuration: {}", config_.name));
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
  DrawOptions draw;
  draw.width = options_.size.width;
  draw.height = options_.size.height;
  draw.frames = frames_;
  draw.look.translucent = options_.order;
  draw.look.samples = options_.samples;
  draw.look.seed = options_.seed;
  draw.look.classes = options_.classes;
  draw.look.cull = options_.cull;
  draw.look.fit = options_.degrade;
  draw.order =
      progress_ ? order_build(options_, *progress_, name_ + ": order of translucent faces") : order_build(options_);
  draw.threads = options_.threads;
  draw.name = name_;
  scene_frames_ = std::make_unique<SceneFrames>(scene_, config_.config, std::move(draw));
}

std::unique_ptr<Source> Source::share(int last) const {
  std::unique_ptr<Source> s(new Source());
  s->options_ = options_;
  s->config_ = config_;
  s->frames_ = frames_;
  s->name_ = name_;
  s->stream_ = stream_;
  s->scene_ = scene_;
  s->random_ = random_;
  if (!random_) s->open_frames();
  s->count_anew(last);
  return s;
}

void Source::count_anew(int last) {
  last_ = last;
  made_ = blank_ = unfit_ = units_ = 0;
  ways_.clear();
  if (scene_) remarks_.emplace(config_.config, options_.size, options_.cull);
}

void Source::absorb(const Source& share) {
  last_ = std::max(last_, share.last_);
  made_ += share.made_;
  blank_ += share.blank_;
  unfit_ += share.unfit_;
  units_ = std::max(units_, share.units_);
  if (remarks_) remarks_->absorb(*share.remarks_);
  if (ways_.empty()) ways_.resize(share.ways_.size());
  for (std::size_t c = 0; c < share.ways_.size(); ++c) {
    const Way& way = share.ways_[c];
    ways_[c].object = way.object;
    ways_[c].unit_frames += way.unit_frames;
    if (way.span_frames == 0) continue;
    ways_[c].span_frames += way.span_frames;
    ways_[c].reason = way.reason;
    ways_[c].why = way.why;
  }
}

std::function<std::vector<std::uint32_t>(int)> Source::prelude() const {
  return random_ ? random_->prelude() : nullptr;
}

bool Source::is_unchecked(int index) const { return random_ || (stream_ && stream_->is_port_frame(index)); }

bool Source::may_be_refused() const {
  for (int i = 0; i < frames_; ++i)
    if (is_unchecked(i)) return true;
  return false;
}

std::vector<std::string> Source::notes() const {
  std::vector<std::string> all = notes_;
  if (blank_ > 0)
    all.push_back(
        fmt::format("nothing is to be seen{}: no face covers the centre of a pixel", in_frames(blank_, made_)));
  if (unfit_ > 0)
    all.push_back(
        fmt::format("drawn with one shadow volume a light sample{}: more need FSF", in_frames(unfit_, made_)));
  if (remarks_)
    for (std::string& note : remarks_->notes()) all.push_back(std::move(note));
  return all;
}

TokenCounts Source::frame(int index, const WordSink& sink) {
  again_ = index <= last_;
  const TokenCounts counts = random_   ? frame_of_chance(index, sink)
                             : stream_ ? frame_of_stream(index, sink)
                                       : frame_of_scene(index, sink);
  last_ = std::max(last_, index);
  if (again_) return counts;
  ++made_;
  units_ = std::max(units_, counts.units);
  const auto none = [&](Kind kind) { return counts.of_kind[static_cast<std::size_t>(kind)] == 0; };
  // What a core may refuse for its header or its order says nothing of faces.
  if (!is_unchecked(index) && none(Kind::OP) && none(Kind::TREE) && none(Kind::TP)) ++blank_;
  return counts;
}

TokenCounts Source::frame_of_stream(int index, const WordSink& sink) {
  check_interrupt();
  return stream_frames_->frame(index, [&](std::span<const std::uint32_t> piece) {
    check_interrupt();
    check_mapped();  // before anybody reads the piece
    sink(piece);
  });
}

TokenCounts Source::frame_of_chance(int index, const WordSink& sink) {
  check_interrupt();
  const std::vector<std::uint32_t> words = random_->words(index);
  sink(words);
  return count_tokens(config_.config, words);
}

TokenCounts Source::frame_of_scene(int index, const WordSink& sink) {
  FrameParts parts;
  bool recorded = false;
  try {
    return scene_frames_->frame(
        index,
        [&](std::span<const std::uint32_t> words) {
          check_interrupt();
          if (!recorded) record(index, parts);
          recorded = true;
          sink(words);
        },
        parts);
  } catch (const TooManyFragments& e) {
    refuse_fragments(fmt::format("{}: frame {}", options_.input, index), e);
  }
}

std::optional<Provenance> Source::provenance(int index) {
  if (!scene_) return std::nullopt;
  try {
    return scene_frames_->provenance(index, [&](std::span<const std::uint32_t>) {
      check_interrupt();
      if (progress_) progress_->clear();
    });
  } catch (const TooManyFragments& e) {
    refuse_fragments(fmt::format("{}: frame {}", options_.input, index), e);
  }
}

// The parts are complete before the frame's first words.
void Source::record(int index, const FrameParts& parts) {
  const SceneFrame& frame = parts.scene;
  const FrameGeometry& geometry = parts.geometry;
  const PolyhedraReport& report = parts.polyhedra;
  if (progress_) progress_->clear();
  if (!again_) remarks_->add(*scene_, frame);
  if (!again_ && geometry.left_out > 0) ++unfit_;
  const int units = config_.config.units;
  if (units == 0) {
    if (options_.units_only && !geometry.polyhedra.empty())
      throw Error(fmt::format("{}: frame {}: --units-only: configuration {} has no units", name_, index, config_.name));
    return;
  }
  if (again_) return;
  const auto object = [&](std::size_t c) {
    return scene_->objects()[frame.triangles[frame.components[c].first].object];
  };
  if (ways_.empty())
    for (std::size_t c = 0; c < frame.components.size(); ++c) ways_.push_back({object(c), 0, 0, SpanReason::none, {}});
  for (std::size_t c = 0; c < frame.components.size(); ++c) {
    const SpanReason reason = geometry.span_reasons[c];
    if (reason == SpanReason::none) continue;  // below
    ++ways_[c].span_frames;
    ways_[c].reason = reason;
    ways_[c].why = reason == SpanReason::not_closed || reason == SpanReason::not_convex ? frame.components[c].reason
                   : reason == SpanReason::cut         ? "the near plane or the guard band cuts it"
                   : reason == SpanReason::translucent ? "it is translucent"
                   : reason == SpanReason::culled      ? "--cull leaves out faces that the eye would see"
                                                       : "a face has more than one colour";
  }
  const Way* stopped = nullptr;
  for (std::size_t i = 0; i < geometry.polyhedra.size(); ++i) {
    Way& way = ways_[geometry.polyhedra[i].component];
    if (report.unit_of[i] == PolyhedraReport::kUnseen) continue;
    if (report.unit_of[i] != PolyhedraReport::kSpans) {
      ++way.unit_frames;
      continue;
    }
    ++way.span_frames;
    using Stop = PolyhedraReport::Stop;
    const std::string cause = report.stop == Stop::no_unit ? fmt::format("no unit of {} has room for it", units)
                              : report.stop == Stop::depth ? "its depth does not go on by a step that segments have"
                                                           : "ORDER_BITS holds no draw index for it";
    // The first one stopped the assignment; the others went with it.
    if (stopped == nullptr) stopped = &way;
    way.why = stopped == &way ? cause : fmt::format("behind '{}' in draw order: {}", stopped->object, cause);
    if (options_.units_only)
      throw Error(fmt::format("{}: frame {}: object '{}', component {}: {} (--units-only)", name_, index, way.object,
                              geometry.polyhedra[i].component, cause));
  }
}

report::WayRecords Source::ways() const {
  if (stream_) return ways_of(*stream_);
  if (config_.config.units == 0) return std::nullopt;
  std::vector<report::WayRecord> list;
  for (std::size_t c = 0; c < ways_.size();) {
    const Way& w = ways_[c];
    std::size_t end = c + 1;
    while (w.reason != SpanReason::none && w.unit_frames == 0 && end < ways_.size() && ways_[end].object == w.object &&
           ways_[end].reason == w.reason && ways_[end].unit_frames == 0 && ways_[end].span_frames == w.span_frames)
      ++end;
    list.push_back({.object = w.object,
                    .component = c,
                    .components = end - c,
                    .unit_frames = static_cast<std::uint64_t>(w.unit_frames),
                    .span_frames = static_cast<std::uint64_t>(w.span_frames),
                    .why = w.why.empty() ? std::nullopt : std::optional(w.why)});
    c = end;
  }
  return list;
}

report::WayRecords ways_of(const StreamFile& file) {
  const Json origin = Json::parse(file.origin(), nullptr, false);
  if (!origin.is_object() || !origin.contains("polyhedra")) return std::nullopt;
  // Whoever wrote the file: what is not of this form is not taken, and nothing else is copied.
  try {
    report::WayRecords ways = report::ways_from_json(origin["polyhedra"]);
    const auto frames = static_cast<std::uint64_t>(file.frame_count());
    for (const report::WayRecord& w : ways.value_or(std::vector<report::WayRecord>()))
      if (w.component > ~0U || w.components > ~0U || w.unit_frames > frames || w.span_frames > frames)
        return std::nullopt;
    return ways;
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::string notes_text(const Source& source) {
  std::string text;
  for (const std::string& note : source.notes()) text += fmt::format("{}: {}\n", source.name(), note);
  return text;
}

void print_notes(const Source& source, const Options& options) {
  fmt::print(json_only(options) ? stderr : stdout, "{}", notes_text(source));
}

}  // namespace kage::cli
