// SPDX-License-Identifier: Apache-2.0
//
// What oneTBB orders, for the sanitizer of threads: what a thread has done before it hands work on is seen by the
// thread that takes it. The library is not built with the sanitizer, which therefore has to be told; elsewhere this
// does nothing.
#pragma once

#if defined(__SANITIZE_THREAD__)
#define KAGE_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define KAGE_THREAD_SANITIZER
#endif
#endif

#ifdef KAGE_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace kage {

/// Work that lies at this address is handed on.
inline void hand_on([[maybe_unused]] const void* work) {
#ifdef KAGE_THREAD_SANITIZER
  __tsan_release(const_cast<void*>(work));
#endif
}

/// Work that lies at this address is taken by the thread that asks.
inline void take_over([[maybe_unused]] const void* work) {
#ifdef KAGE_THREAD_SANITIZER
  __tsan_acquire(const_cast<void*>(work));
#endif
}

}  // namespace kage
