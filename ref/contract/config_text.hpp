// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kage/config.hpp"

namespace kage {

/// A configuration from YAML text; `where` opens the message of an Error.
Config config_from_text(const std::string& text, const std::string& where);

}  // namespace kage
