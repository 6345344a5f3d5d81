// SPDX-License-Identifier: Apache-2.0
// Configurations, packs and records.
#include "contract/config_text.hpp"
#include "cosim/report/run_record.hpp"
#include "file/read_file.hpp"
#include "fuzz/target.hpp"
#include "json/foreign_json.hpp"
#include "json/json_text.hpp"
#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "stimulus/random_frames.hpp"
#include "vectors/check.hpp"
#include "vectors/pack.hpp"
#include "vectors/write.hpp"

namespace kage::fuzz {
namespace {

void run_config(Bytes bytes) {
  const Config config = load_config(file_of("c.yaml", bytes).string()).config;
  require(to_yaml(config_from_text(to_yaml(config), "again")) == to_yaml(config), "what is written is read as it was");
}

std::vector<std::string> config_seeds() {
  std::vector<std::string> seeds;
  for (const char* name : {"tiny", "widest"}) seeds.push_back(to_yaml(load_config(name).config));
  return seeds;
}

/// A record that is read is written, and read again, as the same.
void run_record(Bytes bytes) {
  const auto json = parse_json<report::Json>(text_of(bytes), "r.json");
  const report::RunRecord record = report::RunRecord::from_json(json);
  const report::Json written = report::to_json(record);
  require(report::to_json(report::RunRecord::from_json(written)) == written,
          "a record is the same when it is read again");
}

std::vector<std::string> record_seeds() {
  std::vector<std::string> seeds;
  for (const bool several : {false, true}) {
    report::RunRecord record;
    record.several = several;
    for (int i = 0; i <= (several ? 1 : 0); ++i) {
      report::SceneRecord& s = record.scenes.emplace_back();
      s.scene = "a";
      s.frames = s.total_frames = 1;
      s.width = s.height = 4;
      s.config_name = "tiny";
      s.config = load_config("tiny").config;
      s.frame_seconds.emplace_back(0.5);
    }
    if (several) record.page = "report.html";
    seeds.push_back(json_text(report::to_json(record)));
  }
  return seeds;
}

void run_pack(Bytes bytes) {
  const auto manifest = file_of("pack/manifest.json", bytes);
  (void)vectors::checked_pack(manifest.parent_path(), vectors::Check::all, [] {});
}

std::vector<std::string> pack_seeds() {
  const Config config = load_config("tiny").config;
  const auto folder = file_of("pack/none", {}).parent_path();
  TempFiles files;
  vectors::PackWriter writer(folder, config, files);
  vectors::Pack pack;
  pack.scene = "random";
  pack.config_name = "tiny";
  pack.config = config;
  pack.made_by = "a test";
  verif::Random random(1);
  const auto words = verif::sound_frame(random, config, 0);
  pack.frames.push_back(writer.frame("frame", [&](const WordSink& sink) { sink(words); }));
  pack.reads = vectors::register_reads(config, pack.frames);
  writer.finish(pack);
  files.commit();
  return {read_file(folder / vectors::kManifest)};
}

void run_json(Bytes bytes) {
  const auto json = parse_json<nlohmann::ordered_json>(text_of(bytes), "j.json");
  const std::string text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::strict);
  require(json_text(parse_json<nlohmann::ordered_json>(text, "again")) == text, "what is written is read as it was");
  (void)json_member(text_of(bytes), "k", "j.json");
}

std::vector<std::string> json_seeds() { return {R"({"k": [1, -2.5e3, "t\u00e4\n", null, true, {"a": []}], "z": {}})"}; }

}  // namespace

std::span<const Target> text_targets() {
  static const Target kTargets[] = {{"config", "configurations in YAML", run_config, config_seeds},
                                    {"json", "any JSON", run_json, json_seeds},
                                    {"record", "records of runs", run_record, record_seeds},
                                    {"pack", "packs of test vectors", run_pack, pack_seeds}};
  return kTargets;
}

}  // namespace kage::fuzz
