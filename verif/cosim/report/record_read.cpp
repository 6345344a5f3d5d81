// SPDX-License-Identifier: Apache-2.0
//
// Records from JSON. docs/schema/README.md says what a reader takes.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "cosim/report/record_keys.hpp"
#include "cosim/report/run_record.hpp"
#include "kage/config.hpp"
#include "kage/error.hpp"

namespace kage::report {
namespace {

/// More than any run reaches, and few enough that the sum over the most shards there can be stays within 64 bits.
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

/// The value of `key` in `j`. `before` is the place of `j`, with a slash behind it, or empty.
const Json& at(const Json& j, const std::string& key, const std::string& before = {}) {
  const auto found = j.find(key);
  if (found == j.end())
    throw Error(fmt::format("{} is missing{}", key, before.empty() ? "" : fmt::format(" ({}{})", before, key)));
  return *found;
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

/// A report of an earlier kage lacks parameters that came since: those have their default, as in a configuration's
/// file. One that is not known decides words and clocks in a way that nobody here can compare.
void take(Config& to, const Json& j, const std::string& place) {
  need(j.is_object(), place);
  to = {};
  std::size_t known = 0;
  for (const ParamInfo& p : kParams) {
    const std::string name(p.name);
    to.*(p.member) = p.default_value;
    const auto found = j.find(name);
    if (found == j.end()) continue;
    ++known;
    take(to.*(p.member), *found, fmt::format("{}/{}", place, name));
  }
  validate(to, place);
  if (known == j.size()) return;
  for (const auto& [name, value] : j.items())
    if (std::none_of(kParams.begin(), kParams.end(), [&n = name](const ParamInfo& p) { return p.name == n; }))
      throw Error(fmt::format("{} is no parameter of this kage ({}/{})", name, place, name));
}

/// Phases that are not known are passed over, as keys are.
void take(cosim::PhaseStalls& to, const Json& j, const std::string& place) {
  need(j.is_object(), place);
  for (std::size_t i = 0; i < to.size(); ++i) {
    const auto found = j.find(phase_name(i));
    if (found != j.end()) take(to[i], *found, place + "/" + phase_name(i));
  }
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
  [[nodiscard]] const Json& at(const char* key) const { return report::at(json_, key, before_); }

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
  if (at(j, "frames", place + "/") != 0) {
    take(scene, j, place);
    return scene;
  }
  take(scene.scene, at(j, "scene", place + "/"), place + "/scene");
  take(scene.total_frames, at(j, "total_frames", place + "/"), place + "/total_frames");
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
  take(r.again, at(j, "again"), "again");
  take(r.rounds, at(j, "rounds"), "rounds");
  need(is_whole(at(j, "seed"), std::numeric_limits<std::uint64_t>::max()), "seed");
  r.seed = j["seed"].get<std::uint64_t>();
  take(r.seconds, at(j, "seconds"), "seconds");
  take(r.build_seconds, at(j, "build_seconds"), "build_seconds");
  take(r.interrupted, at(j, "interrupted"), "interrupted");
  if (j.contains("trouble")) take(r.trouble, j["trouble"], "trouble");
  return r;
}

}  // namespace

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
    if (schema == kRegressSchema) (void)at(json, "scenes");
    SceneRecord& scene = r.scenes.emplace_back();
    scene.joined = r.merged;
    take(scene, json, "");
  }
  need(std::any_of(r.scenes.begin(), r.scenes.end(), [](const SceneRecord& s) { return s.frames != 0; }), "frames");
  if (r.several || r.merged) {
    take(r.page, at(json, "report"), "report");
  }
  return r;
}

WayRecords ways_from_json(const Json& json) {
  WayRecords ways;
  take(ways, json, "polyhedra");
  return ways;
}

}  // namespace kage::report
