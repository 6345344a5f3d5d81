// SPDX-License-Identifier: Apache-2.0
//
// Where volumes and light samples end on a line, and what range they have: the EV, ES and RESOLVE that frames at the
// polygon level do without.
#pragma once

#include <algorithm>

#include "kage/token.hpp"
#include "polygon/place.hpp"

namespace kage {

class VolumeEnds {
 public:
  explicit VolumeEnds(const Config& config) : config_(config) {}

  /// A line begins.
  void start() { any_ = in_volume_ = in_sample_ = in_light_ = false; }

  /// A token of a volume at this place comes, over pixels [xl, xr); emit(token) what ends before it.
  template <class Emit>
  ErrorCode token(Place place, int xl, int xr, Emit emit) {
    if (in_volume_ && place.volume() != place_.volume())
      if (const ErrorCode e = end_volume(emit); e != ErrorCode::NONE) return e;
    if (in_sample_ && place.sample() != place_.sample())
      if (const ErrorCode e = end_sample(emit); e != ErrorCode::NONE) return e;
    volume_.add(in_volume_, xl, xr);
    any_ = in_volume_ = true;
    in_light_ = false;
    place_ = place;
    return ErrorCode::NONE;
  }

  /// One of a light's own spans at this place comes: emit(token) the ends of its volumes, and its RESOLVE.
  template <class Emit>
  ErrorCode light(Place place, Emit emit) {
    if (in_light_ && place.volume() == place_.volume()) return ErrorCode::NONE;
    if (const ErrorCode e = end_volumes(emit); e != ErrorCode::NONE) return e;
    in_light_ = true;
    place_ = place;
    return resolve(place.samples(config_), emit);
  }

  /// No more volumes on this line: emit(token) their ends and RESOLVE, if there were any.
  template <class Emit>
  ErrorCode end(Emit emit) {
    if (!any_) return ErrorCode::NONE;
    if (const ErrorCode e = end_volumes(emit); e != ErrorCode::NONE) return e;
    return resolve(0, emit);
  }

 private:
  struct Range {
    int xl = 0;
    int xr = 0;
    void add(bool open, int from, int to) {
      xl = open ? std::min(xl, from) : from;
      xr = open ? std::max(xr, to) : to;
    }
  };

  /// Ends the volume and the sample that are open.
  template <class Emit>
  ErrorCode end_volumes(Emit emit) {
    if (in_volume_)
      if (const ErrorCode e = end_volume(emit); e != ErrorCode::NONE) return e;
    return in_sample_ ? end_sample(emit) : ErrorCode::NONE;
  }

  template <class Emit>
  ErrorCode resolve(int samples, Emit emit) {
    any_ = false;
    Token t;
    t.kind = Kind::RESOLVE;
    t.samples = samples;
    return emit(t);
  }

  template <class Emit>
  ErrorCode end_volume(Emit emit) {
    sample_.add(in_sample_, volume_.xl, volume_.xr);
    in_sample_ = true;
    in_volume_ = false;
    return config_.fsf != 0 ? emit(made(Kind::EV, volume_)) : ErrorCode::NONE;
  }

  template <class Emit>
  ErrorCode end_sample(Emit emit) {
    in_sample_ = false;
    return config_.count_bits > 0 ? emit(made(Kind::ES, sample_)) : ErrorCode::NONE;
  }

  [[nodiscard]] Token made(Kind kind, const Range& range) const {
    Token t;
    t.kind = kind;
    t.span.xl = range.xl;
    t.span.xr = range.xr;
    t.table.light = place_.light();
    return t;
  }

  Config config_;
  bool any_ = false;
  bool in_volume_ = false;
  bool in_sample_ = false;
  bool in_light_ = false;  // the light at hand has its RESOLVE
  Place place_;            // of the open ones, or of that light
  Range volume_;
  Range sample_;
};

}  // namespace kage
