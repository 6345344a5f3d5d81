// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/joined.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "cosim/diverge/waveform.hpp"
#include "cosim/recall.hpp"
#include "cosim/report/html.hpp"
#include "file/shown.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"

namespace kage::report {
namespace {

namespace fs = std::filesystem;

/// As the relative address of a file, from a page.
std::string address(const fs::path& relative) {
  std::string out = "./";  // whatever the first name looks like, it is no scheme
  for (const char c : relative.generic_string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("/._-~").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

/// Places where a page may be that was written as `named` in `folder`, and of which `file` tells. It may be beside
/// `file`, without those first folders of `named` that were left behind when both were moved. Or it is where it was
/// written.
std::vector<fs::path> places_of(const fs::path& named, const std::string& file, const fs::path& folder) {
  std::vector<fs::path> places;
  if (!file.empty())
    for (auto from = named.begin(); from != named.end(); ++from) {
      fs::path place = fs::path(file).parent_path();
      for (auto step = from; step != named.end(); ++step) place /= *step;
      places.push_back(place);
    }
  places.push_back(folder / named);
  return places;
}

/// Where the page of a run is, or is to be with the others of `files`; or "". `file` is that which the part's report
/// came from, if any.
fs::path page_of(const PartRecord& part, const std::string& file, const TempFiles& files) {
  if (!part.page || !part.page_crc32) return {};
  for (const fs::path& place : places_of(*part.page, file, part.folder)) {
    std::error_code error;
    const fs::path now = files.now(place);
    if (!fs::is_regular_file(now, error) || fs::file_size(now, error) > kPageBytes || error) continue;
    if (checksum(now) == *part.page_crc32) return place;
  }
  return {};
}

/// A scene as the page lists it: its record, without what is listed by frame or by shard.
Json listed(SceneRecord scene) {
  scene.frame_seconds.clear();
  scene.each.clear();
  scene.ways.reset();
  scene.pictures.clear();
  scene.coverage.reset();
  scene.shards.clear();
  Json j = to_json(scene);
  j.erase("verdicts");
  return j;
}

/// The page's data, part by part.
class Data {
 public:
  Data(fs::path page, const TempFiles& files, const RunRecord& record)
      : page_(std::move(page)), files_(files), record_(record) {}

  void scene(const SceneRecord& s) {
    const std::size_t number = scenes_.size();
    scenes_.push_back(listed(s));
    names_ += (names_.empty() ? "" : ", ") + s.scene;
    for (const ShardRecord& shard : s.shards) part(number, shard, &shard);
    if (!s.joined) part(number, s, nullptr);
    frames(number, s);
  }

  /// All of it, with what the whole record says.
  Json finish() {
    const TotalsRecord totals = record_.totals();
    const auto& regress = record_.regress;
    Json j;
    j["same"] = totals.same;
    j["command"] = record_.merged ? "kage merge" : regress ? "kage regress" : "kage cosim";
    j["name"] = names_;
    j["headline"] = fmt::format("{}{}, {} of {}{}{}, {} compared", regress ? regress->ended() : "",
                                regress ? counted(record_.scenes.size(), "run") : counted(scenes_.size(), "scene"),
                                counted(totals.frames, "frame"), totals.total_frames,
                                record_.merged ? " in " + counted(parts_.size(), "shard") : "",
                                cosim::taken_text(totals.taken), counted(totals.pixels_compared, "pixel"));
    j["seed"] = regress ? regress->seed : record_.any().seed;
    j["scenes"] = std::move(scenes_);
    j["parts"] = Json::array();
    for (auto& [index, p] : parts_) {
      if (regress) p["again"] = regress->again;
      j["parts"].push_back(std::move(p));
    }
    j["frames"] = std::move(frames_);
    j["left_out"] = left_out_;
    j["meanings"] = meanings();
    return j;
  }

 private:
  /// The part of the scene that a shard, or the run, has.
  void part(std::size_t scene, const PartRecord& r, const ShardRecord* shard) {
    const int index = shard != nullptr ? shard->number.index : 1;
    Json& p = parts_[index];
    if (p.is_null())
      p = {{"index", index},
           {"name", shard != nullptr ? fmt::format("Shard {}/{}", index, shard->number.count) : "The run"},
           {"same", true},
           {"file", shard != nullptr ? Json(shard->file) : Json(nullptr)},
           {"again", r.again},
           {"folder", r.folder},
           {"rtl", r.rtl},
           {"versions", r.versions},
           {"golden_seconds", 0.0},
           {"rtl_seconds", 0.0},
           {"runs", Json::array()}};
    p["same"] = p["same"].get<bool>() && r.same;
    p["golden_seconds"] = p["golden_seconds"].get<double>() + r.golden_seconds;
    p["rtl_seconds"] = p["rtl_seconds"].get<double>() + r.rtl_seconds;
    const auto& d = r.first_difference;
    const bool shown = d && d->waveform && d->divergence && d->divergence->save_file;
    p["runs"].push_back({{"scene", scene},
                         {"same", r.same},
                         {"frames", r.frames},
                         {"page", link(r, shard != nullptr ? shard->file : "")},
                         {"difference", to_json(d)},
                         {"gtkwave", shown ? Json(cosim::gtkwave_line(*d->divergence->save_file)) : Json(nullptr)}});
  }

  Json link(const PartRecord& part, const std::string& file) const {
    const fs::path found = page_of(part, file, files_);
    if (found.empty()) return nullptr;
    std::error_code error;
    const fs::path folder = page_.parent_path().empty() ? "." : page_.parent_path();
    const fs::path relative = fs::relative(found, folder, error);
    return error || relative.empty() ? Json(nullptr) : Json(address(relative));
  }

  /// A row for each frame: those behind a difference were not compared. Frames without stored numbers get no row.
  void frames(std::size_t scene, const SceneRecord& s) {
    if (s.each.empty()) return;
    struct Owner {
      int index;
      int frames;
    };
    std::map<int, const FrameRecord*> known;
    std::map<int, Owner> owners;  // by their first frame
    for (const FrameRecord& frame : s.each) known[frame.frame] = &frame;
    for (const ShardRecord& p : s.shards) owners[p.first_frame] = {p.number.index, p.frames};
    if (!s.joined) owners[s.first_frame] = {1, s.frames};
    const std::set<int> taken(s.verdicts.taken_frames.begin(), s.verdicts.taken_frames.end());
    const int step = s.joined ? s.shards.front().frame_step : s.frame_step;
    for (int n = 0; n < s.total_frames; ++n) {
      const auto owner = owners.find(n % step);
      if (owner == owners.end()) continue;  // of a shard that is not told of
      const auto found = known.find(n);
      const bool is_known = found != known.end();
      const bool differs = is_known && !found->second->same;
      if (!differs && frames_.size() >= kListedFrames) {
        ++left_out_;
        continue;
      }
      Json row = is_known ? to_json(*found->second) : Json{{"frame", n}};
      row["scene"] = scene;
      row["part"] = owner->second.index;
      row["taken"] = taken.count(n) != 0;
      row["same"] = n / step < owner->second.frames ? Json(!differs) : Json(nullptr);
      frames_.push_back(std::move(row));
    }
  }

  fs::path page_;
  const TempFiles& files_;
  const RunRecord& record_;
  std::vector<Json> scenes_;
  std::string names_;
  std::map<int, Json> parts_;
  std::vector<Json> frames_;
  std::uint64_t left_out_ = 0;
};

}  // namespace

void keep_page(const fs::path& path, const std::string& file, const RunRecord& record) {
  const auto keep = [&](const std::optional<std::string>& named, const std::string& folder) {
    if (!named) return;
    for (const fs::path& place : places_of(*named, file, folder)) {
      std::error_code error;
      if (fs::equivalent(place, path, error))
        throw Error(fmt::format("{}: is the page of {}: it is not written over", path.string(), file));
    }
  };
  for (const SceneRecord& scene : record.scenes) {
    if (scene.frames == 0) continue;
    keep(scene.page, scene.folder);
    keep(record.page, scene.folder);
  }
}

void write_joined_page(TempFiles& files, const fs::path& path, const RunRecord& record,
                       const std::function<void()>& wait) {
  Data data(path, files, record);
  const std::size_t count = record.scenes.size();
  const bool all = !record.regress || count <= kListedRuns;
  for (std::size_t i = 0; i < count; ++i) {
    wait();
    const bool wanted = all || i + 1 < kListedRuns || i + 1 == count;
    if (wanted && record.scenes[i].frames != 0) data.scene(record.scenes[i]);
  }
  const Json j = data.finish();
  const std::string plain = (j["same"].get<bool>() ? "same: " : "different: ") + j["headline"].get<std::string>();
  const Html html(plain + " - " + j["name"].get<std::string>(), plain, "joined", {"parts", "joined"});
  const std::string text = script_text(j);
  if (html.bytes() + text.size() > kPageBytes)
    throw Error(fmt::format("{}: would have {} bytes, and a page has {} at most: join fewer scenes", path.string(),
                            html.bytes() + text.size(), kPageBytes));
  TempFiles own;  // half a page is not to be among the others
  OutputFile out(own, path);
  html.write(out, [&](std::ostream& to) { to << text; });
  out.close();
  files.take(own);
}

}  // namespace kage::report
