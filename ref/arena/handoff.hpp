// SPDX-License-Identifier: Apache-2.0
//
// Annotations for the thread sanitizer: a thread that takes work from oneTBB sees all that the giving thread did
// before. oneTBB is not built with the sanitizer, so the sanitizer cannot find this order itself. Without the sanitizer
// these functions do nothing.
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
