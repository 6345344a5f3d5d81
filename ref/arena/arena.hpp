// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <memory>
#include <mutex>
#include <new>

#include "arena/handoff.hpp"

namespace kage {

/// Threads that work for the one that calls execute(): so many with it, 0: as many as there are processors.
class Arena {
 public:
  explicit Arena(int threads) : arena_(threads > 0 ? threads : tbb::task_arena::automatic) {
    if (threads > 0) allow(static_cast<std::size_t>(threads));
  }

  /// Throws std::bad_alloc if there is no memory for the threads' books.
  template <class Work>
  void execute(Work work) {
    if (!arena_.is_active()) start();
    arena_.execute(work);
  }

  /// Runs `body(some)` over parts of a range of oneTBB's, on all threads, until all is done. Throws what `body` throws,
  /// and as execute().
  template <class Range, class Body>
  void for_each(const Range& range, Body body) {
    const char begun = 0;
    const char done = 0;
    hand_on(&begun);
    execute([&] {
      tbb::parallel_for(range, [&](const Range& some) {
        take_over(&begun);
        body(some);
        hand_on(&done);
      });
    });
    take_over(&done);
  }

 private:
  /// Lets oneTBB run `threads` threads. Its default limit is the number of processors, and it writes a warning where an
  /// arena asks for more. The least of several limits counts, so there is only one here, and it only rises.
  static void allow(std::size_t threads) {
    static std::mutex mutex;
    static std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    static std::unique_ptr<tbb::global_control>& order = *new std::unique_ptr<tbb::global_control>();
    const std::lock_guard lock(mutex);
    if (threads <= allowed) return;
    order.reset();
    order = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, threads);
    allowed = threads;
  }

  // oneTBB 2022 that finds no memory while it sets up an arena waits for ever for a lock that it holds itself, so the
  // memory is asked for before, and more than it takes.
  static constexpr std::size_t kBooks = std::size_t{4} << 20;

  void start() {
    void* volatile books = ::operator new(kBooks);
    ::operator delete(books);
    arena_.initialize();
  }

  tbb::task_arena arena_;
};

}  // namespace kage
