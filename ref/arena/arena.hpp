// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/task_arena.h>

#include <cstddef>
#include <new>

namespace kage {

/// Threads that work for the one that calls execute(): so many with it, 0: as many as there are processors.
class Arena {
 public:
  explicit Arena(int threads) : arena_(threads > 0 ? threads : tbb::task_arena::automatic) {}

  /// Throws std::bad_alloc if there is no memory for the threads' books.
  template <class Work>
  void execute(Work work) {
    if (!arena_.is_active()) start();
    arena_.execute(work);
  }

 private:
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
