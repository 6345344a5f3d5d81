// SPDX-License-Identifier: Apache-2.0
// kage cache [list|verify|prune]: the RTL models and verdicts that are kept.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "cosim/model/model_cache.hpp"
#include "cosim/verdict_store.hpp"
#include "kage/config.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "results.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

using cosim::CachedModel;
using cosim::ModelCache;

struct CacheCommand : Options {
  std::string what;
  std::string older_than;
  std::string max_size;
};

/// "1.5 MiB"
std::string size_text(std::uint64_t bytes) {
  if (bytes < 1024) return fmt::format("{} bytes", bytes);
  double value = static_cast<double>(bytes) / 1024;
  for (const char* unit : {"KiB", "MiB"}) {
    if (value < 1024) return fmt::format("{:.1f} {}", value, unit);
    value /= 1024;
  }
  return fmt::format("{:.1f} GiB", value);
}

/// A number with one of the letters of `units` behind it, which stand for `factors`. No letter: the first factor.
std::uint64_t with_unit(const std::string& option, const std::string& text, const std::string& units,
                        const std::vector<std::uint64_t>& factors, const std::string& like) {
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const std::size_t unit = stop + 1 == end ? units.find(*stop) : std::string::npos;
  if (error != std::errc{} || unit == std::string::npos || value > UINT64_MAX / 2 / factors[unit])
    throw CLI::ValidationError(option, fmt::format("{} is not {}", text, like));
  return value * factors[unit];
}

std::chrono::seconds age_of(const std::string& text) {
  return std::chrono::seconds(with_unit("--older-than", text, "mhd", {60, 3600, 86400},
                                        "a number of minutes, hours or days, like 90m, 12h, 30d"));
}

std::uint64_t bytes_of(const std::string& text) {
  return with_unit("--max-size", text, "KMG", {1ULL << 10, 1ULL << 20, 1ULL << 30}, "a size, like 500M or 2G");
}

/// The named configuration that a model is of, or its parameters as far as they are not the defaults.
std::string config_text(const Json& about) {
  if (!about.contains("config") || !about["config"].is_object()) return "unknown";
  Config config;
  for (const ParamInfo& p : kParams)
    if (about["config"].contains(p.name) && about["config"][p.name].is_number_integer())
      config.*(p.member) = about["config"][p.name].get<int>();
  std::string text;
  for (const NamedConfig& named : named_configs())
    if (to_json(named.config) == to_json(config)) text = named.name;
  const Config defaults;
  if (text.empty())
    for (const ParamInfo& p : kParams)
      if (config.*(p.member) != defaults.*(p.member))
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", p.name, config.*(p.member));
  if (const std::string fault = about.value("fault", ""); !fault.empty()) text += ", fault " + fault;
  if (const std::string netlist = about.value("netlist", ""); !netlist.empty()) text += ", " + netlist + " netlist";
  if (about.value("monitors", false)) text += ", with monitors";
  if (about.value("waves", false)) text += ", for waveforms";
  if (about.value("lines", false)) text += ", counting lines";
  if (about.value("mutants", false)) text += ", with mutants";
  return text;
}

std::string time_text(std::filesystem::file_time_type time) {
  const auto system = std::chrono::file_clock::to_sys(time);
  return fmt::format("{:%Y-%m-%d %H:%M}",
                     fmt::localtime(std::chrono::system_clock::to_time_t(
                         std::chrono::time_point_cast<std::chrono::system_clock::duration>(system))));
}

Json to_json(const CachedModel& model) {
  return {
      {"key", model.key}, {"bytes", model.bytes}, {"last_used", time_text(model.last_used)}, {"about", model.about}};
}

std::uint64_t total(const std::vector<CachedModel>& models) {
  std::uint64_t bytes = 0;
  for (const CachedModel& m : models) bytes += m.bytes;
  return bytes;
}

std::uint64_t total(const std::vector<cosim::StoredVerdict>& verdicts) {
  std::uint64_t bytes = 0;
  for (const cosim::StoredVerdict& v : verdicts) bytes += v.bytes;
  return bytes;
}

/// Record of the stored verdicts. `damaged` is their number, or null where they were not checked.
Json of_verdicts(const cosim::VerdictStore& store, const Json& damaged) {
  const std::vector<cosim::StoredVerdict> all = store.list();
  return {{"folder", store.folder().string()}, {"verdicts", all.size()}, {"bytes", total(all)}, {"damaged", damaged}};
}

std::string text_of_verdicts(const Json& verdicts) {
  std::string text =
      fmt::format("{}: {}, {}", verdicts["folder"].get<std::string>(),
                  counted(verdicts["verdicts"].get<std::uint64_t>(), "verdict"), size_text(verdicts["bytes"]));
  if (const Json& damaged = verdicts["damaged"]; !damaged.is_null())
    text += fmt::format(", {} of them damaged", damaged.get<std::uint64_t>());
  return text + "\n";
}

/// The limits for verdicts where models and what belongs to them take so many bytes.
cosim::CacheLimits beside(cosim::CacheLimits limits, std::uint64_t taken) {
  if (limits.bytes) limits.bytes = *limits.bytes - std::min(*limits.bytes, taken);
  return limits;
}

std::string line_of(const CachedModel& model) {
  return fmt::format("{}  {:>9}  {}  {}\n", model.key.substr(0, 12), size_text(model.bytes), time_text(model.last_used),
                     config_text(model.about));
}

/// A model's damage in words, also where the model is not to be trusted.
std::string damage_of(const ModelCache& cache, const std::string& key) {
  try {
    return cache.damage(key).value_or("it is gone");
  } catch (const Error& e) {
    return e.what();
  }
}

int run(const CacheCommand& o) {
  check_json(o, o.json);
  const ModelCache cache;
  const cosim::VerdictStore store;
  Json damaged_verdicts = nullptr;
  std::size_t gone_verdicts = 0;
  std::vector<CachedModel> models = cache.list();
  Json j{{"folder", cache.folder().string()}, {"models", Json::array()}};
  std::string text;
  int rc = kSame;
  if (o.what == "prune") {
    std::vector<CachedModel> gone;
    for (CachedModel& m : models)
      if (!damage_of(cache, m.key).empty() && cache.remove(m.key)) gone.push_back(std::move(m));
    cosim::CacheLimits limits;
    if (!o.older_than.empty()) limits.age = age_of(o.older_than);
    if (!o.max_size.empty()) limits.bytes = bytes_of(o.max_size);
    for (CachedModel& m : cache.prune(limits)) gone.push_back(std::move(m));
    cache.prune_others(limits);
    for (const CachedModel& m : gone) j["models"].push_back(to_json(m));
    const std::vector<CachedModel> left = cache.list();
    gone_verdicts = store.prune(beside(limits, total(left) + cache.other_bytes())).size();
    j["left"] = {{"models", left.size()}, {"bytes", total(left)}};
    text = fmt::format("removed {}, {}, and {}; {} left, {}", counted(gone.size(), "model"), size_text(total(gone)),
                       counted(gone_verdicts, "verdict"), counted(left.size(), "model"), size_text(total(left)));
  } else {
    for (const CachedModel& m : models) {
      Json entry = to_json(m);
      if (o.what == "list") text += line_of(m);
      if (o.what == "verify") {
        const std::string damage = damage_of(cache, m.key);
        if (!damage.empty()) rc = kDifferent;
        entry["damage"] = damage;
        text += fmt::format("{}  {}  {}\n", m.key.substr(0, 12), damage.empty() ? "whole" : "damaged: " + damage,
                            config_text(m.about));
      }
      j["models"].push_back(entry);
    }
    if (o.what == "verify") {
      std::size_t damaged = 0;
      for (const cosim::StoredVerdict& v : store.list()) damaged += store.is_whole(v.key) ? 0U : 1U;
      if (damaged != 0) rc = kDifferent;
      damaged_verdicts = damaged;
    }
    j["bytes"] = total(models);
    text +=
        fmt::format("{}: {}, {}", cache.folder().string(), counted(models.size(), "model"), size_text(total(models)));
  }
  const std::uint64_t others = cache.other_bytes();
  j["other_bytes"] = others;
  text += fmt::format(", and {} of logs, locks and objects to link\n", size_text(others));
  j["verdicts"] = of_verdicts(store, damaged_verdicts);
  if (o.what == "prune") j["verdicts"]["removed"] = gone_verdicts;
  text += text_of_verdicts(j["verdicts"]);
  TempFiles files;
  finish(o.json, {"kage.cache/1", j}, files, text);
  return rc;
}

}  // namespace

void add_cache(CLI::App& app, Action& action) {
  CLI::App* c =
      add_command(app, "cache", "Show, verify or prune the RTL models and verdicts that are kept",
                  "  kage cache                                         # where they lie, how many, how large\n"
                  "  kage cache list                                    # each: key, size, last use, configuration\n"
                  "  kage cache verify                                  # exit code 1 if one is damaged\n"
                  "  kage cache prune --older-than 30d --max-size 2G    # damaged ones go in any case");
  const auto o = std::make_shared<CacheCommand>();
  c->add_option("WHAT", o->what, "list, verify or prune; without it: folder, number and size")
      ->check(one_of({"list", "verify", "prune"}))
      ->type_name("");
  c->add_option("--older-than", o->older_than, "prune: remove what was not used for so long, like 90m, 12h, 30d")
      ->type_name("AGE");
  c->add_option("--max-size", o->max_size,
                "prune: the least recently used models, then verdicts, until the others fit, like 500M, 2G")
      ->type_name("SIZE");
  option_json(*c, o->json);
  c->callback([o, &action] {
    if (o->what != "prune" && (!o->older_than.empty() || !o->max_size.empty()))
      throw CLI::ValidationError("--older-than, --max-size", "belong to kage cache prune");
    if (!o->older_than.empty()) (void)age_of(o->older_than);
    if (!o->max_size.empty()) (void)bytes_of(o->max_size);
    action = [o] { return run(*o); };
  });
}

}  // namespace kage::cli
