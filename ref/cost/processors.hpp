// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kage {

/// The widest core with a processor for each pixel that is planned, built and counted: beyond it a model takes many
/// minutes, and the core is larger than any device.
inline constexpr int kMostProcessors = 64;

}  // namespace kage
