// SPDX-License-Identifier: Apache-2.0
//
// Files that a sweep leaves in a folder: plots of error against cost as SVG and PNG, the picture of each row, and the
// page that shows all of it (docs/sweep.md, "Page and plots").
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cosim/report/html.hpp"
#include "explore/plot/pareto_plot.hpp"
#include "explore/sweep_points.hpp"
#include "explore/sweep_scene.hpp"
#include "file/temp_file.hpp"

namespace kage::explore {

/// A row with what it was measured on.
struct PageRow {
  nlohmann::ordered_json row;  ///< as docs/schema/sweep.json has it
  const SweepPoint* point = nullptr;
  SweepScene* scene = nullptr;
  std::string command;  ///< that draws its pictures, with the row's parameters in kPageConfig
};
/// Name under which a reader keeps the parameters that the page gives.
inline constexpr const char* kPageConfig = "chosen.yaml";

/// A plot of some rows of one scene and size.
struct SweepPlot {
  std::string kind;  ///< as file names have it: "wrong_luts"
  std::string tab;   ///< what it shows, in a few words
  plot::ParetoPlot plot;
};
/// The plots of rows of one scene and size, which are members `members` of `rows`.
std::vector<SweepPlot> plots_of(const std::vector<PageRow>& rows, const std::vector<std::size_t>& members);

/// Name of a row: its axis and value.
std::string name_of(const nlohmann::ordered_json& row);

struct SweepPage {
  std::vector<PageRow> rows;                    ///< one at least
  std::string command;                          ///< the command line that makes the same page of the store
  std::string store;                            ///< the store's file
  std::size_t most_bytes = report::kPageBytes;  ///< of kPageName
  /// Called before what takes long, with what it is; what it throws ends the work.
  std::function<void(const std::string&)> doing;
};

/// Its name in the folder, and that of the folder of pictures in it.
inline constexpr const char* kPageName = "sweep.html";
inline constexpr const char* kPicturesFolder = "pictures";

/// Writes all of it to `folder`, in which there is a folder kPicturesFolder. Files get their names with the others of
/// `files`; pictures there of an earlier page go. Where the page would have more than `most_bytes`, it has pictures of
/// the first frame alone, and if that is too much, fewer rows, and says so. Throws Error that names a file.
void write_sweep_page(TempFiles& files, const std::filesystem::path& folder, const SweepPage& page);

}  // namespace kage::explore
