// SPDX-License-Identifier: Apache-2.0
//
// Records as JSON.
#include <utility>

#include "cosim/report/record_keys.hpp"
#include "cosim/report/run_record.hpp"

namespace kage::report {
namespace {

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
  /// A key whose value follows from other members.
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

/// Sums of several scenes, besides each one's own results.
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

}  // namespace

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
    j["trouble"] = written(r->trouble);
  }
  if (record.several || record.merged) j["report"] = written(record.page);
  return j;
}

Json to_json(const SceneRecord& record) { return written(record); }
Json to_json(const FrameRecord& record) { return written(record); }
Json to_json(const std::optional<DifferenceRecord>& record) { return written(record); }
Json to_json(const WayRecords& ways) { return written(ways); }
Json to_json(const Config& config) { return written(config); }

}  // namespace kage::report
