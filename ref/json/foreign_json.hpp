// SPDX-License-Identifier: Apache-2.0
//
// The one place where JSON is parsed. Whoever wrote it, what comes back is small enough to be copied, compared and let
// go by functions that call themselves once a level, as those of nlohmann's library do. The test contract/one_place
// refuses any other parse.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace kage {

/// Levels of arrays and objects within each other. kage's own JSON has 10 at most.
constexpr std::size_t kJsonDepth = 128;
/// Bytes of a text. In memory it takes eight times as many, or less.
constexpr std::size_t kJsonBytes = std::size_t{256} << 20;

/// The value that a text holds. Throws Error "NAME: line L, column C: CAUSE" where it is no JSON, nests deeper than
/// kJsonDepth or has a number that no double holds, and "NAME: CAUSE" where it has more than `bytes` bytes. Columns
/// count bytes. `Json` is nlohmann::json or nlohmann::ordered_json.
template <class Json>
Json parse_json(std::string_view text, const std::string& name, std::size_t bytes = kJsonBytes);

/// The value that a file holds, likewise. Throws Error too where it cannot be read; of an endless one no more than the
/// limit is.
nlohmann::ordered_json read_json(const std::filesystem::path& file);

/// The member `key` of the object that a text holds; null if there is none. The rest behind it is not parsed. Throws
/// Error likewise.
nlohmann::ordered_json json_member(std::string_view text, const std::string& key, const std::string& name);

}  // namespace kage
