// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/page.hpp"

#include <fmt/format.h>

#include <limits>
#include <set>

#include "cosim/recall.hpp"
#include "cosim/report/html.hpp"
#include "file/read_file.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"

namespace kage::report {
namespace {

namespace fs = std::filesystem;

/// The pictures that the page holds: as many as there is room for.
class Pictures {
 public:
  /// `made`: those that have no names yet, or nullptr.
  explicit Pictures(const TempFiles* made) : made_(made) {}

  /// null for no picture; else {name, data}: data is its place in the list, null where it does not fit.
  Json add(const std::string& path) {
    if (path.empty()) return nullptr;
    Json j;
    j["name"] = fs::path(path).filename().string();
    j["data"] = nullptr;
    std::error_code error;
    fs::path now = made_ != nullptr ? made_->now(path) : fs::path(path);
    const auto size = fs::file_size(now, error);
    if (error || fs::path(path).extension() != ".png" || bytes_ + size / 3 * 4 + 8 > kPictureBytes) return j;
    bytes_ += size / 3 * 4 + 8;
    j["data"] = paths_.size();
    paths_.push_back(std::move(now));
    return j;
  }

  /// Bytes that the pictures take at most.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

  /// The list, one picture in memory at a time.
  void write(std::ostream& out) const {
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      const std::string file = read_file(paths_[i]);
      out << (i == 0 ? "\"" : ",\"") << base64({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()})
          << '"';
    }
  }

 private:
  const TempFiles* made_;
  std::size_t bytes_ = 0;
  std::vector<fs::path> paths_;
};

/// The pictures of the different frame: NAME_0000_actual.png and _difference.png.
std::string picture_that_ends(const cosim::Report& run, std::string_view end) {
  for (const std::string& p : run.pictures)
    if (p.ends_with(end)) return p;
  return {};
}

Json phases_of(const PhaseSums& sums) {
  Json j = Json::array();
  for (const auto& s : sums.of) j.push_back({s.tokens, s.pixels, s.clocks});
  return j;
}

/// Each frame's record, with what this page has of it besides.
Json frames_of(const Page& page, Pictures& pictures) {
  const cosim::Report& run = *page.run;
  // The frame that differs is the last, and its pictures matter most.
  std::vector<Json> frames(run.each.size());
  for (std::size_t k = run.each.size(); k-- > 0;) {
    const cosim::FrameResult& r = run.each[k];
    const bool different = run.first_difference && run.first_difference->frame == r.frame;
    const int number = r.frame;
    Json& j = frames[k];
    j = to_json(page.record.each[k]);
    j["width"] = r.status.width;
    j["height"] = r.status.height;
    j["error"] = r.status.error == ErrorCode::NONE
                     ? Json(nullptr)
                     : Json{{"text", describe(r.status)}, {"line", r.status.line}, {"token", r.status.token}};
    for (const TokenStore* store : {page.tokens, different ? page.wanted : nullptr}) {
      if (store == nullptr || static_cast<std::size_t>(number) >= store->frames().size()) continue;
      const FrameTokens& t = store->frames()[static_cast<std::size_t>(number)];
      j["tokens"] = t.tokens;
      j["background"] = t.background;
      j["phases"] = phases_of(t.phases);
      j["video"] = t.phases.video;
      j["designed"] = t.phases.clocks();
    }
    j["golden"] = pictures.add(r.picture);
    j["rtl"] = different ? pictures.add(picture_that_ends(run, "_actual.png")) : Json(nullptr);
    j["difference"] = different ? pictures.add(picture_that_ends(run, "_difference.png")) : Json(nullptr);
    j["missing"] = different ? run.missing_pixels : 0;
  }
  Json j = Json::array();
  for (Json& f : frames) j.push_back(std::move(f));
  return j;
}

/// The list of bands that fit into `room` bytes: those of the different frame first, one in memory at a time.
void write_bands(std::ostream& out, const Page& page, std::size_t room) {
  std::set<std::pair<int, int>> there;
  // After a difference some of the frames behind it may have been made already.
  const auto& d = page.run->first_difference;
  const int last = d && d->frame != cosim::kBehindFrames ? d->frame : std::numeric_limits<int>::max();
  for (const TokenStore* store : {page.wanted, page.tokens}) {
    if (store == nullptr) continue;
    for (const Band& b : store->bands()) {
      if (b.frame > last || there.count({b.frame, b.line}) != 0) continue;
      const std::string text = fmt::format("{}[{},{},{},{},\"{}\"{}]", there.empty() ? "" : ",", b.frame, b.line,
                                           b.token, b.ahead, store->text(b), b.indexed ? ",true" : "");
      if (text.size() > room) return;
      room -= text.size();
      there.insert({b.frame, b.line});
      out << text;
    }
  }
}

Json left_out_of(const ToldPixel& p) {
  Json all = Json::array();
  for (const LeftOut& l : p.left_out) all.push_back(l.text());
  return all;
}

Json told_of(const Page& page) {
  Json told = Json::array();
  std::size_t bytes = 0;
  for (const ToldPixel& p : page.told) {
    Json touches = Json::array();
    for (const PixelTouch& t : p.history.touches) {
      Json j{{"token", t.token}, {"nth", t.nth}, {"text", t.text}, {"effect", t.effect}};
      if (t.what.kind == Kind::TREE) j["tree"] = describe_tree(page.record.config, p.history);
      if (const auto from = p.from.find(t.nth); from != p.from.end()) j["from"] = from->second;
      if (!(t.before == t.after)) j["now"] = describe(page.record.config, t.after);
      touches.push_back(std::move(j));
    }
    Json rtl = Json::array();
    for (const cosim::RtlTouch& t : p.rtl) {
      Json values = Json::array();
      for (const cosim::RtlTouch::Value& v : t.values) values.push_back({{"text", v.text}, {"golden", v.golden}});
      rtl.push_back({{"token", t.token},
                     {"nth", t.nth},
                     {"stage", cosim::describe(t.stage)},
                     {"state", t.stage == cosim::Stage::pixel},
                     {"load", t.load},
                     {"cycle", t.cycle},
                     {"same", t.same},
                     {"values", std::move(values)}});
    }
    Json j{{"frame", p.frame},
           {"x", p.history.x},
           {"y", p.history.y},
           {"touches", std::move(touches)},
           {"color_text", p.history.color_text},
           {"left_out", left_out_of(p)},
           {"rtl", std::move(rtl)}};
    bytes += script_text(j).size();
    if (bytes > kToldBytes) break;
    told.push_back(std::move(j));
  }
  return told;
}

std::string headline(const Page& page) {
  const cosim::Report& r = *page.run;
  return fmt::format("{}: {}{}{}, {}x{}, {} compared{}", r.same ? "same" : "different", counted(r.frames, "frame"),
                     page.polygons ? " at the polygon level" : "", cosim::taken_text(r.taken.size()), r.width, r.height,
                     counted(r.pixels_compared, "pixel"), page.rtl_options.empty() ? "" : ", with " + page.rtl_options);
}

/// The run's record, without what is listed by frame, and what this page has besides.
Json data_of(const Page& page, Pictures& pictures) {
  const cosim::Report& run = *page.run;
  SceneRecord record = page.record;
  record.each.clear();
  record.frame_seconds.clear();
  record.coverage.reset();
  Json j;
  j["run"] = to_json(record);
  j["run"].erase("verdicts");
  j["headline"] = headline(page);
  j["gtkwave"] = page.gtkwave;
  j["different_pixels"] = nullptr;
  if (run.difference) {
    j["different_pixels"] = run.difference->different_pixels;
    j["region_count"] = run.difference->region_count;
  }
  j["frames"] = frames_of(page, pictures);
  j["told"] = told_of(page);
  j["phase_names"] = kPhaseNames;
  j["phase_tokens"] = kPhaseTokens;
  j["meanings"] = meanings();
  j["explain"] = page.explain;
  j["explain_rtl"] = page.explain_rtl;
  j["band_lines"] = kBandLines;
  return j;
}

}  // namespace

void write_page(TempFiles& files, const fs::path& path, const Page& page) {
  const Html html(headline(page) + " - " + page.record.scene, headline(page), "run",
                  {"parts", "stream", "explain", "view", "page"});
  Pictures pictures(page.made);
  std::string data = script_text(data_of(page, pictures));
  data.pop_back();  // the brace: two lists follow
  OutputFile out(files, path);
  html.write(out, [&](std::ostream& to) {
    to << data << ",\"pictures\":[";
    pictures.write(to);
    to << "],\"bands\":[";
    constexpr std::size_t kRest = 64;  // the brackets
    const std::size_t taken = html.bytes() + data.size() + pictures.bytes() + kRest;
    // Tokens get the room that is left.
    write_bands(to, page, taken < kPageBytes ? kPageBytes - taken : 0);
    to << "]}";
  });
  out.close();
}

}  // namespace kage::report
