// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/run_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "kage/error.hpp"

namespace kage::report {
namespace {

// ---- The keys of each record, once: a visitor writes by them, another reads.

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
  v("idle", &R::idle);
  v("backpressure", &R::backpressure);
  v("degrade", &R::degrade);
  v("order", &R::order);
  v("alpha", &R::alpha);
  v("cull", &R::cull);
  v("samples", &R::samples);
  v("classes", &R::classes);
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
  v("alone", &R::alone);
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
void keys(V& v, Of<SceneRecord>) {
  using R = SceneRecord;
  const bool joined = v.record().joined;
  v("same", &R::same);
  v("frames", &R::frames);
  v("width", &R::width);
  v("height", &R::height);
  if (!joined) v("sizes_vary", &R::sizes_vary);
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
  if (joined) v("shards", &R::shards);
}

template <class T, class... All>
inline constexpr bool kIsOneOf = (std::is_same_v<T, All> || ...);

/// What has keys of its own.
template <class T>
concept Record =
    kIsOneOf<T, cosim::Stalls, OptionsRecord, WayRecord, FrameRecord, DivergenceRecord, DifferenceRecord, KeptRecord,
             VerdictsRecord, CoveragePointRecord, CoverageRecord, ShardNumber, ShardRecord, SceneRecord>;

std::string phase_name(std::size_t i) {
  return std::string(i < cosim::kPhases ? cosim::kPhaseNames[i] : "behind the last token");
}

// ---- Writing

template <Record T>
Json written(const T& record);
template <class T>
Json written(const std::vector<T>& list);
Json written(const Config& config);
Json written(const cosim::PhaseStalls& stalls);

template <class T>
Json written(const T& value) {
  return value;
}

template <class T>
Json written(const std::optional<T>& value) {
  return value ? written(*value) : Json(nullptr);
}

template <class T>
Json written(const std::vector<T>& list) {
  Json all = Json::array();
  for (const T& value : list) all.push_back(written(value));
  return all;
}

Json written(const Config& config) {
  Json object = Json::object();
  for (const ParamInfo& p : kParams) object[std::string(p.name)] = config.*(p.member);
  return object;
}

/// By the name of the phase; without those that lost nothing.
Json written(const cosim::PhaseStalls& stalls) {
  Json j = Json::object();
  for (std::size_t i = 0; i < stalls.size(); ++i)
    if (stalls[i].starved != 0 || stalls[i].blocked != 0) j[phase_name(i)] = written(stalls[i]);
  return j;
}

template <class T>
class Writer {
 public:
  explicit Writer(const T& record) : record_(record) {}

  [[nodiscard]] const T& record() const { return record_; }
  template <class M>
  void operator()(const char* key, M member) {
    json_[key] = written(record_.*member);
  }
  /// A number of any size.
  template <class M>
  void whole(const char* key, M member) {
    (*this)(key, member);
  }
  /// What another member says too.
  template <class From>
  void follows(const char* key, From from) {
    json_[key] = from(record_);
  }
  /// The keys of a record within this one.
  template <class M>
  void parts_of(const char*, M member) {
    json_.update(written(record_.*member));
  }
  template <class M>
  void if_there(const char* key, M member) {
    if (record_.*member) (*this)(key, member);
  }
  void there_unless_same(const char*) {}
  [[nodiscard]] Json json() { return std::move(json_); }

 private:
  const T& record_;
  Json json_ = Json::object();
};

template <Record T>
Json written(const T& record) {
  Writer<T> writer(record);
  keys(writer, Of<T>());
  return writer.json();
}

// ---- Reading

/// No run counts so far, and sums over all shards that there can be do not wrap.
constexpr std::uint64_t kMostCount = (std::uint64_t{1} << 43) - 1;

/// Names the key, and its place where that is within another.
[[noreturn]] void refuse(const std::string& place) {
  const std::size_t slash = place.rfind('/');
  if (slash == std::string::npos) throw Error(fmt::format("{} is not what it should be", place));
  throw Error(fmt::format("{} is not what it should be ({})", place.substr(slash + 1), place));
}

void need(bool is, const std::string& place) {
  if (!is) refuse(place);
}

/// A whole number up to `most`, however it came into the JSON.
bool is_whole(const Json& j, std::uint64_t most) {
  return j.is_number_integer() && (j.is_number_unsigned() || j.get<std::int64_t>() >= 0) &&
         j.get<std::uint64_t>() <= most;
}

template <Record T>
void take(T& to, const Json& j, const std::string& place);
template <class T>
void take(std::vector<T>& to, const Json& j, const std::string& place);

void take(bool& to, const Json& j, const std::string& place) {
  need(j.is_boolean(), place);
  to = j.get<bool>();
}

void take(int& to, const Json& j, const std::string& place) {
  need(is_whole(j, std::numeric_limits<int>::max()), place);
  to = j.get<int>();
}

void take(std::uint64_t& to, const Json& j, const std::string& place) {
  need(is_whole(j, kMostCount), place);
  to = j.get<std::uint64_t>();
}

void take(std::int64_t& to, const Json& j, const std::string& place) {
  need(j.is_number_integer() && !(j.is_number_unsigned() && j.get<std::uint64_t>() > kMostCount), place);
  to = j.get<std::int64_t>();
}

/// Seconds, or a share.
void take(double& to, const Json& j, const std::string& place) {
  need(j.is_number() && j.get<double>() >= 0 && j.get<double>() < 1e9, place);
  to = j.get<double>();
}

void take(std::string& to, const Json& j, const std::string& place) {
  need(j.is_string(), place);
  to = j.get<std::string>();
}

void take(Config& to, const Json& j, const std::string& place) {
  need(j.is_object() && j.size() == kParams.size(), place);
  for (const ParamInfo& p : kParams) {
    const std::string name(p.name);
    need(j.contains(name), place + "/" + name);
    take(to.*(p.member), j[name], place + "/" + name);
  }
}

void take(cosim::PhaseStalls& to, const Json& j, const std::string& place) {
  need(j.is_object(), place);
  std::size_t known = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const auto found = j.find(phase_name(i));
    if (found == j.end()) continue;
    ++known;
    take(to[i], *found, place + "/" + phase_name(i));
  }
  need(known == j.size(), place);
}

template <class T>
void take(std::optional<T>& to, const Json& j, const std::string& place) {
  if (j.is_null())
    to.reset();
  else
    take(to.emplace(), j, place);
}

/// A list of values is named as a whole, one of records by the record.
template <class T>
void take(std::vector<T>& to, const Json& j, const std::string& place) {
  need(j.is_array(), place);
  to.clear();
  to.reserve(j.size());
  for (const Json& value : j) {
    if constexpr (Record<T>) need(value.is_object(), place);
    const std::string own = Record<T> ? fmt::format("{}/{}", place, to.size()) : place;
    take(to.emplace_back(), value, own);
  }
}

template <class T>
class Reader {
 public:
  Reader(T& record, const Json& json, std::string place)
      : record_(record), json_(json), before_(place.empty() ? "" : std::move(place) + "/") {}

  [[nodiscard]] const T& record() const { return record_; }
  template <class M>
  void operator()(const char* key, M member) {
    take(record_.*member, at(key), before_ + key);
  }
  template <class M>
  void whole(const char* key, M member) {
    need(is_whole(at(key), std::numeric_limits<std::uint64_t>::max()), before_ + key);
    record_.*member = at(key).template get<std::uint64_t>();
  }
  template <class From>
  void follows(const char* key, From) {
    (void)at(key);
  }
  template <class M>
  void parts_of(const char* first, M member) {
    (void)at(first);
    std::string place = before_;
    if (!place.empty()) place.pop_back();
    take(record_.*member, json_, place);
  }
  template <class M>
  void if_there(const char* key, M member) {
    if (json_.contains(key)) (*this)(key, member);
  }
  void there_unless_same(const char* key) { need(at(key).is_null() == record_.same, before_ + key); }

 private:
  [[nodiscard]] const Json& at(const char* key) const {
    const auto found = json_.find(key);
    need(found != json_.end(), before_ + key);
    return *found;
  }

  T& record_;
  const Json& json_;
  std::string before_;
};

template <Record T>
void take(T& to, const Json& j, const std::string& place) {
  need(j.is_object(), place);
  Reader<T> reader(to, j, place);
  keys(reader, Of<T>());
}

/// A scene among several: of one of which a shard has no frame it says no more than that.
SceneRecord scene_of(const Json& j, const std::string& place) {
  SceneRecord scene;
  scene.joined = j.contains("shards");
  const auto frames = j.find("frames");
  need(frames != j.end(), place + "/frames");
  if (*frames != 0) {
    take(scene, j, place);
    return scene;
  }
  for (const char* key : {"scene", "total_frames"}) need(j.contains(key), place + "/" + key);
  take(scene.scene, j["scene"], place + "/scene");
  take(scene.total_frames, j["total_frames"], place + "/total_frames");
  return scene;
}

/// Returns its name.
std::string_view schema_of(const Json& j) {
  const auto found = j.find("schema");
  if (found == j.end()) throw Error("it names no schema");
  for (const std::string_view known : {kCosimSchema, kMergeSchema, kRegressSchema})
    if (found->is_string() && found->get_ref<const std::string&>() == known) return known;
  throw Error(fmt::format("schema is {}, and this kage reads {}, {} and {}",
                          found->dump(-1, ' ', true, Json::error_handler_t::replace), kCosimSchema, kMergeSchema,
                          kRegressSchema));
}

RegressRecord regress_of(const Json& j) {
  RegressRecord r;
  for (const char* key : {"again", "rounds", "seed", "seconds", "build_seconds", "interrupted"})
    need(j.contains(key), key);
  take(r.again, j["again"], "again");
  take(r.rounds, j["rounds"], "rounds");
  need(is_whole(j["seed"], std::numeric_limits<std::uint64_t>::max()), "seed");
  r.seed = j["seed"].get<std::uint64_t>();
  take(r.seconds, j["seconds"], "seconds");
  take(r.build_seconds, j["build_seconds"], "build_seconds");
  take(r.interrupted, j["interrupted"], "interrupted");
  return r;
}

/// What is said of several scenes besides each one's own.
Json sums(const RunRecord& record) {
  const TotalsRecord t = record.totals();
  Json first = nullptr;
  if (const SceneRecord* scene = record.different()) {
    first = {{"scene", scene->scene}};
    first.update(written(scene->first_difference));
  }
  Json j{{"same", t.same},
         {"frames", t.frames},
         {"pixels_compared", t.pixels_compared},
         {"spans", t.spans},
         {"span_pixels", t.span_pixels},
         {"segments", t.segments},
         {"cycles", t.cycles},
         {"stalled", written(t.stalls)},
         {"total_frames", t.total_frames},
         {"shard", written(record.any().shard)},
         {"verdicts", {{"cached", t.cached}, {"taken", t.taken}, {"kept", t.kept}, {"trouble", written(t.trouble)}}},
         {"golden_seconds", t.golden_seconds},
         {"rtl_seconds", t.rtl_seconds},
         {"build_seconds", record.regress ? record.regress->build_seconds : t.build_seconds},
         {"seed", record.regress ? record.regress->seed : record.any().seed},
         {"first_difference", std::move(first)}};
  j["scenes"] = written(record.scenes);
  for (std::size_t i = 0; i < record.scenes.size(); ++i)
    if (const SceneRecord& s = record.scenes[i]; s.frames == 0)
      j["scenes"][i] = {{"same", nullptr}, {"frames", 0}, {"scene", s.scene}, {"total_frames", s.total_frames}};
  return j;
}

std::optional<std::string> there(const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); }

std::optional<int> there(int number) { return number < 0 ? std::nullopt : std::optional(number); }

}  // namespace

TotalsRecord RunRecord::totals() const {
  TotalsRecord t;
  for (const SceneRecord& s : scenes) {
    t.total_frames += static_cast<std::uint64_t>(s.total_frames);
    if (s.frames == 0) continue;
    t.same = t.same && s.same;
    t.frames += static_cast<std::uint64_t>(s.frames);
    t.pixels_compared += s.pixels_compared;
    t.spans += s.spans;
    t.span_pixels += s.span_pixels;
    t.segments += s.segments;
    t.cycles += s.cycles;
    t.stalls.starved += s.stalls.starved;
    t.stalls.blocked += s.stalls.blocked;
    t.cached = t.cached || s.verdicts.cached;
    t.taken += s.verdicts.taken_frames.size();
    t.kept += s.verdicts.kept;
    if (!t.trouble) t.trouble = s.verdicts.trouble;
    t.golden_seconds += s.golden_seconds;
    t.rtl_seconds += s.rtl_seconds;
    t.build_seconds += s.build_seconds;
  }
  return t;
}

const SceneRecord& RunRecord::any() const {
  return *std::find_if(scenes.begin(), scenes.end(), [](const SceneRecord& s) { return s.frames != 0; });
}

const SceneRecord* RunRecord::different() const {
  for (const SceneRecord& s : scenes)
    if (s.first_difference) return &s;
  return nullptr;
}

std::string_view RunRecord::schema() const { return regress ? kRegressSchema : merged ? kMergeSchema : kCosimSchema; }

RunRecord RunRecord::from_json(const Json& json) {
  if (!json.is_object()) throw Error("it is no object");
  const std::string_view schema = schema_of(json);
  RunRecord r;
  r.merged = schema == kMergeSchema;
  r.several = json.contains("scenes");
  if (r.several) {
    const Json& scenes = json["scenes"];
    need(scenes.is_array() && !scenes.empty(), "scenes");
    for (const Json& scene : scenes) need(scene.is_object(), "scenes");
    for (std::size_t i = 0; i < scenes.size(); ++i)
      r.scenes.push_back(scene_of(scenes[i], fmt::format("scenes/{}", i)));
    if (schema == kRegressSchema) r.regress = regress_of(json);
  } else {
    need(schema != kRegressSchema, "scenes");
    SceneRecord& scene = r.scenes.emplace_back();
    scene.joined = r.merged;
    take(scene, json, "");
  }
  need(std::any_of(r.scenes.begin(), r.scenes.end(), [](const SceneRecord& s) { return s.frames != 0; }), "frames");
  if (r.several || r.merged) {
    need(json.contains("report"), "report");
    take(r.page, json["report"], "report");
  }
  return r;
}

void SceneRecord::take(const cosim::Report& report) {
  same = report.same;
  frames = report.frames;
  width = report.width;
  height = report.height;
  sizes_vary = report.pixels_compared != static_cast<std::uint64_t>(frames) * static_cast<std::uint64_t>(width) *
                                             static_cast<std::uint64_t>(height);
  pixels_compared = report.pixels_compared;
  spans = report.spans;
  span_pixels = report.span_pixels;
  segments = report.segments;
  cycles = report.cycles;
  stalls = report.stalls;
  golden_seconds = report.expected_seconds;
  rtl_seconds = report.actual_seconds;
  frame_seconds.assign(report.frame_seconds.begin(), report.frame_seconds.end());
  pictures = report.pictures;
  verdicts.taken_frames = report.taken;
  for (const cosim::FrameResult& f : report.each)
    each.push_back({.frame = f.frame,
                    .same = !report.first_difference || report.first_difference->frame != f.frame,
                    .taken = f.taken,
                    .cycles = f.cycles,
                    .stalls = f.stalls,
                    .phase_stalls = f.phase_stalls,
                    .spans = f.counts.spans,
                    .span_pixels = f.counts.span_pixels,
                    .segments = f.counts.of_kind[static_cast<std::size_t>(Kind::SEG)],
                    .words = f.counts.words});
}

Json to_json(const RunRecord& record) {
  Json j{{"schema", record.schema()}};
  j.update(record.several ? sums(record) : written(record.scenes.front()));
  if (const auto& r = record.regress) {
    j["command"] = "kage regress";
    j["again"] = r->again;
    j["runs"] = record.scenes.size();
    j["rounds"] = r->rounds;
    j["seconds"] = r->seconds;
    j["interrupted"] = r->interrupted;
  }
  if (record.several || record.merged) j["report"] = written(record.page);
  return j;
}

Json to_json(const SceneRecord& record) { return written(record); }
Json to_json(const FrameRecord& record) { return written(record); }
Json to_json(const std::optional<DifferenceRecord>& record) { return written(record); }
Json to_json(const WayRecords& ways) { return written(ways); }
Json to_json(const Config& config) { return written(config); }

WayRecords ways_from_json(const Json& json) {
  WayRecords ways;
  take(ways, json, "polyhedra");
  return ways;
}

std::optional<DifferenceRecord> difference_record(const std::optional<cosim::Difference>& difference,
                                                  const std::optional<cosim::Divergence>& divergence, bool searched) {
  if (!difference) return std::nullopt;
  DifferenceRecord r;
  r.frame = difference->frame;
  r.line = there(difference->line);
  r.x = there(difference->x);
  r.field = difference->field;
  r.expected = difference->expected;
  r.actual = difference->actual;
  r.assertion = there(difference->assertion);
  r.text = cosim::describe(*difference);
  r.searched = searched;
  if (searched && !divergence) r.no_divergence = cosim::describe_none(*difference);
  if (!divergence) return r;
  r.waveform = there(divergence->waveform);
  r.divergence = {.frame = divergence->frame,
                  .line = there(divergence->line),
                  .x = there(divergence->x),
                  .module = divergence->module,
                  .what = divergence->what,
                  .field = divergence->field,
                  .expected = divergence->expected,
                  .actual = divergence->actual,
                  .cycle = divergence->cycle,
                  .token = divergence->token,
                  .token_text = there(divergence->token_text),
                  .source = there(divergence->source),
                  .waits = there(divergence->waits),
                  .save_file = there(divergence->save_file),
                  .initial_state = divergence->initial_state,
                  .text = cosim::describe(*divergence)};
  return r;
}

}  // namespace kage::report
