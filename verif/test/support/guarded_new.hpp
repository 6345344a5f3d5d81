// SPDX-License-Identifier: Apache-2.0
//
// All that `new` gives while a GuardedNew lives lies beside a page that cannot be touched, so that a class which keeps
// its buffers to itself can be tested as guarded.hpp's own buffers are. A program that uses it is linked with
// guarded_new.cpp, which replaces the program's `new` and `delete`.
#pragma once

#include <cstdint>

#include "test/support/guarded.hpp"

namespace kage::verif {

/// One at a time. Its memory may be freed later.
class GuardedNew {
 public:
  /// Edge::kEnd: `new` aligns to 16 bytes, so up to 15 lie behind what was asked for. Edge::kBegin: up to a page does.
  /// Whether anything was written there is looked at when the memory is freed; if so, the program is aborted.
  explicit GuardedNew(Edge edge);
  ~GuardedNew();
  GuardedNew(const GuardedNew&) = delete;
  GuardedNew& operator=(const GuardedNew&) = delete;

  /// How many times memory was given so since the program began.
  static std::uint64_t given();

  /// Whether it was more than so many times. True under the address sanitizer, which guards all memory on its own.
  static bool gave_more_than(std::uint64_t times);
};

}  // namespace kage::verif
