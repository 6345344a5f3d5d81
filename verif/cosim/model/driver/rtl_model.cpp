// SPDX-License-Identifier: Apache-2.0
//
// The table of functions that a model's library gives. See rtl_model.h.
#include "rtl_model.h"

#include <new>
#include <utility>
#include <vector>

#include "lines.hpp"
#include "model.hpp"

namespace {

const kage_rtl_table kTable = {
    KAGE_RTL_ABI,
    kParamCount,
    kParamNames,
    kParamValues,
    kFault,
    kMutants,
    kMissingMonitors,
    kUnwatched,
#ifdef KAGE_MONITORS
    1,
#else
    0,
#endif
    [](std::uint64_t seed) { return new (std::nothrow) kage_rtl(seed); },
    [](kage_rtl* m) { delete m; },
    [](kage_rtl* m, int mutant) {
      if (mutant < 0 || mutant > kMutants) return -1;
      m->mutant = mutant;
      return 0;
    },
    [](kage_rtl* m, int on) { m->context.assertOn(on != 0); },
    [](kage_rtl* m, void (*text)(void* user, const char* piece), void* user) {
      m->text = text;
      m->text_user = user;
    },
    [](kage_rtl* m) { return m->failure.c_str(); },
    [](kage_rtl* m, std::uint32_t clocks) { m->reset(clocks); },
    [](kage_rtl* m, std::uint32_t input, std::uint32_t output, std::uint64_t seed) { m->stalls(input, output, seed); },
    [](kage_rtl* m, const std::uint32_t* words, std::size_t count, int last) {
      if (count == 0) return;
      kage_rtl::Block b{std::vector<std::uint32_t>(words, words + count), {}, last != 0};
      b.words.resize((count + kBeatWords - 1) / kBeatWords * kBeatWords, 0);
      b.marks.swap(m->next_marks);
      b.marks.resize(b.words.size(), 0);
      m->queue.push_back(std::move(b));
    },
    [](kage_rtl* m, const std::uint8_t* marks, std::size_t count) {
      m->next_marks.assign(marks, marks + count);
      for (std::uint8_t& mark : m->next_marks) mark %= KAGE_RTL_MARKS;
    },
    [](kage_rtl* m, std::uint32_t width, std::uint32_t height) {
      if (width > 0 && height > 0) m->expected.push_back({width, height});
    },
    [](kage_rtl* m, std::uint64_t pixels, std::uint64_t clocks) { return m->run(pixels, clocks); },
    [](kage_rtl* m, std::uint64_t clocks) { return m->run_dry(clocks); },
    [](kage_rtl* m, std::uint64_t* count) -> const std::uint8_t* {
      *count = m->pixel_count;
      return m->pixels.data();
    },
    [](kage_rtl* m) {
      m->pixels.clear();
      m->pixel_count = 0;
    },
    [](kage_rtl* m, std::uint32_t address, std::uint32_t* value) { return m->read(address, value); },
    [](kage_rtl* m, std::uint32_t address, std::uint32_t value) { return m->write(address, value); },
    [](kage_rtl* m, kage_rtl_access* write, kage_rtl_access* read) { m->access(write, read); },
    [](kage_rtl* m) -> int { return m->top->irq_o; },
    [](kage_rtl* m, kage_rtl_stats* out) { *out = m->stats; },
    [](kage_rtl* m) { m->stats = {}; },
    [](kage_rtl* m) { return m->clocks; },
#ifdef KAGE_MONITORS
    [](kage_rtl* m, int on) {
      m->recording = on != 0;
      return 0;
    },
#else
    [](kage_rtl*, int) { return -1; },
#endif
    [](kage_rtl* m, std::uint64_t* count) -> const kage_rtl_event* {
      *count = m->events.size();
      return m->events.data();
    },
    [](kage_rtl* m) { m->events.clear(); },
#ifdef KAGE_MONITORS
    [](kage_rtl* m) { return m->handshakes; },
#else
    [](kage_rtl*) -> std::int64_t { return -1; },
#endif
#ifdef KAGE_WAVES
    [](kage_rtl* m, const char* path, std::uint64_t first, std::uint64_t last) {
      m->close_wave();
      m->wave_path = path;
      m->wave_first = first;
      m->wave_last = last;
      wave_error = 0;
      return 0;
    },
    [](kage_rtl* m) {
      m->close_wave();
      return wave_error;
    },
#else
    [](kage_rtl*, const char*, std::uint64_t, std::uint64_t) { return -1; },
    [](kage_rtl*) { return -1; },
#endif
#ifdef KAGE_LINES
    [](kage_rtl* m, void (*point)(void* user, const char* place, std::uint64_t count), void* user) {
      return tell_lines(m->context, point, user);
    },
#else
    [](kage_rtl*, void (*)(void*, const char*, std::uint64_t), void*) { return -1; },
#endif
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const kage_rtl_table* kage_rtl_api(void) { return &kTable; }
