// SPDX-License-Identifier: Apache-2.0
#include "trade/sweep_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include "cosim/model/sha256.hpp"
#include "cosim/report/html.hpp"
#include "image/save.hpp"
#include "kage/pipeline.hpp"
#include "number/counted.hpp"
#include "trade/sweep_accuracy.hpp"
#include "trade/sweep_run.hpp"

namespace kage::trade {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Pixels of a plot's PNG for a unit of its drawing: it is 1720 wide, and sharp on paper at 15 cm.
constexpr double kPlotScale = 2;

constexpr std::size_t kHashDigits = 16;

/// Files of pictures are called by what they show, so that rows with the same picture have one.
class Pictures {
 public:
  Pictures(TempFiles& files, fs::path folder) : files_(files), folder_(std::move(folder)) {}

  /// The file's name from the page.
  std::string add(const Image& image) {
    cosim::Sha256 hash;
    hash.add(fmt::format("{}x{}", image.width, image.height));
    hash.add_piece(std::span<const std::uint8_t>(image.data));
    std::string name = hash.take().substr(0, kHashDigits) + ".png";
    if (names_.insert(name).second) save_image(files_, folder_ / kPicturesFolder / name, image);
    return std::string(kPicturesFolder) + "/" + name;
  }

  /// Those that an earlier page had, and this one has not, go with the others' coming.
  void remove_old() {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / kPicturesFolder)) {
      const std::string name = entry.path().filename().string();
      if (is_ours(name) && names_.count(name) == 0) files_.remove(entry.path());
    }
  }

 private:
  static bool is_ours(const std::string& name) {
    return name.size() == kHashDigits + 4 && name.ends_with(".png") &&
           std::all_of(name.begin(), name.begin() + kHashDigits,
                       [](unsigned char c) { return std::isdigit(c) != 0 || (c >= 'a' && c <= 'f'); });
  }

  TempFiles& files_;
  fs::path folder_;
  std::set<std::string> names_;
};

std::string css(const std::array<std::uint8_t, 3>& color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
}

/// The pictures of a row and what is wrong in them, by frames.
Json pictures_of(const PageRow& r, Pictures& pictures) {
  Json out = Json::array();
  for (int i = 0; i < r.scene->frames(); ++i) {
    const DrawnFrame drawn = draw(r.scene->frame(i), r.point->config, r.scene->draw_options(*r.point));
    const ErrorMap map = error_map(*r.scene, i, *r.point, drawn);
    const PictureError wrong = sum_of(map);
    out.push_back({{"frame", i},
                   {"picture", pictures.add(image_of(drawn))},
                   {"map", wrong.any() ? Json(pictures.add(picture_of(map, drawn))) : Json(nullptr)},
                   {"visible_wrong", wrong.visible_wrong},
                   {"shadow_wrong", wrong.shadow_wrong},
                   {"gross_wrong", wrong.gross_wrong},
                   {"color_wrong", wrong.color_wrong}});
  }
  return out;
}

/// Rows of one scene and size, in the order of the first of each.
std::vector<std::vector<std::size_t>> groups_of(const std::vector<PageRow>& rows) {
  std::vector<std::vector<std::size_t>> out;
  std::map<std::string, std::size_t> at;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto [found, fresh] = at.emplace(group_of(rows[i].row), out.size());
    if (fresh) out.emplace_back();
    out[found->second].push_back(i);
  }
  return out;
}

/// What a group's files begin with: the scene's name without folders and ending, and the size; each only once.
std::string stem_of(const Json& row, std::set<std::string>& taken) {
  std::string stem = fs::path(row.at("scene").get<std::string>()).stem().string();
  for (char& c : stem)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '.') c = '_';
  stem += fmt::format("_{}x{}", row.at("look").at("width").dump(), row.at("look").at("height").dump());
  std::string out = stem;
  for (int n = 2; !taken.insert(out).second; ++n) out = fmt::format("{}_{}", stem, n);
  return out;
}

Json plots_json(TempFiles& files, const fs::path& folder, const SweepPage& page,
                const std::vector<std::size_t>& members, const std::string& stem) {
  Json out = Json::array();
  if (members.size() < 2) return out;  // nothing to choose from
  for (const SweepPlot& p : plots_of(page.rows, members)) {
    const std::string name = fmt::format("{}_{}", stem, p.kind);
    page.doing("drawing " + name);
    const plot::Drawing wide = plot::draw(p.plot, plot::kWidePlot);
    std::string svg = plot::to_svg(wide);
    write_text(files, (folder / (name + ".svg")).string(), svg);
    save_image(files, folder / (name + ".png"), plot::to_image(wide, kPlotScale));
    out.push_back({{"tab", p.tab},
                   {"title", p.plot.title},
                   {"file", name},
                   {"wide", std::move(svg)},
                   {"narrow", plot::to_svg(plot::draw(p.plot, plot::kNarrowPlot))}});
  }
  return out;
}

}  // namespace

void write_sweep_page(TempFiles& files, const fs::path& folder, const SweepPage& page) {
  Json data;
  data["command"] = page.command;
  data["config_file"] = kPageConfig;
  data["meanings"] = report::meanings();
  data["map_colors"] = {{"face", css(kFaceColor)},
                        {"shadow", css(shadow_color(1))},
                        {"color", css(color_color(255))},
                        {"gross", css(kGrossColor)}};
  data["rows"] = Json::array();
  data["more"] = Json::array();
  Pictures pictures(files, folder);
  for (std::size_t i = 0; i < page.rows.size(); ++i) {
    const PageRow& r = page.rows[i];
    page.doing(fmt::format("drawing the pictures of row {} of {}", i + 1, page.rows.size()));
    data["rows"].push_back(r.row);
    data["more"].push_back({{"name", name_of(r.row)},
                            {"yaml", to_yaml(r.point->config)},
                            {"command", r.command},
                            {"pictures", pictures_of(r, pictures)}});
  }
  data["groups"] = Json::array();
  std::set<std::string> stems;
  std::set<std::string> scenes;
  for (const std::vector<std::size_t>& members : groups_of(page.rows)) {
    const Json& first = page.rows[members.front()].row;
    scenes.insert(first.at("scene").get<std::string>());
    data["groups"].push_back({{"scene", first.at("scene")},
                              {"width", first.at("look").at("width")},
                              {"height", first.at("look").at("height")},
                              {"rows", members},
                              {"plots", plots_json(files, folder, page, members, stem_of(first, stems))}});
  }
  const std::string headline = fmt::format("{} of {}", counted(page.rows.size(), "configuration"),
                                           scenes.size() == 1 ? *scenes.begin() : counted(scenes.size(), "scene"));
  data["headline"] = headline;
  const report::Html html(headline + " - kage sweep", headline, "sweep", {"parts", "choose", "plot", "sweep"},
                          {.folder = "verif/trade/page", .style = "sweep", .pictures_beside = true});
  OutputFile out(files, folder / kPageName);
  html.write(out, [&](std::ostream& to) { to << report::script_text(data); });
  out.close();
  pictures.remove_old();  // behind the page, so that at any time the page that is there has its pictures
}

}  // namespace kage::trade
