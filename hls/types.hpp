// SPDX-License-Identifier: Apache-2.0

/// @file
/// Integers of exact widths for the kernels: hw::u<N> and hw::s<N>, N = 1 .. 64.
///
/// One of four implementations stands behind the names:
///
/// * `-DKAGE_HLS_AC`: the Algorithmic C types, ac_int, for Catapult.
/// * `-DKAGE_HLS_AP`: AMD's types, ap_int, for Vitis HLS.
/// * `-DKAGE_HLS_BITS`: clang's own integers, _BitInt, for hls/tool: the compiler's intermediate code then has the very
///   widths.
/// * none of these: the plain class of this file, for tests.
///
/// They differ in the width of a sum. So that all give the same bits, kernels keep one rule, and the plain class turns
/// every breach of it into a compile error:
///
/// * Both operands of an operator have the type that the result shall have, and the result is stored in a variable of
///   that type, or converted to it, before anything else is done with it. It wraps.
/// * Changes of width are written out: a constructor wraps, or extends by the source's sign; hw::slice<M>(v, lo)
///   takes M bits.
/// * Shifts are by constants from 0 to N - 1, and keep the type.
#pragma once

#include <cstdint>

#if defined(KAGE_HLS_AC)
#include <ac_int.h>
#elif defined(KAGE_HLS_AP)
#include <ap_int.h>
#else
#include <type_traits>
#endif

namespace hw {

#if defined(KAGE_HLS_AC)

template <int N>
using u = ac_int<N, false>;
template <int N>
using s = ac_int<N, true>;

/// The M bits of `v` from bit `lo` on, unsigned.
template <int M, int N, bool S>
u<M> slice(const ac_int<N, S>& v, int lo) {
  return v.template slc<M>(lo);
}
/// As a C++ integer, for code outside kernels.
template <int N>
std::int64_t value(const ac_int<N, true>& v) {
  return v.to_int64();
}
template <int N>
std::int64_t value(const ac_int<N, false>& v) {
  return static_cast<std::int64_t>(v.to_uint64());
}

#elif defined(KAGE_HLS_AP)

template <int N>
using u = ap_uint<N>;
template <int N>
using s = ap_int<N>;

template <int M, int N>
u<M> slice(const ap_int<N>& v, int lo) {
  return v.range(lo + M - 1, lo);
}
template <int M, int N>
u<M> slice(const ap_uint<N>& v, int lo) {
  return v.range(lo + M - 1, lo);
}
template <int N>
std::int64_t value(const ap_int<N>& v) {
  return v.to_int64();
}
template <int N>
std::int64_t value(const ap_uint<N>& v) {
  return static_cast<std::int64_t>(v.to_uint64());
}

#elif defined(KAGE_HLS_BITS)

template <int N>
using u = unsigned _BitInt(N);
template <int N>
using s = signed _BitInt(N);

template <int M, int N>
constexpr u<M> slice(unsigned _BitInt(N) v, int lo) {
  return static_cast<u<M> >(v >> lo);
}
template <int M, int N>
constexpr u<M> slice(signed _BitInt(N) v, int lo) {
  return static_cast<u<M> >(static_cast<u<N> >(v) >> lo);
}

#else

template <int N, bool S>
class Int;
template <int N>
using u = Int<N, false>;
template <int N>
using s = Int<N, true>;

namespace plain {

template <int N, bool S>
struct Raw {
  using type = std::conditional_t<S, std::int64_t, std::uint64_t>;
};
template <int N, bool S>
constexpr typename Raw<N, S>::type wrap(typename Raw<N, S>::type v) {
  using To = typename Raw<N, S>::type;
  return static_cast<To>(static_cast<To>(static_cast<std::uint64_t>(v) << (64 - N)) >> (64 - N));
}

}  // namespace plain

/// A result on its way to its variable: all that can be done with it is to store it in one of its own type.
template <int N, bool S>
struct Result {
  typename plain::Raw<N, S>::type raw;
};

template <int N, bool S>
class Int {
 public:
  static_assert(N >= (S ? 2 : 1) && N <= 64);
  using Raw = typename plain::Raw<N, S>::type;

  Int() = default;  // of any value, as in the vendors' types
  // Implicit, as a result is stored by being converted.
  constexpr Int(Result<N, S> r) : raw_(r.raw) {}  // NOLINT(google-explicit-constructor)
  constexpr explicit Int(bool v) : raw_(static_cast<Raw>(v)) {}
  constexpr explicit Int(int v) : raw_(plain::wrap<N, S>(static_cast<Raw>(v))) {}
  constexpr explicit Int(std::int64_t v) : raw_(plain::wrap<N, S>(static_cast<Raw>(v))) {}
  constexpr explicit Int(std::uint64_t v) : raw_(plain::wrap<N, S>(static_cast<Raw>(v))) {}
  template <int M, bool T>
  constexpr explicit Int(const Int<M, T>& v) : raw_(plain::wrap<N, S>(static_cast<Raw>(v.raw()))) {}

  [[nodiscard]] constexpr Raw raw() const { return raw_; }

  friend constexpr Result<N, S> operator+(Int a, Int b) { return result(bits(a) + bits(b)); }
  friend constexpr Result<N, S> operator-(Int a, Int b) { return result(bits(a) - bits(b)); }
  friend constexpr Result<N, S> operator*(Int a, Int b) { return result(bits(a) * bits(b)); }
  friend constexpr Result<N, S> operator&(Int a, Int b) { return result(bits(a) & bits(b)); }
  friend constexpr Result<N, S> operator|(Int a, Int b) { return result(bits(a) | bits(b)); }
  friend constexpr Result<N, S> operator^(Int a, Int b) { return result(bits(a) ^ bits(b)); }
  friend constexpr Result<N, S> operator<<(Int a, int by) { return result(bits(a) << by); }
  friend constexpr Result<N, S> operator>>(Int a, int by) { return {static_cast<Raw>(a.raw_ >> by)}; }
  friend constexpr bool operator==(Int a, Int b) { return a.raw_ == b.raw_; }
  friend constexpr bool operator!=(Int a, Int b) { return a.raw_ != b.raw_; }
  friend constexpr bool operator<(Int a, Int b) { return a.raw_ < b.raw_; }
  friend constexpr bool operator<=(Int a, Int b) { return a.raw_ <= b.raw_; }
  friend constexpr bool operator>(Int a, Int b) { return a.raw_ > b.raw_; }
  friend constexpr bool operator>=(Int a, Int b) { return a.raw_ >= b.raw_; }

 private:
  // Unsigned, which wraps by definition.
  using Bits = typename plain::Raw<N, false>::type;
  static constexpr Bits bits(Int a) { return static_cast<Bits>(a.raw_); }
  static constexpr Result<N, S> result(Bits v) { return {plain::wrap<N, S>(static_cast<Raw>(v))}; }

  Raw raw_;
};

/// The M bits of `v` from bit `lo` on, unsigned.
template <int M, int N, bool S>
constexpr u<M> slice(const Int<N, S>& v, int lo) {
  return u<M>(u<N>(u<N>(v) >> lo));
}
/// As a C++ integer, for code outside kernels.
template <int N, bool S>
constexpr std::int64_t value(const Int<N, S>& v) {
  return static_cast<std::int64_t>(v.raw());
}

#endif

}  // namespace hw
