// SPDX-License-Identifier: Apache-2.0
//
// Where JSON is written. The test contract/one_place refuses a dump() that ends by a foreign error where a name is no
// UTF-8.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace kage {

/// JSON as text. Names may come from file names and files of others: what is not UTF-8 becomes U+FFFD, where nlohmann's
/// own way is an exception. `indent` below 0 means one line.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kage
