// SPDX-License-Identifier: Apache-2.0

/// @file
/// The front end: scan conversion of a frame's geometry into the words of a frame. Integers only.
#pragma once

#include <array>
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

/// Origins of a frame's spans, in the order of their tokens. FACE and SEG are not here: their draw index already names
/// the origin, by FrameGeometry::polyhedra.
struct FrameOrigins {
  std::vector<TokenOrigin> opaque;       ///< of each OP
  std::vector<TokenOrigin> shadow;       ///< of each SP, NC, IF and EV
  std::vector<TokenOrigin> translucent;  ///< of each TP
};

/// How a polygon goes in a frame at the polygon level. All but the first say why it goes as spans, on all its lines.
enum class PolygonWay : std::uint8_t {
  polygon,    ///< the front end makes its spans
  crossings,  ///< a line crosses its outline more than twice, or has several spans of it
  wide,       ///< a slope of its depth or colour has more bits than its field
  rounded,    ///< the front end would make other spans: start or step of some are clamped
  cut,        ///< lines part it: a translucent fragment from others, or what is diced (FrameGeometry::shade_cuts)
  words,      ///< its spans are no more words
  active,     ///< more polygons at once than ACTIVE
  place,      ///< more polygons of its volume than a place can count
};
/// ACTIVE of a core that is to have a front end, where nobody says otherwise.
inline constexpr int kUsualActive = 512;

/// How many ways there are.
inline constexpr std::size_t kPolygonWays = 8;

/// Polygons of a frame at the polygon level, by the way they go. A drawn polygon and each face of a volume count by
/// themselves; those that have no span do not count.
struct PolygonReport {
  /// Polygons that go one way.
  struct Way {
    std::uint64_t polygons = 0;       ///< all
    std::uint64_t spans = 0;          ///< theirs: OP, SP and TP
    std::uint64_t tall_polygons = 0;  ///< from the first line with a span to the last, three or more
    std::uint64_t tall_spans = 0;     ///< spans of those

    /// Adds others.
    /// @param other those
    /// @return the sum
    Way& operator+=(const Way& other);
  };

  /// Whether the frame is at the polygon level. One with more light samples, or volumes of one, than places can count
  /// is not, and nothing here is filled but its words.
  bool polygons = false;
  std::array<Way, kPolygonWays> ways{};  ///< by PolygonWay
  int active = 0;                        ///< most polygons at once on a line that the front end makes spans of
  std::uint64_t words = 0;               ///< of the frame

  /// @return all polygons
  [[nodiscard]] Way all() const;
  /// @param way any
  /// @return polygons that go this way
  [[nodiscard]] const Way& of(PolygonWay way) const { return ways[static_cast<std::size_t>(way)]; }
  /// @return those that the front end makes spans of
  [[nodiscard]] const Way& made() const { return of(PolygonWay::polygon); }

  /// Adds those of another frame.
  /// @param other its report
  /// @return the sum; `active` is the most of both, and it has polygons if either has
  PolygonReport& operator+=(const PolygonReport& other);
};

/// How a frame's words are made, and what is to be told of them.
struct FrameOptions {
  int threads = 0;                    ///< at most; 0: one per processor. The words do not depend on it
  PolyhedraReport* report = nullptr;  ///< filled before the first words
  FrameOrigins* origins = nullptr;    ///< filled with the words, and the same at both levels
  /// With polygons, for a configuration with ACTIVE > 0: polygons go as such where that is fewer words and gives the
  /// very same spans; the front end makes these of them (docs/stream.md, "The polygon level").
  Level level = Level::spans;
  PolygonReport* polygons = nullptr;  ///< filled with the words; at the polygon level
  /// Spans and ends of volumes that have no effect on any pixel are written too. Without them the pixels are the same
  /// (docs/shadows.md, "Without effect"). At the polygon level a polygon is left out whole or not at all.
  bool all_spans = false;
};

/// Makes the frame's words from first to last. Lines are made in bands and handed on band by band. Cost is linear in
/// the spans. With UNITS > 0 polyhedra go to units, in draw order up to the first that finds none; the rest become
/// spans, which changes no pixel. Throws Error if the configuration cannot hold the frame (width, volumes, level).
/// [Matsumoto] has the spans, [Ohno 1985] the units; docs/numbers.md every rounding.
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
