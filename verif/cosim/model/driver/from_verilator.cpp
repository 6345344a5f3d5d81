// SPDX-License-Identifier: Apache-2.0
//
// Functions that Verilator's own code calls: for a waveform's file, events, text, initial values, assertions.
#include "from_verilator.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <string>

#include "model.hpp"
#if defined(KAGE_MONITORS) || defined(KAGE_MUTANTS)
#include "Vkage__Dpi.h"
#endif
#ifdef KAGE_MONITORS
#include "stages.h"
#endif

#ifdef KAGE_WAVES
// The library is linked so that these take the place of the C functions (build.py: --wrap). Verilator's writer of FST
// does not check whether its writes succeed. stdio keeps the error with the file until it is closed.
extern "C" {
size_t __real_fwrite(const void* data, size_t size, size_t count, FILE* file);
int __real_fputc(int byte, FILE* file);
int __real_fseeko(FILE* file, off_t offset, int whence);
int __real_fflush(FILE* file);
int __real_fclose(FILE* file);

static void note_wave_error(const FILE* file, bool failed) {
  if (failed && wave_error == 0 && file != stderr && file != stdout) wave_error = errno != 0 ? errno : EIO;
}
size_t __wrap_fwrite(const void* data, size_t size, size_t count, FILE* file) {
  const size_t written = __real_fwrite(data, size, count, file);
  note_wave_error(file, written != count);
  return written;
}
int __wrap_fputc(int byte, FILE* file) {
  const int written = __real_fputc(byte, file);
  note_wave_error(file, written == EOF);
  return written;
}
// It writes what is in the buffer.
int __wrap_fseeko(FILE* file, off_t offset, int whence) {
  const int failed = __real_fseeko(file, offset, whence);
  note_wave_error(file, failed != 0);
  return failed;
}
int __wrap_fflush(FILE* file) {
  const int failed = __real_fflush(file);
  note_wave_error(file, failed != 0);
  return failed;
}
int __wrap_fclose(FILE* file) {
  errno = 0;
  const bool failed = __real_fflush(file) != 0 || ferror(file) != 0;
  note_wave_error(file, failed);
  return __real_fclose(file);
}
}
#endif

#ifdef KAGE_MONITORS
// Called by verif/cosim/diverge/monitors.
void kage_trace(int stage, int unit, const svBitVecVal* values) {
  kage_rtl& m = *current;
  if (!m.recording) return;
  if (stage == KAGE_STAGE_HANDSHAKE) {
    m.handshakes = values[0];
    return;
  }
  kage_rtl_event& e = m.events.emplace_back();
  e.clock = m.clocks;
  e.stage = stage;
  e.unit = unit;
  for (int i = 0; i < KAGE_RTL_EVENT_VALUES; ++i)
    e.value[i] = values[2 * i] | static_cast<std::uint64_t>(values[2 * i + 1]) << 32;
}

// The event of stage `part` in rtl/defs/stages.yaml: the part, then the lowest 64 bits that differ.
void kage_trace_part(int part, const svBitVecVal* expected, const svBitVecVal* actual) {
  int i = 0;
  while (i < 14 && expected[i] == actual[i] && expected[i + 1] == actual[i + 1]) i += 2;
  const svBitVecVal values[2 * KAGE_RTL_EVENT_VALUES] = {
      static_cast<svBitVecVal>(part), 0, expected[i], expected[i + 1], actual[i], actual[i + 1]};
  kage_trace(KAGE_STAGE_PART, 0, values);
}
#endif

int kage_printf(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  int length = 0;
  if (current == nullptr || current->text == nullptr) {
    length = std::vfprintf(stderr, format, arguments);
  } else {
    std::va_list again;
    va_copy(again, arguments);
    length = std::max(0, std::vsnprintf(nullptr, 0, format, again));
    va_end(again);
    std::string piece(static_cast<std::size_t>(length), '\0');
    std::vsnprintf(piece.data(), piece.size() + 1, format, arguments);
    current->text(current->text_user, piece.c_str());
  }
  va_end(arguments);
  return length;
}

// FNV-1a of the name, then the mixer of splitmix64, so that neighbours in a memory have nothing in common.
std::uint64_t kage_initial(unsigned bits, const char* name, std::uint64_t index) {
  std::uint64_t value = 0xCBF29CE484222325ULL;
  for (; *name != 0; ++name) value = (value ^ static_cast<unsigned char>(*name)) * 0x100000001B3ULL;
  for (const std::uint64_t part : {current->initial, index}) {
    value += part + 0x9E3779B97F4A7C15ULL;
    value = (value ^ value >> 30) * 0xBF58476D1CE4E5B9ULL;
    value = (value ^ value >> 27) * 0x94D049BB133111EBULL;
    value ^= value >> 31;
  }
  return bits >= 64 ? value : value & ((std::uint64_t{1} << bits) - 1);
}

#ifdef KAGE_MUTANTS
// Called by kage_top in reset.
int kage_mutant() { return current->mutant; }
#endif

// Called by Verilator when an assertion fails, once its message is out.
void vl_stop(const char* file, int line, const char* /*scope*/) {
  const std::string path = file == nullptr ? "" : file;
  if (current->failure.empty()) current->failure = path.substr(path.rfind('/') + 1) + ":" + std::to_string(line);
  current->context.gotError(true);
  current->context.gotFinish(true);
  Verilated::runFlushCallbacks();
}
