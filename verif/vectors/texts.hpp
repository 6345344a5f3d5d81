// SPDX-License-Identifier: Apache-2.0
//
// The files of a pack that are text about it, and their names. docs/vectors.md says what each is.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vectors/pack.hpp"

namespace kage::vectors {

inline constexpr const char* kStimulusHex = "stimulus.hex";
inline constexpr const char* kStimulusBin = "stimulus.bin";
inline constexpr const char* kPixelsHex = "pixels.hex";
inline constexpr const char* kPixelsBin = "pixels.bin";
inline constexpr const char* kSignaturesHex = "signatures.hex";
inline constexpr const char* kFramesHex = "frames.hex";
inline constexpr const char* kRegistersHex = "registers.hex";
inline constexpr const char* kVerilogHeader = "kage_pack.vh";
inline constexpr const char* kCHeader = "kage_pack.h";
inline constexpr const char* kReadme = "README.md";
inline constexpr const char* kBench = "kage_pack_tb.v";

/// A line a frame: {beats, height, width, whether registers are read behind it}, 32 bits each.
std::string frames_hex(const Pack& pack);
/// A line a read: {frame, address, mask, value}, 32 bits each.
std::string registers_hex(const Pack& pack);
/// Sizes and parameters as macros.
std::string verilog_header(const Pack& pack);
/// The same for C, and frames, registers and signatures as arrays. `signatures`: of all lines, in order.
std::string c_header(const Pack& pack, std::span<const std::uint32_t> signatures);
/// A description of the pack and of how to run it.
std::string readme(const Pack& pack);

}  // namespace kage::vectors
