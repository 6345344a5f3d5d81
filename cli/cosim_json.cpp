// SPDX-License-Identifier: Apache-2.0
#include "cosim_json.hpp"

#include "options.hpp"
#include "results.hpp"

namespace kage::cli {
namespace {

/// By the name of the phase; without those that lost nothing.
Json of_phases(const cosim::PhaseStalls& stalls) {
  Json j = Json::object();
  for (std::size_t i = 0; i < stalls.size(); ++i)
    if (stalls[i].starved != 0 || stalls[i].blocked != 0)
      j[std::string(i < cosim::kPhases ? cosim::kPhaseNames[i] : "behind the last token")] = cli::to_json(stalls[i]);
  return j;
}

}  // namespace

Json options_of(const CosimCommand& o) {
  return {{"fault", o.rtl.fault},
          {"idle", o.rtl.options.idle_percent},
          {"backpressure", o.rtl.options.backpressure_percent},
          {"degrade", o.degrade},
          {"order", name_of(o.order)},
          {"alpha", o.alpha},
          {"cull", o.cull},
          {"samples", o.samples},
          {"classes", o.classes}};
}

Json to_json(const std::optional<cosim::Difference>& d, const std::optional<cosim::Divergence>& by, bool searched) {
  if (!d) return nullptr;
  const auto text = [](const std::string& t) { return t.empty() ? Json(nullptr) : Json(t); };
  Json j;
  j["frame"] = d->frame;
  j["line"] = d->line < 0 ? Json(nullptr) : Json(d->line);
  j["x"] = d->x < 0 ? Json(nullptr) : Json(d->x);
  j["stage"] = by ? Json(by->module) : Json(nullptr);
  j["cycle"] = by ? Json(by->cycle) : Json(nullptr);
  j["field"] = d->field;
  j["expected"] = d->expected;
  j["actual"] = d->actual;
  j["assertion"] = text(d->assertion);
  j["waveform"] = by ? text(by->waveform) : Json(nullptr);
  j["text"] = cosim::describe(*d);
  j["searched"] = searched;
  j["no_divergence"] = searched && !by ? Json(cosim::describe_none(*d)) : Json(nullptr);
  j["divergence"] = nullptr;
  if (!by) return j;
  j["divergence"] = {{"frame", by->frame},
                     {"line", by->line < 0 ? Json(nullptr) : Json(by->line)},
                     {"x", by->x < 0 ? Json(nullptr) : Json(by->x)},
                     {"module", by->module},
                     {"file", "rtl/" + by->module + ".sv"},
                     {"what", by->what},
                     {"field", by->field},
                     {"expected", by->expected},
                     {"actual", by->actual},
                     {"cycle", by->cycle},
                     {"token", by->token},
                     {"token_text", text(by->token_text)},
                     {"source", text(by->source)},
                     {"waits", text(by->waits)},
                     {"save_file", text(by->save_file)},
                     {"initial_state", by->initial_state},
                     {"text", cosim::describe(*by)}};
  return j;
}

Json to_json(const cosim::Stalls& s) { return {{"input_starved", s.starved}, {"output_blocked", s.blocked}}; }

Json to_json(const std::vector<cosim::FrameResult>& frames, const std::optional<cosim::Difference>& difference) {
  Json all = Json::array();
  for (const cosim::FrameResult& r : frames)
    all.push_back({{"frame", r.frame},
                   {"same", !difference || difference->frame != r.frame},
                   {"taken", r.taken},
                   {"cycles", r.cycles},
                   {"stalled", to_json(r.stalls)},
                   {"stalled_by_phase", of_phases(r.phase_stalls)},
                   {"spans", r.counts.spans},
                   {"span_pixels", r.counts.span_pixels},
                   {"segments", r.counts.of_kind[static_cast<std::size_t>(Kind::SEG)]},
                   {"words", r.counts.words}});
  return all;
}

}  // namespace kage::cli
