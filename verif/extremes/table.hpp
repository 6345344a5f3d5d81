// SPDX-License-Identifier: Apache-2.0
//
// Results of a campaign: a table for people, JSON for programs.
#pragma once

#include <string>

#include "extremes/campaign.hpp"

namespace kage::verif {

/// A row per family, in Markdown, and the sum below it.
std::string table_text(const CampaignState& state, int jobs);

/// The same with the nearest cases and the failures.
std::string table_json(const CampaignState& state, const CampaignOptions& options);

}  // namespace kage::verif
