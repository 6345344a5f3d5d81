// SPDX-License-Identifier: Apache-2.0
//
// A campaign: cases of many families for some time, each family with its share of it, on several threads.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "extremes/family.hpp"

namespace kage::verif {

struct CampaignOptions {
  std::vector<const Family*> families;
  std::uint64_t seed = 1;
  double seconds = 0;           ///< for all families together
  std::uint64_t starts = 0;     ///< of each family, instead of a time; 0: by time
  int jobs = 2;                 ///< threads
  double shrink_seconds = 60;   ///< at most, of each failure
  std::filesystem::path found;  ///< where failures are kept
  Context context;
  std::function<bool()> stop;                                              ///< whether somebody wants it to end
  std::function<void(double done, const struct CampaignState&)> progress;  ///< called now and then
};

/// Results of a family.
struct FamilyResult {
  const Family* family = nullptr;
  std::uint64_t starts = 0;  ///< that were run to their ends, or to a failure
  std::uint64_t cases = 0;
  Outcome sum;
  double seconds = 0;          ///< of threads
  std::string nearest_case;    ///< the name of the start that came nearest to the bound
  std::string nearest;         ///< that case's text
  std::string failed_case;     ///< the name of the start that failed
  std::filesystem::path kept;  ///< where the failing case is

  [[nodiscard]] bool failed() const { return !sum.wrong.empty(); }
  [[nodiscard]] bool without_case() const { return !failed() && cases == 0; }
};

struct CampaignState {
  std::vector<FamilyResult> families;
  double seconds = 0;  ///< by the clock

  [[nodiscard]] std::uint64_t pixels() const;
  [[nodiscard]] std::size_t failed() const;
  /// Families of which no case was run: they neither hold nor fail.
  [[nodiscard]] std::size_t without_case() const;
  [[nodiscard]] std::size_t holding() const { return families.size() - failed() - without_case(); }
};

/// The name of a start, by which --case runs it again: FAMILY:SEED:INDEX.
std::string case_name(const Family& family, std::uint64_t seed, std::uint64_t index);

/// Name of the case that this thread is checking, for a message where the process ends within it.
const char* case_at_hand();
void set_case_at_hand(const std::string& name);

CampaignState run_campaign(const CampaignOptions& options);

}  // namespace kage::verif
