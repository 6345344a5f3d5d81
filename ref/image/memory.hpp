// SPDX-License-Identifier: Apache-2.0
//
// How much memory a picture may take.
#pragma once

#include <cstdint>
#include <optional>

namespace kage {

/// Half of the bytes that this process may still have: of those that the machine has free, that its control groups
/// leave and that `ulimit` lets it have, the fewest.
std::uint64_t half_of_memory();

/// Throws Error if so many bytes are more than `most`, or than half_of_memory() where there is none. `what` opens the
/// message.
void check_memory(const char* what, std::uint64_t bytes, std::optional<std::uint64_t> most);

}  // namespace kage
