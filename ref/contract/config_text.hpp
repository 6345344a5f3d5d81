// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "kage/config.hpp"

namespace kage {

/// A configuration from YAML text; `where` opens the message of an Error.
Config config_from_text(const std::string& text, const std::string& where);

/// Whether a rule's expression has the parameter in it, and not only one whose name has this name in it.
bool names(std::string_view expression, std::string_view parameter);

}  // namespace kage
