// SPDX-License-Identifier: Apache-2.0

/// @file
/// Comparing stream files: configuration, frame by frame, token by token. Always exact; docs/diff.md.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kage/stream.hpp"

namespace kage {

/// Where two frames first differ. Tokens are numbered as errors and `kage info --tokens` number them: 0 is the header.
struct StreamPlace {
  int frame = 0;            ///< from 0
  std::optional<int> line;  ///< nothing in the header and the frame's state, before the lines, and behind the lines
  std::uint64_t token = 0;  ///< its index in the frame
  /// The field as docs/stream.md names it, "color[1]" for channel 1. Other names stand for differences that no field
  /// has:
  /// - "kind": the tokens are of two kinds,
  /// - "token" or "frame": one of the streams has none there,
  /// - "header", "words" and "bits behind the last field": the words break the rules of tokens,
  /// - "section": the words are the same and one is FRAM, the other PORT.
  std::string field;
  std::string a;  ///< the token in words, as to_string() has it
  std::string b;  ///< likewise, of the second stream
};

/// How a frame of two streams compares.
struct FrameDiff {
  int frame = 0;                       ///< from 0
  bool same = false;                   ///< in every word; if `expanded`, in what polygons come to
  bool compared = true;                ///< false: the streams' configurations are unlike, and it is in both
  std::uint64_t different_lines = 0;   ///< those that one stream lacks included
  std::uint64_t different_tokens = 0;  ///< see StreamDiff
  /// One is at the polygon level and the other is not: it is compared as the spans that the front end makes of it,
  /// token by token. The tokens are numbered as in the frame at the span level.
  bool expanded = false;
  std::optional<StreamPlace> first;  ///< where the frames first differ
};

/// Outcome. Lines are matched by their number. In a line all tokens from the first different one to the last count as
/// different, in the stream that has more of them there: a token put in between counts once.
struct StreamDiff {
  /// A parameter that is unlike.
  struct Parameter {
    std::string name;  ///< as in the definition file
    int a = 0;         ///< its value in the first stream
    int b = 0;         ///< and in the second one
  };
  /// A section that is unlike.
  struct Section {
    std::string tag;  ///< its four characters
    std::string how;  ///< "only in A", "only in B", "contents", "place among the frames"
  };
  bool same = false;                  ///< the verdict
  std::string reason;                 ///< why not, in words; empty if same
  int frames_a = 0;                   ///< in the first stream
  int frames_b = 0;                   ///< in the second one
  std::vector<Parameter> parameters;  ///< of the configurations, those that are unlike
  bool tokens_compared = false;  ///< not where a parameter that affects pixels is unlike: the same words mean others
  int expanded_frames = 0;       ///< frames of unlike levels, see FrameDiff::expanded; ACTIVE may be unlike then
  std::uint64_t different_frames = 0;  ///< those that one stream lacks included
  std::uint64_t different_lines = 0;   ///< of all frames
  std::uint64_t different_tokens = 0;  ///< likewise
  std::optional<StreamPlace> first;    ///< where the streams first differ
  std::vector<Section> sections;       ///< those that differ, besides configuration and frames
};

/// Compares two stream files. Both are checked whole, as StreamFile::frame() does, and Error is thrown where one is
/// damaged. Only one frame of each is in memory, whatever the files' length.
/// @param a the first stream
/// @param b the second one
/// @param each is called after each frame; what it throws goes through
/// @return the outcome
StreamDiff diff_streams(const StreamFile& a, const StreamFile& b,
                        const std::function<void(const FrameDiff&)>& each = {});

}  // namespace kage
