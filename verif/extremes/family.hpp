// SPDX-License-Identifier: Apache-2.0
//
// A family of extreme inputs: what its cases are made of, what must hold of each, and how a search goes from case to
// case. Tests and campaign run the same ones.
#pragma once

#include <rapidcheck.h>

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "extremes/fields.hpp"

namespace kage::verif {

/// Result of a case.
struct Outcome {
  std::uint64_t pixels = 0;  ///< at which an oracle's answer and kage's were compared
  std::uint64_t items = 0;   ///< other things compared: steps of an eye, fragments, values of a curve
  double worst = 0;          ///< the error that comes nearest to its bound
  double bound = 0;          ///< its bound, in the same unit; 0 where nothing was measured
  std::string wrong;         ///< empty: all holds

  /// Keeps the first error.
  void fail(const std::string& what) {
    if (wrong.empty()) wrong = what;  // an empty text is no failure
  }
  /// An error with its bound, which it must not pass.
  void measure(double error, double at_most);
  void add(const Outcome& o);
  [[nodiscard]] double share() const { return bound > 0 ? worst / bound : 0; }
};

/// Deliberate errors, for tests that must see a campaign find something. A check that knows one spoils what kage gave
/// it, not kage.
enum class Injection : std::uint8_t {
  none,
  wide_span,      ///< a span of three pixels or more is a pixel too wide
  steep_step,     ///< the step of a depth ramp is one too large
  lost_layer,     ///< the last translucent layer is missing
  lost_face,      ///< the last face of a shadow volume is missing
  near_cap,       ///< caps of shadow volumes lie a thousand LSB nearer than the faces that cast them
  swapped_pair,   ///< two neighbours of a visibility order have changed places
  moved_corner,   ///< the last corner of a polygon is a step of the snap too far right
  tilted_plane,   ///< the slope along x of a depth plane, or of a line that cuts, is a 64th too large
  wrong_pixel,    ///< a pixel near the middle of a picture or line is a step of its colour off
  large_share,    ///< what a light gives, or the sRGB curve, is a 64th too large
  finite_value,   ///< a number that is not finite has become 0 on its way
  lost_fragment,  ///< the last fragment of a face, or its last pixel, is missing
  lost_word       ///< a word in the middle of a frame is missing at the port
};
/// By its name, as --inject takes it.
std::optional<Injection> injection_of(const std::string& name);
/// All names.
const std::vector<std::string>& injection_names();

struct RtlModels;

/// Input of checks besides their case.
struct Context {
  Injection injection = Injection::none;
  RtlModels* models = nullptr;  ///< none: families of the RTL have no cases

  [[nodiscard]] bool injected(Injection p) const { return injection == p; }
  /// Makes a pixel wrong, if that error is injected.
  template <class Pixels>
  void spoil(Pixels& pixels) const {
    if (injected(Injection::wrong_pixel) && !pixels.empty()) pixels[pixels.size() * 17 / 33] ^= 1;
  }
};

struct FamilyInfo {
  int number;        ///< that of docs/testing.md; 0: a bound of docs/numbers.md beside the families
  std::string name;  ///< what cases are named by: the number, with a part where a family has several checks
  std::string what;  ///< in a few words
  std::string unit;  ///< of worst and bound; empty: all must be exact
  int climb;         ///< steps of a search for the largest error, from every random start
  double weight;     ///< share of a campaign's time
  bool rtl;          ///< its cases are run by a model of the RTL

  FamilyInfo(int number_, std::string name_, std::string what_, std::string unit_ = {}, int climb_ = 0,
             double weight_ = 1, bool rtl_ = false)
      : number(number_),
        name(std::move(name_)),
        what(std::move(what_)),
        unit(std::move(unit_)),
        climb(climb_),
        weight(weight_),
        rtl(rtl_) {}
};

/// Result of a start and of the search from it.
struct Search {
  std::uint64_t cases = 0;
  Outcome sum;
  std::string nearest;                 ///< the text of the case that came nearest to its bound
  std::optional<std::string> failing;  ///< the text of one that fails
};

/// A family whatever its cases are made of.
class Family {
 public:
  explicit Family(FamilyInfo info) : info_(std::move(info)) {}
  virtual ~Family() = default;
  Family(const Family&) = delete;
  Family& operator=(const Family&) = delete;

  [[nodiscard]] const FamilyInfo& info() const { return info_; }
  /// The cases of one start, which follow from seed and index alone. Ends early where `stop` says so.
  [[nodiscard]] virtual Search run(std::uint64_t seed, std::uint64_t index, const Context& context,
                                   const std::function<bool()>& stop) const = 0;
  /// The text of the case that a start begins with.
  [[nodiscard]] virtual std::string text(std::uint64_t seed, std::uint64_t index) const = 0;
  /// A case from its text. Throws Error that names `name` and a line where it is none.
  [[nodiscard]] virtual Outcome check(const std::string& text, const std::string& name,
                                      const Context& context) const = 0;
  /// The case that RapidCheck shrinks a failing one to, as text. It shrinks until `stop`.
  [[nodiscard]] virtual std::string shrink(const std::string& text, const Context& context,
                                           const std::function<bool()>& stop) const = 0;
  /// The same text, read and written, for tests.
  [[nodiscard]] virtual std::string reread(const std::string& text) const = 0;

 protected:
  FamilyInfo info_;
};

/// The state of chance that a start has, of family, seed and index.
std::uint64_t start_state(const std::string& family, std::uint64_t seed, std::uint64_t index);

/// Runs a check; an exception is a failure that tells its text.
Outcome guarded(const std::function<Outcome()>& check);

/// A type of cases.
template <class Case>
concept IsCase = requires(Case c, Fields& f, const Context& context) {
  c.fields(f);
  { c.check(context) } -> std::same_as<Outcome>;
};

/// Its fields as text.
template <IsCase Case>
std::string text_of(Case c) {
  WriteFields write;
  c.fields(write);
  return write.text();
}

/// The case of such a text. Throws Error that names `name` and a line where it is none.
template <IsCase Case>
Case case_of(const std::string& text, const std::string& name) {
  Case c;
  ReadFields fields(text, name);
  c.fields(fields);
  fields.end();
  return c;
}

/// How RapidCheck shows one.
template <IsCase Case>
void showValue(const Case& c, std::ostream& out) {
  out << text_of(c);
}

template <class Case>
void settle(Case& c) {
  ClampFields clamp;
  c.fields(clamp);
}

template <class Case>
Case draw_case(Random& random) {
  Case c;
  DrawFields draw(random);
  c.fields(draw);
  settle(c);
  return c;
}

template <class Case>
rc::Seq<Case> simpler(const Case& from) {
  Case c = from;
  FindEdits find;
  c.fields(find);
  return rc::seq::map(rc::seq::fromContainer(find.edits()), [from](const Edit& edit) {
    Case to = from;
    ApplyEdit apply(edit);
    to.fields(apply);
    settle(to);
    return to;
  });
}

/// A case with all ways to make it simpler.
template <class Case>
rc::Shrinkable<Case> shrinkable_case(const Case& c) {
  return rc::shrinkable::shrinkRecur(c, [](const Case& from) { return simpler(from); });
}

/// RapidCheck's generator of a family's cases.
template <class Case>
rc::Gen<Case> case_generator() {
  return [](const rc::Random& random, int) {
    rc::Random copy = random;
    Random chance(copy.next());
    return shrinkable_case(draw_case<Case>(chance));
  };
}

/// A family of cases of one type, which has fields(Fields&) and check(const Context&).
template <class Case>
class FamilyOf final : public Family {
 public:
  using Family::Family;

  [[nodiscard]] Search run(std::uint64_t seed, std::uint64_t index, const Context& context,
                           const std::function<bool()>& stop) const override {
    Random random(start_state(info_.name, seed, index));
    Search run;
    Case best;
    double share = -1;
    for (int step = 0; step <= info_.climb && !stop(); ++step) {
      Case c = step == 0 ? draw_case<Case>(random) : changed(best, random);
      const Outcome o = guarded([&] { return c.check(context); });
      ++run.cases;
      const double before = run.sum.share();
      run.sum.add(o);
      if (!o.wrong.empty()) {
        run.failing = text_of(c);
        return run;
      }
      if (o.share() > before) run.nearest = text_of(c);
      if (o.share() >= share) best = c, share = o.share();
    }
    return run;
  }
  [[nodiscard]] std::string text(std::uint64_t seed, std::uint64_t index) const override {
    Random random(start_state(info_.name, seed, index));
    return text_of(draw_case<Case>(random));
  }
  [[nodiscard]] Outcome check(const std::string& text, const std::string& name, const Context& context) const override {
    const Case c = case_of<Case>(text, name);
    return guarded([&] { return c.check(context); });
  }
  [[nodiscard]] std::string shrink(const std::string& text, const Context& context,
                                   const std::function<bool()>& stop) const override {
    rc::Shrinkable<Case> best = shrinkable_case(case_of<Case>(text, info_.name));
    for (bool found = true; found && !stop();) {
      found = false;
      for (rc::Seq<rc::Shrinkable<Case>> ways = best.shrinks(); !stop();) {
        const auto next = ways.next();
        if (!next) break;
        const Case c = next->value();
        if (guarded([&] { return c.check(context); }).wrong.empty()) continue;
        best = *next;
        found = true;
        break;
      }
    }
    return text_of(best.value());
  }
  [[nodiscard]] std::string reread(const std::string& text) const override {
    return text_of(case_of<Case>(text, info_.name));
  }

 private:
  static Case changed(const Case& from, Random& random) {
    Case c = from;
    CountFields count;
    c.fields(count);
    MutateFields mutate(random, 1.5 / static_cast<double>(count.count() + 1));
    c.fields(mutate);
    settle(c);
    return c;
  }
};

using Families = std::vector<std::unique_ptr<Family>>;

template <class Case>
void add_family(Families& to, FamilyInfo info) {
  to.push_back(std::make_unique<FamilyOf<Case>>(std::move(info)));
}

/// All families, by number, and the bounds beside them.
const Families& all_families();
/// The family of a name; nullptr if there is none.
const Family* family_named(const std::string& name);

}  // namespace kage::verif

namespace rc {

/// So that rc::check() takes properties of cases.
template <kage::verif::IsCase Case>
struct Arbitrary<Case> {
  static Gen<Case> arbitrary() { return kage::verif::case_generator<Case>(); }
};

}  // namespace rc
