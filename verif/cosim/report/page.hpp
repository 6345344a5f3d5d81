// SPDX-License-Identifier: Apache-2.0
//
// The report of a run: one HTML page that needs nothing else (docs/report.md).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cosim/diverge/divergence.hpp"
#include "cosim/report/html.hpp"
#include "cosim/report/run_record.hpp"
#include "cosim/report/token_store.hpp"
#include "cosim/run.hpp"
#include "file/temp_file.hpp"
#include "kage/explain.hpp"
#include "kage/provenance.hpp"

namespace kage::report {

/// Most bytes of pictures: those beyond it are named.
inline constexpr std::size_t kPictureBytes = 6'000'000;
/// Most bytes of the histories of told pixels: those beyond it are left out.
inline constexpr std::size_t kToldBytes = 500'000;

/// A pixel with its history, told by the golden model, and by the RTL where it was watched.
struct ToldPixel {
  int frame = 0;
  PixelHistory history;
  std::vector<cosim::RtlTouch> rtl;
  std::map<std::uint32_t, std::string> from;  ///< by PixelTouch::nth: which part of the scene it is of
  std::vector<LeftOut> left_out;              ///< tokens that --all-spans writes beside these
};

/// Contents of the report page. All text may be anything: it is escaped.
struct Page {
  SceneRecord record;  ///< of the run; its page is this one
  const cosim::Report* run = nullptr;
  const TempFiles* made = nullptr;  ///< the files of the run, where they have no names yet; or nullptr
  std::vector<ToldPixel> told;
  std::string gtkwave;      ///< the command line that shows the divergence's waveform
  std::string explain;      ///< that of kage explain, without --frame and --pixel
  std::string explain_rtl;  ///< what it ends with where the RTL is to be told too
  std::string rtl_options;  ///< --fault, --idle and --backpressure, as they were given; or ""
  bool polygons = false;    ///< the frames are at the polygon level
  const TokenStore* tokens = nullptr;
  const TokenStore* wanted = nullptr;  ///< of the different frame, to be there before all others; or nullptr
};

/// Writes the page, which gets its name with the others of `files`. Throws Error that names it.
void write_page(TempFiles& files, const std::filesystem::path& path, const Page& page);

}  // namespace kage::report
