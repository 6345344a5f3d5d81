// SPDX-License-Identifier: Apache-2.0
//
// Which instruction set the vector kernels run on. Kernels are compiled for several; Highway calls each a target. Every
// call of a kernel goes through KAGE_DISPATCH, which takes the target in use: the best that this CPU has, or the one
// that the environment variable KAGE_SIMD names. No result depends on it; tests and speed measurements do.
//
// A file with kernels includes this before any header of Highway, because the macros below decide which targets exist,
// and must be the same in all files. HWY_COMPILE_ALL_ATTAINABLE, which the build defines, adds the targets that a
// better one makes superfluous, EMU128 among them: plain C++ in the place of vectors, which any machine can run.
#pragma once

// EMU128 knows every operation, HWY_SCALAR does not.
#define HWY_DISABLED_TARGETS HWY_SCALAR
#define HWY_BROKEN_EMU128 0
#include <hwy/targets.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kage::simd {

struct Target {
  std::int64_t bit = 0;  ///< Highway's number of it, such as HWY_AVX2
  std::string name;      ///< as KAGE_SIMD has it: avx3_dl, avx3, avx2, sse4, ssse3, sse2, emu128
};

/// All that this build has and this CPU can run, best first; at least one.
std::vector<Target> available();

/// The target in use. The first call of this or of any kernel chooses it. If KAGE_SIMD names an instruction set that
/// this build or this CPU does not have, each such call throws Error, in one line, until one has succeeded. An empty
/// KAGE_SIMD counts as none.
Target in_use();

/// For tests: from now on kernels run on this one of available().
void use(const Target& target);

/// The index of the target in use in the tables of HWY_EXPORT; for KAGE_DISPATCH alone.
inline constexpr std::size_t kNotChosen = static_cast<std::size_t>(-1);
extern std::atomic<std::size_t> chosen_index;
std::size_t choose();
inline std::size_t index() {
  const std::size_t i = chosen_index.load(std::memory_order_relaxed);
  return i != kNotChosen ? i : choose();
}

}  // namespace kage::simd

/// HWY_DYNAMIC_DISPATCH for the target in use. Highway's own choice is one for the whole process; libraries that use
/// Highway too keep it.
#define KAGE_DISPATCH(FUNCTION) (*(HWY_DISPATCH_TABLE(FUNCTION)[::kage::simd::index()]))
