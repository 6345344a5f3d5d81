// SPDX-License-Identifier: Apache-2.0
#include "joined.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "ci.hpp"
#include "cosim/recall.hpp"
#include "cosim/report/html.hpp"
#include "kage/error.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "text.hpp"

namespace kage::cli {
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

/// Where a page may be that was written as `named` in `folder`, and of which `file` tells: beside that, whatever
/// folders of the name were left behind when both were moved, or where it was written.
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

/// Where the page of a run is, or is to be with the others of `files`; or "". `part` is its report, or what kage merge
/// keeps of it.
fs::path page_of(const Json& part, const TempFiles& files) {
  if (part["report"].is_null() || part["report_crc32"].is_null()) return {};
  const std::string file = part.contains("file") ? part["file"].get<std::string>() : "";
  for (const fs::path& place : places_of(part["report"].get<std::string>(), file, part["folder"].get<std::string>())) {
    std::error_code error;
    const fs::path now = files.now(place);
    if (!fs::is_regular_file(now, error) || fs::file_size(now, error) > report::kPageBytes || error) continue;
    if (report::checksum(now) == part["report_crc32"].get<std::string>()) return place;
  }
  return {};
}

Json stalls_of(const Json& j) { return {j["stalled"]["input_starved"], j["stalled"]["output_blocked"]}; }

/// The page's data, part by part.
class Data {
 public:
  Data(fs::path page, const TempFiles& files) : page_(std::move(page)), files_(files) {}

  void scene(const Json& r) {
    const std::size_t number = scenes_.size();
    Json j;
    j["name"] = r["scene"];
    for (const char* key : {"same", "frames", "total_frames", "width", "height", "cycles", "spans", "span_pixels",
                            "segments", "config_name", "config", "seed", "degraded", "notes"})
      j[key] = r[key];
    j["stalls"] = stalls_of(r);
    scenes_.push_back(std::move(j));
    if (r.contains("shards"))
      for (const Json& shard : r["shards"]) part(number, shard);
    else
      part(number, r);
    frames(number, r);
  }

  /// All of it, with what the whole report says.
  Json finish(const Json& report) {
    Json j;
    j["same"] = report["same"];
    const bool regress = report.contains("runs");
    j["command"] = merged_ ? "kage merge" : regress ? "kage regress" : "kage cosim";
    std::string names;
    for (const Json& s : scenes_) names += (names.empty() ? "" : ", ") + s["name"].get<std::string>();
    j["name"] = names;
    j["headline"] = fmt::format(
        "{}{}, {} of {}{}{}, {} compared", report.value("interrupted", false) ? "interrupted after " : "",
        regress ? counted(report["runs"].get<std::uint64_t>(), "run") : counted(scenes_.size(), "scene"),
        counted(report["frames"].get<std::uint64_t>(), "frame"), report["total_frames"].get<std::uint64_t>(),
        merged_ ? " in " + counted(parts_.size(), "shard") : "", cosim::taken_text(taken_of(report)),
        counted(report["pixels_compared"].get<std::uint64_t>(), "pixel"));
    j["seed"] = report["seed"];
    j["scenes"] = std::move(scenes_);
    j["parts"] = Json::array();
    for (auto& [index, p] : parts_) {
      if (regress) p["again"] = report["again"];
      j["parts"].push_back(std::move(p));
    }
    j["frames"] = std::move(frames_);
    j["left_out"] = left_out_;
    j["meanings"] = report::meanings();
    return j;
  }

 private:
  /// What a shard, or the run, has of the scene.
  void part(std::size_t scene, const Json& r) {
    merged_ = r.contains("index");
    const int index = merged_ ? r["index"].get<int>() : 1;
    Json& p = parts_[index];
    if (p.is_null()) {
      p["index"] = index;
      p["name"] = merged_ ? fmt::format("Shard {}/{}", index, r["count"].get<int>()) : "The run";
      p["same"] = true;
      p["file"] = merged_ ? r["file"] : Json(nullptr);
      for (const char* key : {"again", "folder", "rtl", "versions"}) p[key] = r[key];
      p["golden_seconds"] = p["rtl_seconds"] = 0.0;
      p["runs"] = Json::array();
    }
    p["same"] = p["same"].get<bool>() && r["same"].get<bool>();
    for (const char* key : {"golden_seconds", "rtl_seconds"}) p[key] = p[key].get<double>() + r[key].get<double>();
    p["runs"].push_back({{"scene", scene},
                         {"same", r["same"]},
                         {"frames", r["frames"]},
                         {"page", link(r)},
                         {"difference", difference(r["first_difference"])}});
  }

  /// What is told of a difference.
  static Json difference(const Json& d) {
    if (d.is_null()) return nullptr;
    Json j{{"text", d["text"]}, {"frame", d["frame"]}, {"no_divergence", d["no_divergence"]}, {"divergence", nullptr}};
    const Json& by = d["divergence"];
    if (by.is_null()) return j;
    const bool shown = !d["waveform"].is_null() && by["save_file"].is_string();
    j["divergence"] = {{"text", by["text"]},
                       {"waits", by["waits"]},
                       {"gtkwave", shown ? Json(gtkwave_line(by["save_file"].get<std::string>())) : Json(nullptr)}};
    return j;
  }

  Json link(const Json& r) const {
    const fs::path found = page_of(r, files_);
    if (found.empty()) return nullptr;
    std::error_code error;
    const fs::path folder = page_.parent_path().empty() ? "." : page_.parent_path();
    const fs::path relative = fs::relative(found, folder, error);
    return error || relative.empty() ? Json(nullptr) : Json(address(relative));
  }

  /// A row for each frame: those behind a difference were not compared. What a long run keeps no numbers of has none.
  void frames(std::size_t scene, const Json& r) {
    if (r["each"].empty()) return;
    std::map<std::uint64_t, const Json*> known, parts;
    for (const Json& frame : r["each"]) known[frame["frame"].get<std::uint64_t>()] = &frame;
    if (r.contains("shards"))
      for (const Json& p : r["shards"]) parts[p["first_frame"].get<std::uint64_t>()] = &p;
    else
      parts[r["first_frame"].get<std::uint64_t>()] = &r;
    const std::set<std::uint64_t> taken = r["verdicts"]["taken_frames"];
    const auto step = parts.begin()->second->at("frame_step").get<std::uint64_t>();
    for (std::uint64_t n = 0; n < r["total_frames"].get<std::uint64_t>(); ++n) {
      const auto owner = parts.find(n % step);
      if (owner == parts.end()) continue;  // of a shard that is not told of
      const Json& p = *owner->second;
      const auto found = known.find(n);
      const bool is_known = found != known.end();
      const bool differs = is_known && !found->second->at("same").get<bool>();
      if (!differs && frames_.size() >= kListedFrames) {
        ++left_out_;
        continue;
      }
      Json row{{"scene", scene}, {"frame", n}, {"part", p.contains("index") ? p["index"].get<int>() : 1}};
      row["taken"] = taken.count(n) != 0;
      row["same"] = n / step < p["frames"].get<std::uint64_t>() ? Json(!differs) : Json(nullptr);
      if (is_known) {
        row["stalls"] = stalls_of(*found->second);
        for (const char* key : {"cycles", "spans", "span_pixels", "segments", "words"})
          row[key] = found->second->at(key);
      }
      frames_.push_back(std::move(row));
    }
  }

  fs::path page_;
  const TempFiles& files_;
  bool merged_ = false;  // of shards
  std::vector<Json> scenes_;
  std::map<int, Json> parts_;
  std::vector<Json> frames_;
  std::uint64_t left_out_ = 0;
};

}  // namespace

void keep_page(const fs::path& path, const std::string& file, const Json& report) {
  const auto keep = [&](const Json& named, const Json& folder) {
    if (!named.is_string() || !folder.is_string()) return;
    for (const fs::path& place : places_of(named.get<std::string>(), file, folder.get<std::string>())) {
      std::error_code error;
      if (fs::equivalent(place, path, error))
        throw Error(fmt::format("{}: is the page of {}: it is not written over", path.string(), file));
    }
  };
  if (!report.contains("scenes")) return keep(report["report"], report["folder"]);
  for (const Json& scene : report["scenes"]) {
    if (!has_frames(scene)) continue;
    keep(scene["report"], scene["folder"]);
    if (report.contains("report")) keep(report["report"], scene["folder"]);
  }
}

void write_joined_page(TempFiles& files, const fs::path& path, const Json& report, bool interruptible) {
  Data data(path, files);
  const Json whole = Json::array({report});
  for (const Json& scene : report.contains("scenes") ? report["scenes"] : whole) {
    if (interruptible) check_interrupt();
    if (has_frames(scene)) data.scene(scene);
  }
  const Json j = data.finish(report);
  const std::string plain = (j["same"].get<bool>() ? "same: " : "different: ") + j["headline"].get<std::string>();
  const report::Html html(plain + " - " + j["name"].get<std::string>(), plain, "joined", {"parts", "joined"});
  const std::string text = report::script_text(j);
  if (html.bytes() + text.size() > report::kPageBytes)
    throw Error(fmt::format("{}: would have {} bytes, and a page has {} at most: join fewer scenes", path.string(),
                            html.bytes() + text.size(), report::kPageBytes));
  TempFiles own;  // half a page is not to be among the others
  OutputFile out(own, path);
  html.write(out, [&](std::ostream& to) { to << text; });
  out.close();
  files.take(own);
}

}  // namespace kage::cli
