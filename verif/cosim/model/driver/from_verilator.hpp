// SPDX-License-Identifier: Apache-2.0
//
// Functions in from_verilator.cpp that Verilator's own code calls: build.py sees to it.
#pragma once

#include <cstddef>
#include <cstdint>

/// In place of printf(), for what the RTL writes: see on_text of rtl_model.h.
int kage_printf(const char* format, ...) __attribute__((format(printf, 1, 2)));

// The first value of every register and memory, in place of Verilator's random ones.

/// So many bits, up to 64, that follow from the model's seed, the name and the index.
std::uint64_t kage_initial(unsigned bits, const char* name, std::uint64_t index);

/// Likewise of a word array of Verilator's: its element `index`, where it is in a memory.
template <class Words>
void kage_initial_words(unsigned bits, Words& words, const char* name, std::uint64_t index) {
  constexpr std::uint64_t kWordAt = std::uint64_t{1} << 40;  // past any memory's places
  for (unsigned word = 0; word * 32 < bits; ++word)
    words[word] = static_cast<std::uint32_t>(
        kage_initial(bits - word * 32 < 32 ? bits - word * 32 : 32, name, index + (word + 1) * kWordAt));
}
