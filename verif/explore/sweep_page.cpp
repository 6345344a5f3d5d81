// SPDX-License-Identifier: Apache-2.0
#include "explore/sweep_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "cosim/model/sha256.hpp"
#include "cosim/report/html.hpp"
#include "explore/sweep_accuracy.hpp"
#include "explore/sweep_run.hpp"
#include "image/save.hpp"
#include "json/json_text.hpp"
#include "kage/pipeline.hpp"
#include "number/counted.hpp"

namespace kage::explore {
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

  /// Removes, with the others' coming, the pictures that an earlier page had and this one has not.
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

Json picture_json(int frame, const std::string& picture, const Json& map, const PictureError& wrong) {
  return {{"frame", frame},
          {"picture", picture},
          {"map", map},
          {"visible_wrong", wrong.visible_wrong},
          {"shadow_wrong", wrong.shadow_wrong},
          {"gross_wrong", wrong.gross_wrong},
          {"color_wrong", wrong.color_wrong}};
}

/// The pictures of a row and what is wrong in them, by frames, the first so many.
Json pictures_of(const PageRow& r, int frames, Pictures& pictures) {
  Json out = Json::array();
  for (int i = 0; i < frames; ++i) {
    const DrawnFrame drawn = draw(r.scene->frame(i), r.point->config, r.scene->draw_options(*r.point));
    const ErrorMap map = error_map(*r.scene, i, *r.point, drawn);
    const PictureError wrong = sum_of(map);
    out.push_back(picture_json(i, pictures.add(image_of(drawn)),
                               wrong.any() ? Json(pictures.add(picture_of(map, drawn))) : Json(nullptr), wrong));
  }
  return out;
}

/// As much text as that may be at most, without a picture being drawn.
Json pictures_to_come(const PageRow& r, int frames) {
  const std::string name = std::string(kPicturesFolder) + "/" + std::string(kHashDigits, '0') + ".png";
  const auto pixels = static_cast<std::uint64_t>(r.point->width) * static_cast<std::uint64_t>(r.point->height);
  PictureError most;
  most.visible_wrong = most.shadow_wrong = most.gross_wrong = most.color_wrong = pixels;
  Json out = Json::array();
  for (int i = 0; i < frames; ++i) out.push_back(picture_json(i, name, name, most));
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

/// Start of a group's file names: the scene's name without folders and ending, and the size; each start only once.
std::string stem_of(const Json& row, std::set<std::string>& taken) {
  std::string stem = fs::path(row.at("scene").get<std::string>()).stem().string();
  for (char& c : stem)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '.') c = '_';
  stem += fmt::format("_{}x{}", json_text(row.at("look").at("width")), json_text(row.at("look").at("height")));
  std::string out = stem;
  for (int n = 2; !taken.insert(out).second; ++n) out = fmt::format("{}_{}", stem, n);
  return out;
}

using Stems = std::map<std::string, std::string>;

/// Start of the file names of each group.
Stems stems_of(const std::vector<PageRow>& rows) {
  std::set<std::string> taken;
  Stems out;
  for (const PageRow& r : rows)
    if (const std::string group = group_of(r.row); out.count(group) == 0) out[group] = stem_of(r.row, taken);
  return out;
}

std::string file_of(const Stems& stems, const Json& row, const SweepPlot& plot) {
  return fmt::format("{}_{}", stems.at(group_of(row)), plot.kind);
}

/// Plots of rows, if there is something to choose among them.
std::vector<SweepPlot> plots_to_choose_in(const std::vector<PageRow>& rows, const std::vector<std::size_t>& members) {
  return members.size() < 2 ? std::vector<SweepPlot>() : plots_of(rows, members);
}

void write_plots(TempFiles& files, const fs::path& folder, const SweepPage& page, const Stems& stems) {
  for (const std::vector<std::size_t>& members : groups_of(page.rows))
    for (const SweepPlot& p : plots_to_choose_in(page.rows, members)) {
      const std::string name = file_of(stems, page.rows[members.front()].row, p);
      page.doing("drawing " + name);
      const plot::Drawing wide = plot::draw(p.plot, plot::kWidePlot);
      write_text(files, (folder / (name + ".svg")).string(), plot::to_svg(wide));
      save_image(files, folder / (name + ".png"), plot::to_image(wide, kPlotScale));
    }
}

/// Rows of a sweep that the page shows.
struct Shown {
  std::vector<PageRow> rows;
  int frames = 0;        ///< of each row, of which it has pictures
  std::string left_out;  ///< what it lacks and why, as a sentence; empty: nothing
};

int frames_of(const Shown& shown, const PageRow& row) { return std::min(shown.frames, row.scene->frames()); }

Json groups_json(const Shown& shown, const Stems& stems) {
  Json out = Json::array();
  for (const std::vector<std::size_t>& members : groups_of(shown.rows)) {
    const Json& first = shown.rows[members.front()].row;
    Json plots = Json::array();
    for (const SweepPlot& p : plots_to_choose_in(shown.rows, members))
      plots.push_back({{"tab", p.tab},
                       {"title", p.plot.title},
                       {"file", file_of(stems, first, p)},
                       {"wide", plot::to_svg(plot::draw(p.plot, plot::kWidePlot))},
                       {"narrow", plot::to_svg(plot::draw(p.plot, plot::kNarrowPlot))}});
    out.push_back({{"scene", first.at("scene")},
                   {"width", first.at("look").at("width")},
                   {"height", first.at("look").at("height")},
                   {"rows", members},
                   {"plots", std::move(plots)}});
  }
  return out;
}

/// The page's data, but for the pictures, whose places it has.
Json data_of(const SweepPage& page, const Shown& shown, const Stems& stems, const std::string& headline) {
  page.doing("laying out the page");
  Json data;
  data["command"] = page.command;
  data["again"] = fmt::format("Of the rows in {}, without measuring anew:", page.store);
  data["left_out"] = shown.left_out;
  data["config_file"] = kPageConfig;
  data["meanings"] = report::meanings();
  data["map_colors"] = {{"face", css(kFaceColor)},
                        {"shadow", css(shadow_color(1))},
                        {"color", css(color_color(255))},
                        {"gross", css(kGrossColor)}};
  data["rows"] = Json::array();
  data["more"] = Json::array();
  for (const PageRow& r : shown.rows) {
    data["rows"].push_back(r.row);
    data["more"].push_back({{"name", name_of(r.row)},
                            {"yaml", to_yaml(r.point->config)},
                            {"command", r.command},
                            {"pictures", pictures_to_come(r, frames_of(shown, r))}});
  }
  data["groups"] = groups_json(shown, stems);
  data["headline"] = headline;
  return data;
}

/// The rows' numbers: first the base, then rows that no other beats, then the others, which are left out first.
std::vector<std::size_t> by_worth(const std::vector<PageRow>& rows) {
  std::vector<std::size_t> out(rows.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  const auto worth = [&](std::size_t i) {
    return rows[i].row.at("axis") == "base" ? 0 : rows[i].row.at("pareto").get<bool>() ? 1 : 2;
  };
  std::stable_sort(out.begin(), out.end(), [&](std::size_t a, std::size_t b) { return worth(a) < worth(b); });
  return out;
}

/// As much of a sweep as `most` bytes of data hold, and these data.
std::pair<Shown, Json> fitted(const SweepPage& page, const Stems& stems, const std::string& headline,
                              std::size_t most) {
  const double megabytes = static_cast<double>(page.most_bytes) / 1e6;
  const auto fits = [&](const Json& data) { return report::script_text(data).size() <= most; };
  Shown shown{page.rows, 0, {}};
  for (const PageRow& r : page.rows) shown.frames = std::max(shown.frames, r.scene->frames());
  Json data = data_of(page, shown, stems, headline);
  if (fits(data)) return {std::move(shown), std::move(data)};
  shown.frames = 1;
  shown.left_out =
      fmt::format("Pictures are those of the first frame, because the page is held to {:g} MB.", megabytes);
  data = data_of(page, shown, stems, headline);
  if (fits(data)) return {std::move(shown), std::move(data)};
  const std::vector<std::size_t> order = by_worth(page.rows);
  std::size_t least = 0;
  std::size_t beyond = order.size();
  const auto take = [&](std::size_t count) {
    std::vector<std::size_t> chosen(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(chosen.begin(), chosen.end());
    Shown part{{}, 1, {}};
    for (const std::size_t i : chosen) part.rows.push_back(page.rows[i]);
    part.left_out = fmt::format(
        "Shown are {} of {}, first those that no other beats, with pictures of the first frame, because the page is "
        "held "
        "to {:g} MB. --json and --csv have all.",
        count, counted(page.rows.size(), "configuration"), megabytes);
    return part;
  };
  shown = take(least);
  data = data_of(page, shown, stems, headline);
  while (beyond - least > 1) {
    const std::size_t middle = least + (beyond - least) / 2;
    Shown part = take(middle);
    Json of_part = data_of(page, part, stems, headline);
    if (fits(of_part)) {
      least = middle;
      shown = std::move(part);
      data = std::move(of_part);
    } else {
      beyond = middle;
    }
  }
  return {std::move(shown), std::move(data)};
}

}  // namespace

void write_sweep_page(TempFiles& files, const fs::path& folder, const SweepPage& page) {
  std::set<std::string> scenes;
  for (const PageRow& r : page.rows) scenes.insert(r.row.at("scene").get<std::string>());
  const std::string headline = fmt::format("{} of {}", counted(page.rows.size(), "configuration"),
                                           scenes.size() == 1 ? *scenes.begin() : counted(scenes.size(), "scene"));
  const report::Html html(headline + " - kage sweep", headline, "sweep", {"parts", "choose", "plot", "sweep"},
                          {.folder = "verif/explore/page", .style = "sweep", .pictures_beside = true});
  const Stems stems = stems_of(page.rows);
  write_plots(files, folder, page, stems);
  // Names of their own: C++20 as clang 14 has it takes no structured binding into a lambda.
  auto fit = fitted(page, stems, headline, page.most_bytes - std::min(page.most_bytes, html.bytes()));
  const Shown& shown = fit.first;
  Json& data = fit.second;
  Pictures pictures(files, folder);
  for (std::size_t i = 0; i < shown.rows.size(); ++i) {
    page.doing(fmt::format("drawing the pictures of row {} of {}", i + 1, shown.rows.size()));
    data["more"][i]["pictures"] = pictures_of(shown.rows[i], frames_of(shown, shown.rows[i]), pictures);
  }
  OutputFile out(files, folder / kPageName);
  html.write(out, [&](std::ostream& to) { to << report::script_text(data); });
  out.close();
  pictures.remove_old();  // behind the page, so that at any time the page that is there has its pictures
}

}  // namespace kage::explore
