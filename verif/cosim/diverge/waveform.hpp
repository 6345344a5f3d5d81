// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "cosim/diverge/divergence.hpp"
#include "file/temp_file.hpp"

namespace kage::cosim {

struct Waveform {
  std::filesystem::path path;  ///< of the FST file; the GTKWave save file has .gtkw in its place
  TempFiles* files = nullptr;  ///< gets both, for the caller to commit; nullptr: they are committed at once
  std::uint64_t before = 100;  ///< clocks before the divergence
  std::uint64_t after = 50;    ///< and after it
};

/// Runs the frames d.from .. d.frame again as the search did that found `d`, and writes the clocks round it to an FST
/// file. A GTKWave save file beside it opens there with the core's main handshakes. `options` are those of the search,
/// except the library: a model that was built for waveforms (ModelOptions), with or without monitors. Both files appear
/// together when they are whole, and `d` gets their names. Throws Error if one of them cannot be written.
void write_waveform(Divergence& d, const Feed& feed, const Config& config, const ReplayOptions& options,
                    const Waveform& wave);

/// The command line that shows a waveform by its save file.
std::string gtkwave_line(const std::string& save_file);

}  // namespace kage::cosim
