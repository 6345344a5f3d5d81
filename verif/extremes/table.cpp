// SPDX-License-Identifier: Apache-2.0
#include "extremes/table.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "json/json_text.hpp"

namespace kage::verif {
namespace {

double per_hour(const CampaignState& state) {
  return state.seconds > 0 ? static_cast<double>(state.pixels()) / state.seconds * 3600 : 0;
}

// Cells of one row.
std::array<std::string, 9> cells(const FamilyResult& r) {
  const FamilyInfo& info = r.family->info();
  const Outcome& o = r.sum;
  const std::string what = info.what + (info.rtl ? " (RTL)" : "");
  const std::string verdict = r.failed() ? "FAILED" : r.without_case() ? "no case" : "holds";
  if (info.unit.empty())
    return {info.name, what,   std::to_string(r.cases), std::to_string(o.pixels), std::to_string(o.items), "exact", "",
            "",        verdict};
  return {info.name,
          what,
          std::to_string(r.cases),
          std::to_string(o.pixels),
          std::to_string(o.items),
          fmt::format("{:.4g}", o.worst),
          fmt::format("{:.4g} {}", o.bound, info.unit),
          fmt::format("{:.3f}", o.share()),
          verdict};
}

}  // namespace

std::string table_text(const CampaignState& state, int jobs) {
  std::vector<std::array<std::string, 9>> rows{
      {"family", "what", "cases", "pixels", "items", "worst", "bound", "worst / bound", "verdict"}};
  for (const FamilyResult& r : state.families) rows.push_back(cells(r));
  std::array<std::size_t, 9> widths{};
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    for (std::size_t i = 0; i < rows[n].size(); ++i)
      text += i < 2 || i == 8 ? fmt::format("| {:<{}} ", rows[n][i], widths[i])
                              : fmt::format("| {:>{}} ", rows[n][i], widths[i]);
    text += "|\n";
    if (n > 0) continue;
    for (const std::size_t w : widths) text += "|" + std::string(w + 2, '-');
    text += "|\n";
  }
  text +=
      fmt::format("\n{} of {} families hold{}; {} oracle-checked pixels in {:.0f} s on {} threads: {:.2e} an hour\n",
                  state.holding(), state.families.size(),
                  state.without_case() > 0 ? fmt::format(", {} had no case", state.without_case()) : "", state.pixels(),
                  state.seconds, jobs, per_hour(state));
  for (const FamilyResult& r : state.families) {
    if (!r.failed()) continue;
    text += fmt::format("\nfamily {}, case {}: {}\n", r.family->info().name,
                        r.failed_case.empty() ? "unknown" : r.failed_case, r.sum.wrong);
    if (!r.kept.empty()) text += fmt::format("shrunk, it is {}\n", r.kept.string());
  }
  return text;
}

std::string table_json(const CampaignState& state, const CampaignOptions& options) {
  nlohmann::ordered_json all;
  all["schema"] = "kage.extremes/1";
  all["seed"] = options.seed;
  all["threads"] = options.jobs;
  all["seconds"] = state.seconds;
  all["pixels"] = state.pixels();
  all["pixels_per_hour"] = per_hour(state);
  for (const FamilyResult& r : state.families) {
    const FamilyInfo& info = r.family->info();
    all["families"].push_back(
        {{"family", info.name},
         {"number", info.number},
         {"what", info.what},
         {"rtl", info.rtl},
         {"cases", r.cases},
         {"pixels", r.sum.pixels},
         {"items", r.sum.items},
         {"thread_seconds", r.seconds},
         {"unit", info.unit},
         {"worst", r.sum.worst},
         {"bound", r.sum.bound},
         {"share", r.sum.share()},
         {"nearest_case", r.nearest_case},
         {"nearest", r.nearest},
         {"holds", r.without_case() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(!r.failed())},
         {"wrong", r.sum.wrong},
         {"failed_case", r.failed_case},
         {"found", r.kept.string()}});
  }
  return json_text(all, 2) + "\n";
}

}  // namespace kage::verif
