// SPDX-License-Identifier: Apache-2.0
//
// Random frames one after the other, as kage cosim random sends them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kage/config.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

/// A frame that obeys every rule of a port. It has any size that the configuration takes, mostly small, so that many
/// are run. It is crowded or bare, with spans that meet at few pixels and depths, with accumulators that wrap. At the
/// polygon level a configuration with ACTIVE > 0 is needed.
std::vector<std::uint32_t> sound_frame(Random& random, const Config& c, std::uint32_t number,
                                       Level level = Level::spans);

/// A sound frame of 1 .. 4 pixels a line, and of 127 to 4136 lines, or of kMaxHeight. It takes as long as
/// hundreds of others.
std::vector<std::uint32_t> tall_frame(Random& random, const Config& c, std::uint32_t number,
                                      Level level = Level::spans);

/// A sound frame of any width up to MAX_WIDTH, at a border of a group of LANES pixels, or a pixel off it.
std::vector<std::uint32_t> wide_frame(Random& random, const Config& c, std::uint32_t number,
                                      Level level = Level::spans);

/// Something is wrong with it, or perhaps not: what the golden core says is right. Bits flipped anywhere, tokens lost,
/// doubled or misplaced, fields just past what they may be, a header or an end that is not one. At least a word, and
/// never so high that it takes long.
std::vector<std::uint32_t> damaged_frame(Random& random, const Config& c, std::uint32_t number,
                                         Level level = Level::spans);

/// A frame that may be in a core when the next one comes: a sound frame, a damaged one, or one of many lines of a pixel
/// or two with nothing on them. More lines of the last kind are under way at a time than of any other.
std::vector<std::uint32_t> earlier_frame(Random& random, const Config& c, std::uint32_t number,
                                         Level level = Level::spans);

/// Kinds of random frames.
enum class Manner {
  sound,    ///< sound_frame()
  damaged,  ///< damaged_frame()
  mixed     ///< either, as likely; some meet a core that was just reset, or is still at work on another frame
};

/// Name by which each manner is asked for.
struct RandomSource {
  const char* name;
  Manner manner;
};
inline constexpr std::array kRandomSources{RandomSource{"random", Manner::sound},
                                           RandomSource{"random:damaged", Manner::damaged},
                                           RandomSource{"random:mixed", Manner::mixed}};

/// The manner that a name of kRandomSources asks for; none for any other text that does not begin as they do. Throws
/// Error for "random:" with a manner that there is not.
std::optional<Manner> random_manner(const std::string& name);

/// Frames that follow from configuration, manner, seed and their number alone: no frame depends on another.
class RandomFrames {
 public:
  /// At the polygon level, which needs a configuration with ACTIVE > 0, every fifth frame or so is at the span level,
  /// as such a core takes both.
  RandomFrames(const Config& config, Manner manner, std::uint64_t seed, Level level = Level::spans)
      : config_(config), manner_(manner), seed_(seed), level_(level) {}

  /// Among each kSizes frames one is tall and one is wide, unless it is to be damaged. A short run has none, so that it
  /// is quick.
  static constexpr int kSizes = 60;
  static constexpr int kTall = 59;
  static constexpr int kWide = 29;

  /// The words of frame `index`.
  [[nodiscard]] std::vector<std::uint32_t> words(int index) const;

  /// The frame that may go ahead of each mixed frame, by its number: earlier_frame(). Other manners have none.
  [[nodiscard]] std::function<std::vector<std::uint32_t>(int index)> prelude() const;

 private:
  Level any_level(Random& random) const;

  Config config_;
  Manner manner_;
  std::uint64_t seed_;
  Level level_;
};

}  // namespace kage::verif
