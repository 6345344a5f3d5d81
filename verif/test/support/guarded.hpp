// SPDX-License-Identifier: Apache-2.0
//
// Memory that ends where it says: the pages before and behind it cannot be touched, so that reading or writing past
// either end stops the test program (SIGSEGV). The sanitizers find most of that too, but not in every build and for
// every instruction set.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>

namespace kage::verif {

/// Which end of the memory lies right at a page that cannot be touched. At the other end up to a page lies between.
enum class Edge { kBegin, kEnd };
inline constexpr Edge kEdges[] = {Edge::kBegin, Edge::kEnd};

/// `count` elements. With Edge::kEnd and an `alignment` larger than the element's, as many bytes as the alignment needs
/// may lie behind them.
template <class T>
class Guarded {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Guarded(std::size_t count, Edge edge, std::size_t alignment = alignof(T)) : count_(count) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t bytes = (count * sizeof(T) + alignment - 1) / alignment * alignment;
    const std::size_t inside = (bytes + page - 1) / page * page;
    mapped_ = inside + 2 * page;
    void* const all = mmap(nullptr, mapped_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (all == MAP_FAILED) throw std::bad_alloc();
    all_ = static_cast<std::byte*>(all);
    if (inside != 0 && mprotect(all_ + page, inside, PROT_READ | PROT_WRITE) != 0) throw std::bad_alloc();
    data_ = reinterpret_cast<T*>(all_ + page + (edge == Edge::kEnd ? inside - bytes : 0));
  }
  Guarded(std::span<const T> values, Edge edge, std::size_t alignment = alignof(T))
      : Guarded(values.size(), edge, alignment) {
    if (!values.empty()) std::memcpy(data_, values.data(), values.size_bytes());
  }
  ~Guarded() { munmap(all_, mapped_); }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

  [[nodiscard]] T* data() { return data_; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] T& operator[](std::size_t i) { return data_[i]; }
  [[nodiscard]] T* begin() { return data_; }
  [[nodiscard]] T* end() { return data_ + count_; }
  [[nodiscard]] std::span<const T> values() const { return {data_, count_}; }

  bool operator==(const Guarded& other) const {
    return count_ == other.count_ && (count_ == 0 || std::memcmp(data_, other.data_, count_ * sizeof(T)) == 0);
  }

 private:
  std::size_t count_;
  std::size_t mapped_ = 0;
  std::byte* all_ = nullptr;
  T* data_ = nullptr;
};

}  // namespace kage::verif
