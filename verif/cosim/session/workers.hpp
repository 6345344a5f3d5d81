// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace kage::cosim {

/// Threads that do the same work, joined at the end. Where the system gives no more threads, or no memory for one,
/// there are fewer: those that there are do all of the work, and where there is none its caller does.
class Workers {
 public:
  /// `work` must not throw.
  Workers(int count, const std::function<void()>& work) {
    try {
      for (int i = 0; i < count; ++i) threads_.emplace_back(work);
    } catch (const std::system_error&) {
    } catch (const std::bad_alloc&) {
    }
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] int count() const { return static_cast<int>(threads_.size()); }

 private:
  std::vector<std::jthread> threads_;
};

}  // namespace kage::cosim
