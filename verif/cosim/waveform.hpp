// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "cosim/divergence.hpp"

namespace kage::cosim {

/// Run frames `from` .. `frame` again and write clocks round `clock`, which lies in the last of them, to the FST file
/// options.waveform, with a GTKWave save file beside it that opens on `clock` with the core's main handshakes. Both
/// appear together when they are whole, or with the others of options.files. Returns the save file's path. Throws Error
/// if one of them cannot be written.
std::filesystem::path write_waveform(int from, int frame, const Feed& feed, const Config& config,
                                     const DivergenceOptions& options, std::uint64_t clock);

}  // namespace kage::cosim
