// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <system_error>
#include <thread>
#include <vector>

namespace kage::cli {

/// Threads that do the same work, joined at the end. Where the system gives no more threads there are fewer.
class Workers {
 public:
  /// `work` must not throw.
  Workers(int count, const std::function<void()>& work) {
    try {
      for (int i = 0; i < count; ++i) threads_.emplace_back(work);
    } catch (const std::system_error&) {  // those that there are do all of it
    }
  }
  ~Workers() {
    for (std::thread& t : threads_) t.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] int count() const { return static_cast<int>(threads_.size()); }

 private:
  std::vector<std::thread> threads_;
};

}  // namespace kage::cli
