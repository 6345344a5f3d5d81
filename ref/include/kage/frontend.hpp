// SPDX-License-Identifier: Apache-2.0

/// @file
/// The front end: scan conversion of a frame's geometry into the words of a frame. Integers only.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kage/config.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Takes the next `words` of a frame.
using WordSink = std::function<void(std::span<const std::uint32_t> words)>;

/// How the polyhedra of a frame went.
struct PolyhedraReport {
  static constexpr int kSpans = -1;   ///< it became spans
  static constexpr int kUnseen = -2;  ///< it covers no pixel

  /// Why polyhedra became spans: one stopped the assignment, and all behind it in draw order went with it.
  enum class Stop : std::uint8_t {
    none,     ///< all have one, or are unseen
    no_unit,  ///< no unit has room for it: pixels, faces or segments
    depth,    ///< its depth goes on by no step that segments have
    index,    ///< ORDER_BITS holds no draw index for it
  };

  std::vector<int> unit_of;  ///< of each of FrameGeometry::polyhedra: its unit, kSpans or kUnseen
  int units = 0;             ///< units with at least one
  Stop stop = Stop::none;    ///< what stopped the assignment
};

/// Where a token comes from.
struct TokenOrigin {
  /// The number of no polygon and no volume.
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::uint32_t polygon = kNone;  ///< into FrameGeometry::polygons
  std::uint32_t volume = kNone;   ///< into FrameGeometry::volumes
};

/// Origins of a frame's spans, in the order of their tokens. Of FACE and SEG the draw index tells: the polyhedra in
/// FrameGeometry::polyhedra.
struct FrameOrigins {
  std::vector<TokenOrigin> opaque;       ///< of each OP
  std::vector<TokenOrigin> shadow;       ///< of each SP, NC, IF and EV
  std::vector<TokenOrigin> translucent;  ///< of each TP
};

/// How a frame's words are made, and what is to be told of them.
struct FrameOptions {
  int threads = 0;                    ///< at most; 0: one per processor. The words do not depend on it
  PolyhedraReport* report = nullptr;  ///< filled before the first words
  FrameOrigins* origins = nullptr;    ///< filled with the words
};

/// Makes the frame's words from first to last. Lines are made in bands and handed on band by band. Cost is linear in
/// the spans. With UNITS > 0 polyhedra go to units, in draw order up to the first that finds none; the rest become
/// spans, which changes no pixel. Throws Error if the configuration cannot hold the frame (width, volumes). [Matsumoto]
/// has the spans, [Ohno 1985] the units; docs/numbers.md every rounding.
/// @param geometry made for this configuration (make_geometry())
/// @param config a legal configuration
/// @param frame_number goes into the header, for messages
/// @param sink gets the words, piece by piece; what it throws goes through
/// @param options how they are made, and what is to be told of them
void make_frame(const FrameGeometry& geometry, const Config& config, std::uint32_t frame_number, const WordSink& sink,
                const FrameOptions& options = {});

/// The same, the words in memory.
/// @param geometry made for this configuration (make_geometry())
/// @param config a legal configuration
/// @param frame_number goes into the header, for messages
/// @param out the words are appended to it
/// @param options how they are made, and what is to be told of them
void make_frame(const FrameGeometry& geometry, const Config& config, std::uint32_t frame_number,
                std::vector<std::uint32_t>& out, const FrameOptions& options = {});

}  // namespace kage
