// SPDX-License-Identifier: Apache-2.0
#include "test/support/guarded_new.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace kage::verif {
namespace {

enum class Mode { kOff, kBegin, kEnd };

// Constant initialisation: `new` is called before any constructor of this program has run.
constinit std::atomic<Mode> mode{Mode::kOff};
constinit std::atomic<std::uint64_t> given_count{0};

}  // namespace

GuardedNew::GuardedNew(Edge edge) { mode = edge == Edge::kEnd ? Mode::kEnd : Mode::kBegin; }
GuardedNew::~GuardedNew() { mode = Mode::kOff; }
std::uint64_t GuardedNew::given() { return given_count; }

bool GuardedNew::gave_more_than([[maybe_unused]] std::uint64_t times) {
#ifdef __SANITIZE_ADDRESS__
  return true;
#else
  return given_count > times;
#endif
}

#ifndef __SANITIZE_ADDRESS__
namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kRegion = std::size_t{1} << 36;  // addresses alone; none is used twice
constexpr unsigned char kUnwritten = 0xA5;

/// Before what is given, on a page of its own.
struct Block {
  std::size_t pages;  // that can be touched, after the header's and a page that cannot
  unsigned char* data;
  std::size_t bytes;
};

constinit std::atomic<unsigned char*> region{nullptr};
constinit std::atomic<std::size_t> used{0};

unsigned char* the_region() {
  unsigned char* found = region;
  if (found != nullptr) return found;
  void* const fresh = mmap(nullptr, kRegion, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (fresh == MAP_FAILED) return nullptr;
  if (region.compare_exchange_strong(found, static_cast<unsigned char*>(fresh)))
    return static_cast<unsigned char*>(fresh);
  munmap(fresh, kRegion);
  return found;
}

/// Header page, page that cannot be touched, pages of the data, page that cannot be touched.
void* give_guarded(std::size_t bytes, std::size_t alignment) {
  unsigned char* const base = the_region();
  const std::size_t pages = std::max<std::size_t>(1, (bytes + kPage - 1) / kPage);
  const std::size_t whole = (pages + 3) * kPage;
  const std::size_t at = used.fetch_add(whole);
  if (base == nullptr || alignment > kPage || at + whole > kRegion) return nullptr;
  unsigned char* const first = base + at + 2 * kPage;
  if (mprotect(base + at, kPage, PROT_READ | PROT_WRITE) != 0) return nullptr;
  if (mprotect(first, pages * kPage, PROT_READ | PROT_WRITE) != 0) return nullptr;
  std::memset(first, kUnwritten, pages * kPage);
  const std::size_t begin = mode == Mode::kEnd ? (pages * kPage - bytes) / alignment * alignment : 0;
  *reinterpret_cast<Block*>(base + at) = {pages, first + begin, bytes};
  ++given_count;
  return first + begin;
}

bool unwritten(const unsigned char* from, const unsigned char* to) {
  return std::all_of(from, to, [](unsigned char c) { return c == kUnwritten; });
}

/// Whether `p` was given here; then it is freed.
bool free_guarded(void* p) {
  unsigned char* const base = region;
  auto* const data = static_cast<unsigned char*>(p);
  if (base == nullptr || data < base || data >= base + kRegion) return false;
  const std::size_t offset = static_cast<std::size_t>(data - base) / kPage * kPage;
  // The data begins on its first page: at most a page lies before it.
  unsigned char* const first = base + offset;
  unsigned char* const header = first - 2 * kPage;
  const Block block = *reinterpret_cast<Block*>(header);
  unsigned char* const end = first + block.pages * kPage;
  if (block.data != data || !unwritten(first, data) || !unwritten(data + block.bytes, end)) {
    std::fputs("guarded memory: written before or behind a block\n", stderr);
    std::abort();
  }
  (void)mprotect(first, block.pages * kPage, PROT_NONE);
  (void)madvise(first, block.pages * kPage, MADV_DONTNEED);
  (void)mprotect(header, kPage, PROT_NONE);
  (void)madvise(header, kPage, MADV_DONTNEED);
  return true;
}

void* give(std::size_t bytes, std::size_t alignment) {
  if (mode != Mode::kOff)
    if (void* const p = give_guarded(bytes, alignment)) return p;
  void* const p = alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__
                      ? std::malloc(bytes != 0 ? bytes : 1)
                      : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}

void take_back(void* p) {
  if (p != nullptr && !free_guarded(p)) std::free(p);
}

}  // namespace
#endif

}  // namespace kage::verif

#ifndef __SANITIZE_ADDRESS__
// new[] and the forms that do not throw call these.
void* operator new(std::size_t bytes) { return kage::verif::give(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return kage::verif::give(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept { kage::verif::take_back(p); }
void operator delete(void* p, std::size_t /*bytes*/) noexcept { kage::verif::take_back(p); }
void operator delete(void* p, std::align_val_t /*alignment*/) noexcept { kage::verif::take_back(p); }
void operator delete(void* p, std::size_t /*bytes*/, std::align_val_t /*alignment*/) noexcept {
  kage::verif::take_back(p);
}
#endif
