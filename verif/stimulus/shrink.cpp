// SPDX-License-Identifier: Apache-2.0
#include "stimulus/shrink.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "contract/derived.hpp"
#include "contract/fields.hpp"
#include "contract/kinds.hpp"
#include "number/bits.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/parts.hpp"

namespace kage::verif {
namespace {

/// Takes `step` columns at one side from a tree's segments, as narrower() does from spans. Faults stay: a segment of no
/// pixel, and what goes past the line.
class SegmentCutter {
 public:
  SegmentCutter(const Config& c, const Layout& layout, const Words& header, std::uint32_t step, bool left)
      : config_(c), layout_(layout), places_(header), width_(width_of(header)), step_(step), left_(left) {}

  /// The FACE or SEG after the cut, nothing if it goes.
  std::optional<Words> cut(const Words& token) {
    const SegmentToken s = decode(config_, layout_, token).segment;
    Unit& unit = units_[s.unit];
    if (is(token, Kind::FACE)) {
      unit.dz.push_back(s.dz);
      return token;
    }
    const std::uint32_t begin = places_.next(s).x;
    const std::uint32_t end = begin + static_cast<std::uint32_t>(s.dx);
    const std::uint32_t first = left_ ? std::max(begin, step_) : begin;
    const std::uint32_t last = left_ ? end : std::min(end, width_ - step_) + (std::max(end, width_) - width_);
    unit.sync = unit.sync || s.sync;
    if (s.dx > 0 && first >= last) return std::nullopt;
    SegmentToken kept = s;
    kept.sync = std::exchange(unit.sync, false);
    if (s.dx > 0) kept.dx = static_cast<int>(last - first);
    const auto face = static_cast<std::size_t>(s.face);
    if (first > begin && face < unit.dz.size()) kept.z = depth_after(s.z, unit.dz[face], first - begin);
    if (kept.sync == s.sync && kept.dx == s.dx && kept.z == s.z) return token;
    Words words;
    TokenWriter(config_, words).seg(kept);
    return words;
  }

 private:
  struct Unit {
    std::vector<std::int64_t> dz;  // of its faces
    bool sync = false;             // that of a segment that went
  };

  [[nodiscard]] std::int64_t depth_after(std::int64_t z, std::int64_t dz, std::uint64_t pixels) const {
    const std::int64_t sum = sign_extend(static_cast<std::uint64_t>(z) + pixels * static_cast<std::uint64_t>(dz),
                                         derived::depth_bits(config_));
    // A classic segment cannot begin past what its field holds: at its first pixel the same is drawn at the border.
    const std::int64_t most = (std::int64_t{1} << layout_.seg_z.bits) - 1;
    return config_.classic != 0 ? std::clamp<std::int64_t>(sum, 0, most) : sum;
  }

  const Config& config_;
  const Layout& layout_;
  SegmentPlaces places_;
  std::uint32_t width_;
  std::uint32_t step_;
  bool left_;
  std::map<int, Unit> units_;
};

/// Takes away runs of what `count` counts, by `without(first, last)`: each half as long as the one before, then, where
/// few are left, short ones at every place, as tokens that only make sense together.
template <class Count, class Without, class Accept>
bool fewer(Count count, Without without, Accept accept, const std::function<bool()>& more) {
  constexpr std::size_t kFew = 100;
  constexpr std::size_t kTogether = 6;
  bool any = false;
  const auto pass = [&](std::size_t run, bool everywhere) {
    for (std::size_t at = 0; at < count() && more();) {
      const std::size_t last = std::min(at + run, count());
      if (accept(without(at, last)))
        any = true;
      else
        at = everywhere ? at + 1 : last;
    }
  };
  for (std::size_t run = std::max<std::size_t>(count(), 1); run > 0; run /= 2) pass(run, false);
  for (std::size_t run = 2; run <= kTogether && count() <= kFew; ++run) pass(run, true);
  return any;
}

class Shrinker {
 public:
  Shrinker(const Config& c, Words words, const std::function<bool(const Words&)>& keeps,
           const std::function<bool()>& more)
      : config_(c), layout_(c), words_(std::move(words)), keeps_(keeps), more_(more) {}

  Words run() {
    // A smaller frame may let go of what a larger one needed.
    for (bool any = true; any && more_();) {
      any = lines();
      any = tokens() || any;
      any = rest() || any;
      any = width() || any;
    }
    return std::move(words_);
  }

 private:
  bool accept(Words candidate) {
    if (candidate.size() > words_.size() || candidate == words_ || !keeps_(candidate)) return false;
    words_ = std::move(candidate);
    return true;
  }

  bool lines() {
    const auto count = [&] {
      const Parts p = apart(config_, words_);
      return static_cast<std::size_t>(
          std::count_if(p.tokens.begin(), p.tokens.end(), [](const Words& t) { return is(t, Kind::EOL); }));
    };
    const auto without = [&](std::size_t first, std::size_t last) {
      return only_lines(config_, words_, [&](std::size_t line) { return line < first || line >= last; });
    };
    return fewer(
        count, without, [&](Words w) { return accept(std::move(w)); }, more_);
  }

  bool tokens() {
    const auto count = [&] { return apart(config_, words_).tokens.size(); };
    const auto without = [&](std::size_t first, std::size_t last) {
      Parts p = apart(config_, words_);
      p.tokens.erase(p.tokens.begin() + static_cast<std::ptrdiff_t>(first),
                     p.tokens.begin() + static_cast<std::ptrdiff_t>(last));
      return together(p);
    };
    return fewer(
        count, without, [&](Words w) { return accept(std::move(w)); }, more_);
  }

  /// The words behind the last token.
  bool rest() {
    const auto count = [&] { return apart(config_, words_).rest.size(); };
    const auto without = [&](std::size_t first, std::size_t last) {
      Parts p = apart(config_, words_);
      p.rest.erase(p.rest.begin() + static_cast<std::ptrdiff_t>(first),
                   p.rest.begin() + static_cast<std::ptrdiff_t>(last));
      return together(p);
    };
    return fewer(
        count, without, [&](Words w) { return accept(std::move(w)); }, more_);
  }

  /// Columns at the right go, then such at the left; of each side all but one are tried first.
  bool width() {
    if (words_.size() < 2) return false;
    bool any = false;
    for (const bool left : {false, true})
      for (std::uint32_t step = std::max(width_of(words_), 1U) - 1; step > 0; step /= 2)
        while (more_() && width_of(words_) > step && narrower(step, left)) any = true;
    return any;
  }

  bool narrower(std::uint32_t step, bool left) {
    Words words = with_segments_cut(step, left);
    FrameHeader h = FrameHeader::read(words);
    h.width -= static_cast<int>(step);
    h.write(words);
    const std::uint64_t width = width_of(words);
    const auto moved = [&](std::uint64_t x) {
      return left ? x - std::min<std::uint64_t>(x, step) : std::min(x, width);
    };
    TokenPlaces places(config_, words);
    for (const TokenPlaces::At at : places.all()) {
      const auto kind = kind_of(words[static_cast<std::size_t>(at)], places.level());
      std::uint64_t cut = 0;  // pixels that a span loses at its left: it goes on with the depth and colour behind them
      each_field(config_, layout_, kind, [&](std::string_view name, int, Field field) {
        if (field.bits == 0 || (name != "xl" && name != "xr")) return;
        const std::uint64_t x = places.get(at, field);
        if (name == "xl" && left && x < step) cut = step - x;
        places.put(at, field, moved(x));
      });
      if (cut > 0) advance(places, at, kind, cut);
    }
    return accept(std::move(words));
  }

  [[nodiscard]] Words with_segments_cut(std::uint32_t step, bool left) const {
    Parts p = apart(config_, words_);
    SegmentCutter cutter(config_, layout_, p.header, step, left);
    std::vector<Words> tokens;
    for (Words& t : p.tokens) {
      const bool of_unit = info_of(kind_of(t[0])).unit;  // of both levels
      if (std::optional<Words> cut = of_unit ? cutter.cut(t) : std::move(t)) tokens.push_back(std::move(*cut));
    }
    p.tokens = std::move(tokens);
    return together(p);
  }

  /// A span begins so many pixels later.
  void advance(TokenPlaces& places, TokenPlaces::At at, Kind kind, std::uint64_t pixels) const {
    const auto ramp = [&](std::string_view start, std::string_view step) {
      std::array<Field, 3> starts{};
      std::array<Field, 3> steps{};
      each_field(config_, layout_, kind, [&](std::string_view name, int channel, Field field) {
        const auto i = static_cast<std::size_t>(std::max(channel, 0));
        if (name == start) starts[i] = field;
        if (name == step) steps[i] = field;
      });
      for (std::size_t i = 0; i < starts.size(); ++i) {
        if (starts[i].bits == 0 || steps[i].bits == 0) continue;
        const std::uint64_t sign = std::uint64_t{1} << (steps[i].bits - 1);
        const std::uint64_t by = (places.get(at, steps[i]) ^ sign) - sign;
        places.put(at, starts[i], places.get(at, starts[i]) + pixels * by);
      }
    };
    ramp("z", "dz");
    ramp("color", "dcolor");
  }

  const Config& config_;
  Layout layout_;
  Words words_;
  const std::function<bool(const Words&)>& keeps_;
  const std::function<bool()>& more_;
};

}  // namespace

Words shrink(const Config& config, Words words, const std::function<bool(const Words&)>& keeps,
             const std::function<bool()>& more) {
  return Shrinker(config, std::move(words), keeps, more).run();
}

}  // namespace kage::verif
