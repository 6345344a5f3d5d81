// SPDX-License-Identifier: Apache-2.0
// kage explain SCENE --frame N --pixel X,Y: what each token did to one pixel.
#include "kage/explain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>

#include "command.hpp"
#include "cosim/diverge/divergence.hpp"
#include "cosim/session/models.hpp"
#include "cosim/session/source.hpp"
#include "inputs.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "results.hpp"
#include "rtl_options.hpp"
#include "terminal.hpp"

namespace kage::cli {
namespace {

Json to_json(const TokenSource& s) {
  const auto number = [](int n) { return n < 0 ? Json(nullptr) : Json(n); };
  return {{"role", s.role},         {"object", s.object},       {"component", number(s.component)},
          {"face", number(s.face)}, {"light", number(s.light)}, {"sample", number(s.sample)}};
}

struct ExplainCommand : Options {
  int frame = 0;
  std::string pixel;
  bool rtl = false;
  bool check = false;
  bool changes = false;
  cosim::RtlRun run;
};

struct Pixel {
  int x = 0;
  int y = 0;
};

Pixel parse_pixel(const std::string& text) {
  Pixel p;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, p.x);
  const bool comma = first.ec == std::errc() && first.ptr != end && *first.ptr == ',';
  const auto second = comma ? std::from_chars(first.ptr + 1, end, p.y) : first;
  if (!comma || second.ec != std::errc() || second.ptr != end || p.x < 0 || p.y < 0)
    throw Error(fmt::format("--pixel {}: not X,Y with whole numbers from 0", text));
  return p;
}

Json to_json(const PixelState& s, const Config& config) {
  Json j;
  j["z"] = s.z;
  j["color"] = std::vector<int>(s.color.begin(), s.color.begin() + config.channels);
  j["class"] = s.normal_class;
  j["dsf"] = s.dsf;
  j["fsf"] = s.fsf;
  j["counts"] =
      std::vector<std::uint32_t>(s.counts.begin(), s.counts.begin() + (config.count_bits > 0 ? config.lights : 0));
  return j;
}

Json to_json(const LineView::UnitPixel& p) {
  return {{"z", p.z}, {"index", p.index}, {"color", p.color}, {"class", p.normal_class}};
}

/// The RTL's events, printed between the tokens of the golden model's history.
class RtlLines {
 public:
  RtlLines(const std::vector<cosim::RtlTouch>& rtl, bool changes) : rtl_(rtl), changes_(changes) {}

  /// At tokens before the nth, of which the history has nothing: as a line's first TP paints pixels beside its span.
  void before(std::uint32_t nth) {
    for (; next_ < rtl_.size() && rtl_[next_].nth < nth; ++next_) {
      const cosim::RtlTouch& t = rtl_[next_];
      const bool state = t.stage == cosim::Stage::pixel;
      if (!state || !changes_ || !t.same) print(t, state ? fmt::format("token {}, ", t.token) : "");
    }
  }

  /// At the token that was just told.
  void at(std::uint32_t nth) {
    for (; next_ < rtl_.size() && rtl_[next_].nth == nth; ++next_) print(rtl_[next_], "");
  }

 private:
  static void print(const cosim::RtlTouch& t, const std::string& token) {
    fmt::print("            RTL, {}cycle {}, {}{}: {}{}\n", token, t.cycle, cosim::describe(t.stage),
               t.load ? " (its colour comes back)" : "", t.text(), t.same ? "" : "   <-- differs");
  }

  const std::vector<cosim::RtlTouch>& rtl_;
  bool changes_;
  std::size_t next_ = 0;
};

std::vector<cosim::RtlTouch> watch_rtl(const ExplainCommand& o, cosim::Source& source, const Pixel& at) {
  cosim::ReplayOptions options = cosim::replay(source.named_config(), o.run, cosim::rtl_options(o.run, o.seed),
                                               cosim::ModelFor::kMonitors, terminal());
  const auto feed = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
  return cosim::watch_pixel(o.frame, o.frame, feed, source.config(), options, at.x, at.y);
}

/// A pixel's explanation: its history, and the sources of its tokens.
struct Explained {
  Pixel at;
  PixelHistory history;
  std::size_t touching = 0;  ///< tokens, of which the history may have only those that changed something
  std::map<std::uint32_t, TokenSource> sources;  ///< by PixelTouch::nth
  std::optional<std::vector<LeftOut>> left_out;  ///< what --all-spans writes beside them
  std::vector<cosim::RtlTouch> rtl;              ///< with --rtl
};

Explained explained(const ExplainCommand& o, cosim::Source& source, const Pixel& at) {
  const Config& config = source.config();
  Explained e{.at = at, .history = {}, .sources = {}, .left_out = {}, .rtl = {}};
  const std::vector<std::uint32_t> words = source.words(o.frame);
  try {
    e.history = explain_pixel(config, words, at.x, at.y);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", o.input, error.what()));
  }
  const std::optional<Provenance> provenance = source.provenance(o.frame);
  if (provenance) {
    e.sources = provenance->of_history(config, words, e.history);
    e.left_out = source.left_out(o.frame, {&e.history, &e.sources});
  }
  if (o.rtl) e.rtl = watch_rtl(o, source, at);
  e.touching = e.history.touches.size();
  if (!o.changes) return e;
  // Where the RTL differs stays: it may have changed what was to be left.
  std::set<std::uint32_t> differs;
  for (const cosim::RtlTouch& t : e.rtl)
    if (!t.same) differs.insert(t.nth);
  std::erase_if(e.history.touches, [&](const PixelTouch& t) { return !t.changed() && differs.count(t.nth) == 0; });
  return e;
}

Json to_json(const PixelTouch& t, const Explained& e, const Config& config) {
  const auto from = e.sources.find(t.nth);
  Json j;
  j["token"] = t.token;
  j["kind"] = kKindNames[static_cast<std::size_t>(t.what.kind)];
  j["text"] = t.text;
  j["made"] = t.made;
  j["z"] = t.z ? Json(*t.z) : Json(nullptr);
  j["effect"] = t.effect;
  j["source"] = from != e.sources.end() ? to_json(from->second) : Json(nullptr);
  j["before"] = to_json(t.before, config);
  j["after"] = to_json(t.after, config);
  j["bias"] = t.bias;
  if (t.what.kind != Kind::TREE) return j;
  j["units"] = Json::array();
  for (const auto& u : e.history.units) j["units"].push_back(to_json(u));
  j["tree"] = Json::array();
  for (const auto& level : e.history.tree)
    for (const TreeMatch& m : level)
      j["tree"].push_back(
          {{"level", m.level}, {"left", to_json(m.left)}, {"right", to_json(m.right)}, {"right_wins", m.right_wins}});
  return j;
}

Json to_json(const Explained& e, const ExplainCommand& o, const Config& config) {
  Json touches = Json::array();
  for (const PixelTouch& t : e.history.touches) touches.push_back(to_json(t, e, config));
  Json j;
  j["frame"] = o.frame;
  j["x"] = e.at.x;
  j["y"] = e.at.y;
  j["config"] = cli::to_json(config);
  j["tokens"] = e.touching;
  j["changes_only"] = o.changes;
  j["touches"] = std::move(touches);
  j["color"] = std::vector<int>(e.history.color.begin(), e.history.color.begin() + config.channels);
  j["color_text"] = e.history.color_text;
  j["left_out"] = e.left_out ? Json::array() : Json(nullptr);
  for (const LeftOut& l : e.left_out.value_or(std::vector<LeftOut>()))
    j["left_out"].push_back(
        {{"kind", kKindNames[static_cast<std::size_t>(l.kind)]}, {"tokens", l.tokens}, {"why", l.why}});
  j["rtl"] = o.rtl ? Json::array() : Json(nullptr);
  for (const cosim::RtlTouch& t : e.rtl)
    j["rtl"].push_back({{"token", t.token},
                        {"stage", cosim::describe(t.stage)},
                        {"load", t.load},
                        {"cycle", t.cycle},
                        {"same", t.same},
                        {"text", t.text()}});
  return j;
}

void print(const Explained& e, const ExplainCommand& o, const Config& config) {
  const PixelHistory& h = e.history;
  fmt::print("frame {}, pixel {},{}: {} it{}\n", o.frame, e.at.x, e.at.y,
             e.touching == 1 ? "1 token touches" : fmt::format("{} tokens touch", e.touching),
             o.changes ? fmt::format("; {} {} shown, where something changed{}", h.touches.size(),
                                     h.touches.size() == 1 ? "is" : "are", o.rtl ? " or the RTL differs" : "")
                       : "");
  RtlLines rtl_lines(e.rtl, o.changes);
  for (const PixelTouch& t : h.touches) {
    rtl_lines.before(t.nth);
    fmt::print("{:>8}  {}\n", t.token, t.text);
    const auto from = e.sources.find(t.nth);
    if (from != e.sources.end()) fmt::print("            from {}\n", from->second.text());
    fmt::print("            {}\n", t.effect);
    if (t.what.kind == Kind::TREE)
      for (const std::string& line : describe_tree(config, h)) fmt::print("            {}\n", line);
    if (!(t.before == t.after)) fmt::print("            now {}\n", describe(config, t.after));
    rtl_lines.at(t.nth);
  }
  fmt::print("            {}\n", h.color_text);
  rtl_lines.before(std::numeric_limits<std::uint32_t>::max());
  if (e.left_out && !e.left_out->empty()) {
    fmt::print("            left out, for it changes nothing here (--all-spans shows it):\n");
    for (const LeftOut& l : *e.left_out) fmt::print("              {}\n", l.text());
  }
}

int run(const ExplainCommand& o) {
  if (!o.rtl) refuse_rtl(o.run, "the RTL is run with --rtl only");
  check_json(o, o.json);
  const Pixel at = parse_pixel(o.pixel);
  refuse_pack(o.input);
  cosim::Source source(o, terminal());
  if (o.frame >= source.frames())
    throw Error(fmt::format("{}: --frame {}: there are frames 0 to {}", o.input, o.frame, source.frames() - 1));
  const Explained e = explained(o, source, at);
  const bool differs = std::any_of(e.rtl.begin(), e.rtl.end(), [](const cosim::RtlTouch& t) { return !t.same; });
  write_json(o.json, {"kage.explain/1", to_json(e, o, source.config())});
  print_notes(source, o.json);
  if (!json_only(o.json)) print(e, o, source.config());
  return o.check && differs ? kDifferent : kSame;
}

}  // namespace

void add_explain(Program& program, Action& action) {
  Command c = program.add("explain", "Tell the history of a pixel: every token that touched it, and what it did",
                          "  kage explain courtyard --frame 2 --pixel 316,116\n"
                          "  kage explain courtyard.kage --pixel 12,40 --json -\n"
                          "  kage explain courtyard --pixel 316,116 --rtl --check --all-spans --fault wrong_compare\n"
                          "  kage explain penumbra --pixel 320,300 --changes   (soft shadows take many tokens)\n"
                          "docs/glossary.md says what the words mean, docs/stream.md what each token does.");
  const auto o = std::make_shared<ExplainCommand>();
  option_scene(c, *o, Taken::random);
  c.add_option("--frame", o->frame, "number of the frame, from 0, default 0")
      .check(whole_number(0, std::numeric_limits<int>::max()))
      .type_name("N");
  c.add_option("--pixel", o->pixel, "column and line, from 0 at the upper left").required().type_name("X,Y");
  c.add_flag("--changes", o->changes,
             "show only tokens that changed the pixel or the line's bias, or at which the RTL differs");
  Option rtl = c.add_flag("--rtl", o->rtl, "run the RTL with monitors too and show what it did beside it");
  c.add_flag("--check", o->check, "exit code 1 if the RTL differs somewhere in the pixel's history").needs(rtl);
  options_of_frames(c, *o);
  option_front_end(c, *o);
  option_json(c, o->json);
  option_rtl(c, o->run);
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
