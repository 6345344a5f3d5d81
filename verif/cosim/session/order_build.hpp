// SPDX-License-Identifier: Apache-2.0
//
// How a visibility order is built: by its options, with progress, and able to be interrupted.
#pragma once

#include <string>

#include "kage/cosim.hpp"
#include "kage/order.hpp"

namespace kage::cosim {

/// How a visibility order is built as the options say. Building it shows `what` with how much is done, in percent, and
/// can be interrupted. `host` and `progress` must outlive the result.
OrderBuildOptions order_build(const SourceOptions& options, Host& host, Progress& progress, const std::string& what);
OrderBuildOptions order_build(const SourceOptions& options, Host& host);  // without a word

/// Why an order was refused, `where` being the file, and the frame of it: an Error in one line that names the option.
[[noreturn]] void refuse_fragments(const std::string& where, const TooManyFragments& why);

}  // namespace kage::cosim
