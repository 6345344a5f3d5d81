// SPDX-License-Identifier: Apache-2.0
//
// Damage to a frame's words on the way: anywhere, or to the tokens of a tree or of light samples.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kage/stream.hpp"
#include "number/bits.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

/// A frame's words, taken apart for damage: its fields, and where its tokens of each kind begin.
class TokenPlaces {
 public:
  using At = std::vector<std::uint32_t>::difference_type;

  TokenPlaces(const Config& c, std::vector<std::uint32_t>& words)
      : layout_(c), words_(&words), level_(FrameHeader::read(words).level()) {
    for (std::size_t at = kHeaderWords; at < words.size();) {
      const std::size_t length = layout_.words_of(words[at], level_);
      if (length == 0 || length > words.size() - at) return;
      places_[static_cast<std::size_t>(kind_of(words[at], level_))].push_back(static_cast<At>(at));
      all_.push_back(static_cast<At>(at));
      at += length;
    }
    whole_ = true;
  }

  /// False if an earlier damage has left a word that is no token, or has cut the last token.
  [[nodiscard]] bool whole() const { return whole_; }
  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] Level level() const { return level_; }
  [[nodiscard]] const std::vector<At>& all() const { return all_; }
  [[nodiscard]] const std::vector<At>& of(Kind k) const { return places_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] At length(Kind k) const { return layout_.words[static_cast<std::size_t>(k)]; }

  void put(At at, Field f, std::uint64_t value) { put_at(std::span(*words_).subspan(place(at)), f, value); }
  [[nodiscard]] std::uint64_t get(At at, Field f) const { return bits_at(std::span(*words_).subspan(place(at)), f); }
  /// A token's copy in front of another; places are those of before.
  void copy(At from, At n, At to) {
    const std::vector<std::uint32_t> token(words_->begin() + from, words_->begin() + from + n);
    words_->insert(words_->begin() + to, token.begin(), token.end());
  }
  void erase(At at, At n) { words_->erase(words_->begin() + at, words_->begin() + at + n); }

 private:
  static std::size_t place(At at) { return static_cast<std::size_t>(at); }

  Layout layout_;
  std::vector<std::uint32_t>* words_;
  Level level_;
  std::array<std::vector<At>, kKinds> places_;
  std::vector<At> all_;
  bool whole_ = false;
};

/// Damage a frame, once to three times. Cut it, lengthen it, drop or double a word, flip a bit anywhere, in a kind or
/// in the header, or put noise in a word's place. Or make it a little wider, narrower, higher or lower. It may even
/// survive that.
void damage(Random& random, std::vector<std::uint32_t>& words);

/// Damage that samples, classes and the light table are made for: one to three tokens that are not what they should be.
/// The words must be a valid frame; one without counters stays as it is.
void damage_light(Random& random, const Config& c, std::vector<std::uint32_t>& words);

/// Damage that a frame with a tree is made for: one to three faces, segments or TREEs that are not what they should be.
/// The words must be a valid frame; one without units or tree stays as it is.
void damage_tree(Random& random, const Config& c, std::vector<std::uint32_t>& words);

/// Damage that frames at the polygon level are made for: one to three places, polygons, edges or planes that are not
/// what they should be. The words must be a valid frame; one at the span level stays as it is.
void damage_polygons(Random& random, const Config& c, std::vector<std::uint32_t>& words);

}  // namespace kage::verif
