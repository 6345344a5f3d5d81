// SPDX-License-Identifier: Apache-2.0
#include "mutants/trial.hpp"

#include "cosim/compare.hpp"
#include "cosim/diverge/blame.hpp"
#include "cosim/diverge/divergence.hpp"
#include "cosim/register_check.hpp"
#include "cosim/run.hpp"

namespace kage::verif {
namespace {

using cosim::Difference;

std::optional<Difference> compare(cosim::RtlCore& rtl, const Sequence& sequence, int number, int channels) {
  const cosim::KnownFrame& f = sequence.frames[static_cast<std::size_t>(number)];
  cosim::FrameComparison comparison(number, channels, false);
  for (const auto& line : sequence.lines[static_cast<std::size_t>(number)]) {
    cosim::Lines lines;
    lines.add(line);
    comparison.expect(std::move(lines));
  }
  const LineSink sink = [&](int, std::span<const std::uint8_t> line) { comparison.actual(line); };
  rtl.begin(number);
  rtl.feed(f.words, sink);
  return comparison.finish(f.end, rtl.finish(sink));
}

std::string how(const Difference& d) {
  for (const char* stands_still : {"hangs", "went idle", "does not end"})
    if (d.remark.find(stands_still) != std::string::npos) return "hang";
  return d.field.starts_with("error") ? "error" : "different";
}

// The module by the place of an assertion: "rtl/frame_control.sv:312".
std::string module_of(const std::string& where) { return std::filesystem::path(where).stem().string(); }

TrialVerdict failed(const cosim::CoreFailure& e) {
  if (e.field() == "register") return {"register", "registers", e.what()};
  return {"assertion", module_of(e.where()), e.what()};
}

// Looks through the frames up to `frame`, without assertions, which would end that too early.
std::optional<cosim::Divergence> diverges(int frame, const std::filesystem::path& library, const Inputs& inputs,
                                          const Sequence& sequence, const cosim::RtlOptions& rtl) {
  cosim::ReplayOptions options;
  options.library = library;
  options.rtl = rtl;
  options.rtl.assertions = false;
  const cosim::Feed feed = [&](int i, const WordSink& sink) {
    sink(sequence.frames[static_cast<std::size_t>(i)].words);
    return TokenCounts{};
  };
  return cosim::find_divergence(frame, feed, inputs.config, options);
}

std::optional<TrialVerdict> try_sequence(const std::filesystem::path& library, const Inputs& inputs,
                                         const Sequence& sequence, int mutant) {
  cosim::RtlOptions options = sequence.rtl;
  options.mutant = mutant;
  const auto rtl = make_rtl(library, inputs.config, options);
  for (int i = 0; i < static_cast<int>(sequence.frames.size()); ++i) {
    TrialVerdict v;
    try {
      const auto d = compare(*rtl, sequence, i, inputs.config.channels);
      if (!d) continue;
      // Where all stages agree, what is wrong is what the registers say of them.
      v = {how(*d), "registers", describe(*d)};
    } catch (const cosim::CoreFailure& e) {
      v = failed(e);
      if (v.how == "register") return v;  // no stage says why
    }
    if (const auto d = diverges(i, library, inputs, sequence, options)) {
      v.module = d->module;
      v.text = describe(*d);
    }
    return v;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> sound_divergence(const std::filesystem::path& library, const Inputs& inputs) {
  for (const Sequence& s : inputs.sequences)
    if (const auto d = diverges(static_cast<int>(s.frames.size()) - 1, library, inputs, s, s.rtl)) return describe(*d);
  return std::nullopt;
}

std::optional<TrialVerdict> try_mutant(const std::filesystem::path& library, const Inputs& inputs, int mutant) {
  for (const Sequence& s : inputs.sequences)
    if (auto v = try_sequence(library, inputs, s, mutant)) return v;
  cosim::RtlOptions options = inputs.sequences.front().rtl;
  options.backpressure_percent = 50;
  options.mutant = mutant;
  std::optional<std::string> wrong;
  try {
    wrong = wrong_register(*make_rtl(library, inputs.config, options), inputs.config, inputs.sequences.front().frames);
  } catch (const cosim::CoreFailure& e) {
    return failed(e);
  }
  if (!wrong && mutant != 0) return std::nullopt;
  // Again with monitors: registers may say truly what a module says wrong. On the sound RTL, monitors say nothing.
  const auto rtl = make_rtl(library, inputs.config, options);
  rtl->record(true);
  (void)wrong_register(*rtl, inputs.config, inputs.sequences.front().frames);
  for (const kage_rtl_event& e : rtl->take_events())
    if (static_cast<cosim::Stage>(e.stage) == cosim::Stage::part)
      return TrialVerdict{"register", cosim::part_name(inputs.config, e), wrong.value_or("so a monitor says")};
  if (!wrong) return std::nullopt;
  return TrialVerdict{"register", "registers", *wrong};
}

}  // namespace kage::verif
