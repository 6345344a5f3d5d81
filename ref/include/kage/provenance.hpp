// SPDX-License-Identifier: Apache-2.0

/// @file
/// What in a scene the tokens of a frame come from.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "kage/explain.hpp"
#include "kage/frontend.hpp"
#include "kage/geometry.hpp"
#include "kage/scene.hpp"

namespace kage {

/// The part of the scene that a token draws, or that casts the shadow which the token is of.
struct TokenSource {
  /// "face" or "polyhedron"; of a volume "cap", "side", "front" or "end". Its front is what lies before all that
  /// receives its shadow: its section with the near plane, and caps and sides that need no comparison.
  std::string role;
  std::string object;  ///< its name in the file
  int component = -1;  ///< of the scene; a volume may be of several, then the first
  int face = -1;       ///< number in its object, as in the file; -1: of no single face
  int light = -1;      ///< of a volume, from 0
  int sample = -1;     ///< of that light, from 0
  int volume = -1;     ///< into FrameGeometry::volumes

  /// Puts the source in words.
  /// @return "the side of the shadow of gem, face 3, light 0 sample 2"
  [[nodiscard]] std::string text() const;
};

/// A frame's geometry with the names behind it.
class Provenance {
 public:
  /// Keeps what a frame was made of.
  /// @param objects names, as Scene::objects()
  /// @param frame what was drawn
  /// @param geometry made of it
  /// @param origins of the frame's words
  Provenance(std::vector<std::string> objects, SceneFrame frame, FrameGeometry geometry, FrameOrigins origins)
      : objects_(std::move(objects)),
        frame_(std::move(frame)),
        geometry_(std::move(geometry)),
        origins_(std::move(origins)) {}

  /// Tells where tokens come from.
  /// @param config that of the words
  /// @param words the whole frame
  /// @param wanted which: their numbers behind the front end, as PixelTouch::nth; at the span level indices in the
  /// frame
  /// @return sources of those among `wanted` that come of a part of the scene: spans, and ends of volumes
  [[nodiscard]] std::map<std::uint32_t, TokenSource> of_tokens(const Config& config,
                                                               std::span<const std::uint32_t> words,
                                                               const std::set<std::uint32_t>& wanted) const;

  /// Tells where the tokens of a pixel's history come from, and of each TREE the polyhedron that came through it.
  /// @param config that of the words
  /// @param words the whole frame
  /// @param history of a pixel of the frame
  /// @return sources by PixelTouch::nth
  [[nodiscard]] std::map<std::uint32_t, TokenSource> of_history(const Config& config,
                                                                std::span<const std::uint32_t> words,
                                                                const PixelHistory& history) const;

 private:
  [[nodiscard]] TokenSource of_polyhedron(std::uint32_t index) const;
  [[nodiscard]] TokenSource of_face(std::uint32_t polygon) const;
  [[nodiscard]] TokenSource of_volume(const TokenOrigin& origin, Kind kind) const;
  [[nodiscard]] std::string object_of(std::uint32_t component) const;

  std::vector<std::string> objects_;
  SceneFrame frame_;
  FrameGeometry geometry_;
  FrameOrigins origins_;
};

/// Tokens of a kind that a pixel has no need of, all for one reason.
struct LeftOut {
  Kind kind = Kind::SP;      ///< of the tokens
  std::uint32_t tokens = 0;  ///< how many, 1 or more
  std::string why;           ///< "not before what is drawn"

  /// Puts them in words.
  /// @return "12 SP: not before what is drawn"
  [[nodiscard]] std::string text() const;

  bool operator==(const LeftOut&) const = default;
};

/// A pixel's history with the sources of its tokens.
struct ToldHistory {
  const PixelHistory* history = nullptr;
  const std::map<std::uint32_t, TokenSource>* from = nullptr;  ///< Provenance::of_history()
};

/// Tells what a frame leaves out at a pixel (docs/shadows.md, "Without effect").
/// @param all the pixel's history in the frame with FrameOptions::all_spans
/// @param kept its history in the frame without
/// @return what touches the pixel in the first and not in the second, in the order of the first of each
std::vector<LeftOut> left_out(const ToldHistory& all, const ToldHistory& kept);

}  // namespace kage
