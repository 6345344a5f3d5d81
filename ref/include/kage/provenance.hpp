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
  std::string role;    ///< "face", "polyhedron", "cap", "side", "section with the near plane" or "end"; of a volume but
                       ///< for the first two
  std::string object;  ///< its name in the file
  int component = -1;  ///< of the scene; a volume may be of several, then the first
  int face = -1;       ///< number in its object, as in the file; -1: of no single face
  int light = -1;      ///< of a volume, from 0
  int sample = -1;     ///< of that light, from 0

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

}  // namespace kage
