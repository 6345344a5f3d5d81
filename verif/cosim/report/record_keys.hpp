// SPDX-License-Identifier: Apache-2.0
//
// The keys of each record's JSON, once: one visitor writes by them (record_json.cpp), another reads (record_read.cpp).
#pragma once

#include <string>
#include <type_traits>

#include "cosim/report/run_record.hpp"

namespace kage::report {

template <class T>
struct Of {};

template <class V>
void keys(V& v, Of<cosim::Stalls>) {
  v("input_starved", &cosim::Stalls::starved);
  v("output_blocked", &cosim::Stalls::blocked);
}

template <class V>
void keys(V& v, Of<OptionsRecord>) {
  using R = OptionsRecord;
  v("fault", &R::fault);
  v("netlist", &R::netlist);
  v("front_end", &R::front_end);
  v("idle", &R::idle);
  v("backpressure", &R::backpressure);
  v("stages", &R::stages);
  v("degrade", &R::degrade);
  v("order", &R::order);
  v("alpha", &R::alpha);
  v("cull", &R::cull);
  v("samples", &R::samples);
  v("classes", &R::classes);
  v("max_shading", &R::max_shading);
  v("sub_bits", &R::sub_bits);
  v("all_spans", &R::all_spans);
}

template <class V>
void keys(V& v, Of<WayRecord>) {
  using R = WayRecord;
  v("object", &R::object);
  v("component", &R::component);
  v("components", &R::components);
  v("unit_frames", &R::unit_frames);
  v("span_frames", &R::span_frames);
  v("why", &R::why);
}

template <class V>
void keys(V& v, Of<FrameRecord>) {
  using R = FrameRecord;
  v("frame", &R::frame);
  v("same", &R::same);
  v("taken", &R::taken);
  v("cycles", &R::cycles);
  v("stalled", &R::stalls);
  v("stalled_by_phase", &R::phase_stalls);
  v("spans", &R::spans);
  v("span_pixels", &R::span_pixels);
  v("segments", &R::segments);
  v("words", &R::words);
}

template <class V>
void keys(V& v, Of<DivergenceRecord>) {
  using R = DivergenceRecord;
  v("frame", &R::frame);
  v("line", &R::line);
  v("x", &R::x);
  v("module", &R::module);
  v.follows("file", [](const R& r) { return Json(r.file()); });
  v("what", &R::what);
  v("field", &R::field);
  v("expected", &R::expected);
  v("actual", &R::actual);
  v("cycle", &R::cycle);
  v("token", &R::token);
  v("token_text", &R::token_text);
  v("source", &R::source);
  v("waits", &R::waits);
  v("save_file", &R::save_file);
  v("initial_state", &R::initial_state);
  v("text", &R::text);
}

template <class V>
void keys(V& v, Of<DifferenceRecord>) {
  using R = DifferenceRecord;
  v("frame", &R::frame);
  v("line", &R::line);
  v("x", &R::x);
  v.follows("stage", [](const R& r) { return r.divergence ? Json(r.divergence->module) : Json(nullptr); });
  v.follows("cycle", [](const R& r) { return r.divergence ? Json(r.divergence->cycle) : Json(nullptr); });
  v("field", &R::field);
  v("expected", &R::expected);
  v("actual", &R::actual);
  v("assertion", &R::assertion);
  v("waveform", &R::waveform);
  v("text", &R::text);
  v("searched", &R::searched);
  v("no_divergence", &R::no_divergence);
  v("divergence", &R::divergence);
}

template <class V>
void keys(V& v, Of<KeptRecord>) {
  using R = KeptRecord;
  v("file", &R::file);
  v.if_there("ahead", &R::ahead);
  v("alone", &R::alone);
  v.if_there("takes", &R::takes);
  v.if_there("in_place", &R::in_place);
  v("lines", &R::lines);
  v("tokens", &R::tokens);
  v("width", &R::width);
  v("words", &R::words);
  v("words_before", &R::words_before);
  v("again", &R::again);
}

template <class V>
void keys(V& v, Of<VerdictsRecord>) {
  using R = VerdictsRecord;
  v("cached", &R::cached);
  v.follows("taken", [](const R& r) { return Json(r.taken_frames.size()); });
  v("taken_frames", &R::taken_frames);
  v("kept", &R::kept);
  v("trouble", &R::trouble);
}

template <class V>
void keys(V& v, Of<CoveragePointRecord>) {
  using R = CoveragePointRecord;
  v("group", &R::group);
  v("name", &R::name);
  v("frames", &R::frames);
}

template <class V>
void keys(V& v, Of<CoverageRecord>) {
  v("frames", &CoverageRecord::frames);
  v("points", &CoverageRecord::points);
}

template <class V>
void keys(V& v, Of<ShardNumber>) {
  v("index", &ShardNumber::index);
  v("count", &ShardNumber::count);
}

template <class V>
void keys(V& v, Of<ShardRecord>) {
  using R = ShardRecord;
  v.parts_of("index", &R::number);
  v("file", &R::file);
  v("same", &R::same);
  v("frames", &R::frames);
  v("first_frame", &R::first_frame);
  v("frame_step", &R::frame_step);
  v("golden_seconds", &R::golden_seconds);
  v("rtl_seconds", &R::rtl_seconds);
  v("again", &R::again);
  v("folder", &R::folder);
  v("rtl", &R::rtl);
  v("versions", &R::versions);
  v("report", &R::page);
  v("report_crc32", &R::page_crc32);
  v("polyhedra", &R::ways);
  v.there_unless_same("first_difference");
  v("first_difference", &R::first_difference);
}

template <class V>
void keys(V& v, Of<BoardScreenRecord>) {
  using R = BoardScreenRecord;
  v("shown", &R::shown);
  v("late", &R::late);
  v("underrun_frames", &R::underrun_frames);
  v("underrun_lines", &R::underrun_lines);
}

template <class V>
void keys(V& v, Of<BoardLinkRecord>) {
  using R = BoardLinkRecord;
  v("sent", &R::sent);
  v("resent", &R::resent);
  v("damaged", &R::damaged);
  v("good", &R::good);
  v("bad", &R::bad);
  v("overruns", &R::overruns);
}

template <class V>
void keys(V& v, Of<BoardLoopRecord>) {
  using R = BoardLoopRecord;
  v("frames", &R::frames);
  v("repetitions", &R::repetitions);
  v("lines", &R::lines);
  v("mismatches", &R::mismatches);
  v("seconds", &R::seconds);
  v("left", &R::left);
  v("screen", &R::screen);
}

template <class V>
void keys(V& v, Of<BoardRecord>) {
  using R = BoardRecord;
  v("name", &R::name);
  v("port", &R::port);
  v("lines_compared", &R::lines_compared);
  v("lines_different", &R::lines_different);
  v("registers_compared", &R::registers_compared);
  v("runs", &R::runs);
  v("direct", &R::direct);
  v("seconds", &R::seconds);
  v("screen", &R::screen);
  v("link", &R::link);
  v("loop", &R::loop);
}

template <class V>
void keys(V& v, Of<SceneRecord>) {
  using R = SceneRecord;
  const bool joined = v.record().joined;
  v("same", &R::same);
  v("frames", &R::frames);
  v("width", &R::width);
  v("height", &R::height);
  if (!joined) v("sizes_vary", &R::sizes_vary);
  v.if_there("own_sizes", &R::own_sizes);
  v("pixels_compared", &R::pixels_compared);
  v("spans", &R::spans);
  v("span_pixels", &R::span_pixels);
  v("segments", &R::segments);
  v("units", &R::units);
  v("polyhedra", &R::ways);
  v("cycles", &R::cycles);
  v("stalled", &R::stalls);
  v("scene", &R::scene);
  v("total_frames", &R::total_frames);
  v("first_frame", &R::first_frame);
  v("frame_step", &R::frame_step);
  v("shard", &R::shard);
  v("options", &R::options);
  v("frame_seconds", &R::frame_seconds);
  v("each", &R::each);
  v("verdicts", &R::verdicts);
  v("golden_seconds", &R::golden_seconds);
  v("rtl_seconds", &R::rtl_seconds);
  v("build_seconds", &R::build_seconds);
  v("config_name", &R::config_name);
  v("config", &R::config);
  v.whole("seed", &R::seed);
  v("versions", &R::versions);
  if (!joined) {
    v("again", &R::again);
    v("folder", &R::folder);
    v("rtl", &R::rtl);
  }
  v("degraded", &R::degraded);
  v("pictures", &R::pictures);
  if (!joined) {
    v("report", &R::page);
    v("report_crc32", &R::page_crc32);
  }
  v.there_unless_same("first_difference");
  v("first_difference", &R::first_difference);
  if (!joined) v("kept", &R::kept);
  v("notes", &R::notes);
  v.if_there("coverage", &R::coverage);
  v.if_there("board", &R::board);
  if (joined) v("shards", &R::shards);
}

template <class T, class... All>
inline constexpr bool kIsOneOf = (std::is_same_v<T, All> || ...);

/// Records that have keys of their own.
template <class T>
concept Record = kIsOneOf<T, cosim::Stalls, OptionsRecord, WayRecord, FrameRecord, DivergenceRecord, DifferenceRecord,
                          KeptRecord, VerdictsRecord, CoveragePointRecord, CoverageRecord, ShardNumber, ShardRecord,
                          BoardScreenRecord, BoardLinkRecord, BoardLoopRecord, BoardRecord, SceneRecord>;

inline std::string phase_name(std::size_t i) {
  return std::string(i < kPhases ? kPhaseNames[i] : "behind the last token");
}

}  // namespace kage::report
