// SPDX-License-Identifier: Apache-2.0
//
// The driver around a verilated kage_top: queues, stall patterns, checks of the video port. See rtl_model.h.
#include "rtl_model.h"

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <deque>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "Vkage.h"
#include "from_verilator.hpp"
#include "params.inc"  // made by build.py: kParamNames, kParamValues, kFault, kBeatWords, kChannels, kMaxWidth
#include "verilated.h"
#if defined(KAGE_MONITORS) || defined(KAGE_MUTANTS)
#include "Vkage__Dpi.h"
#endif
#ifdef KAGE_MONITORS
#include "stages.h"
#endif
#ifdef KAGE_WAVES
#include "verilated_fst_c.h"
#endif

namespace {

#ifdef KAGE_WAVES
/// The errno of what first could not be written of a waveform: 0 for nothing.
int wave_error = 0;
#endif

/// xorshift64*: small, and the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 0xD1B54A32D192ED03ULL) {
    if (state_ == 0) state_ = 1;
  }
  std::uint32_t next() {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return static_cast<std::uint32_t>(state_ * 0x2545F4914F6CDD1DULL >> 32);
  }
  std::uint32_t in(std::uint32_t least, std::uint32_t most) { return least + next() % (most - least + 1); }

 private:
  std::uint64_t state_;
};

/// A stream that goes in so many of 65536 clocks. It stops for a clock most often, sometimes for a burst of them, and
/// now and then for longer than any buffer lasts; what goes between two stops is as long as the share needs.
class Flow {
 public:
  explicit Flow(std::uint32_t share = 65536, std::uint64_t seed = 1)
      : random_(seed), share_(share < 65536 ? share : 65536) {
    if (share_ != 0 && share_ != 65536) go(1 + random_.in(0, 15));
  }

  /// Whether it goes in the next clock.
  bool next() {
    if (share_ == 0 || share_ == 65536) return share_ != 0;
    while (left_ == 0) going_ ? stop() : go(stopped_);
    --left_;
    return going_;
  }

 private:
  void stop() {
    const std::uint32_t manner = random_.in(0, 63);
    left_ = stopped_ = manner == 0 ? random_.in(64, 511) : manner < 9 ? random_.in(2, 32) : 1;
    going_ = false;
  }
  /// For as long as a stop of so many clocks asks for, on the average.
  void go(std::uint64_t stopped) {
    const std::uint64_t mean = stopped * share_ * 256 / (65536 - share_);  // in 1/256 clocks
    const std::uint64_t random = std::uint64_t{random_.next()} << 32 | random_.next();
    left_ = (random % (2 * mean + 1) + random_.in(0, 255)) / 256;
    going_ = true;
  }

  Random random_;
  std::uint32_t share_;
  bool going_ = true;
  std::uint64_t left_ = 0;
  std::uint64_t stopped_ = 0;
};

void put_words(IData& port, const std::uint32_t* words) { port = words[0]; }
void put_words(QData& port, const std::uint32_t* words) { port = words[0] | static_cast<QData>(words[1]) << 32; }
template <std::size_t N>
void put_words(VlWide<N>& port, const std::uint32_t* words) {
  for (std::size_t i = 0; i < N; ++i) port[i] = words[i];
}

struct Block {
  std::vector<std::uint32_t> words;  // whole beats
  std::vector<std::uint8_t> marks;   // of the words
  bool last;
};

struct Size {
  std::uint32_t width, height;
};

// Clocks without any movement after which the core counts as idle: more than the longest work on one token.
constexpr std::uint64_t kIdleClocks = 8ULL * kMaxWidth + 4096;

}  // namespace

struct kage_rtl;

namespace {
thread_local kage_rtl* current = nullptr;  // the model that this thread lets work
}

struct kage_rtl {
  std::uint64_t initial;  // the seed of registers and memories
  VerilatedContext context;
  std::unique_ptr<Vkage> top;
  Flow input, output;

  std::deque<Block> queue;
  std::size_t at = 0;                    // word of queue.front() that is offered next
  std::uint8_t mark = 0;                 // of that word, or of the last one if there is none
  std::vector<std::uint8_t> next_marks;  // of the words that are submitted next
  bool offered = false;

  std::deque<Size> expected;
  std::uint32_t x = 0, y = 0;
  std::vector<std::uint8_t> pixels;
  std::uint64_t pixel_count = 0;
  bool waiting = false;  // a pixel was there but not taken
  std::uint32_t waiting_value = 0;

  std::uint64_t quiet = 0;
  std::uint64_t clocks = 0;
  kage_rtl_stats stats{};

  int mutant = 0;
  std::string failure;  // the first assertion that failed
  void (*text)(void* user, const char* piece) = nullptr;
  void* text_user = nullptr;

  bool recording = false;
  std::vector<kage_rtl_event> events;
  std::int64_t handshakes = 0;
#ifdef KAGE_WAVES
  std::unique_ptr<VerilatedFstC> fst;
  std::string wave_path;
  std::uint64_t wave_first = 1, wave_last = 0;
#endif

  explicit kage_rtl(std::uint64_t seed) : initial(seed) {
#ifdef KAGE_WAVES
    context.traceEverOn(true);
#endif
    enter();
    context.threads(1);  // else each model starts a thread per processor, which none of its work goes to
    context.fatalOnError(false);
    top = std::make_unique<Vkage>(&context, "top");
    idle_inputs();
    top->clk_i = 0;
    top->rst_ni = 0;
    reset(2);
  }
  ~kage_rtl() {
    enter();
    close_wave();
    top->final();
    top.reset();
  }

  // Verilator books failed assertions, and a model's end, to the context of the thread, which is that of the model made
  // last on it. So every call that lets time pass or ends a model begins with this.
  void enter() {
    Verilated::threadContextp(&context);
    current = this;
  }

  void idle_inputs() {
    top->s_axis_tvalid_i = 0;
    top->s_axis_tlast_i = 0;
    top->m_axis_tready_i = 0;
    top->s_axil_awvalid_i = 0;
    top->s_axil_awaddr_i = 0;
    top->s_axil_wvalid_i = 0;
    top->s_axil_wdata_i = 0;
    top->s_axil_wstrb_i = 0;
    top->s_axil_bready_i = 0;
    top->s_axil_arvalid_i = 0;
    top->s_axil_araddr_i = 0;
    top->s_axil_rready_i = 0;
  }

  // A clock is two steps. settle(): inputs may have changed since the last edge, and outputs follow them, as a ready
  // may that waits for its valid. What the port says then is what it says at the edge. tick(): the edge.
  void settle() {
    top->clk_i = 0;
    top->eval();
    if (clocks > 0) dump(clocks - 1, 2 * clocks - 1);
  }
  void tick() {
    top->clk_i = 1;
    top->eval();
    dump(clocks, 2 * clocks);
    context.timeInc(1);
    ++clocks;
  }

#ifdef KAGE_WAVES
  void dump(std::uint64_t clock, std::uint64_t time) {
    if (clock < wave_first || clock > wave_last) return;
    if (!fst) {
      fst = std::make_unique<VerilatedFstC>();
      top->trace(fst.get(), 99);
      fst->open(wave_path.c_str());
    }
    fst->dump(time);
    if (time == 2 * wave_last + 1) close_wave();
  }
  void close_wave() {
    if (fst) fst->close();
    fst.reset();
    wave_last = 0;
    wave_first = 1;
  }
#else
  void dump(std::uint64_t, std::uint64_t) {}
  void close_wave() {}
#endif

  void reset(std::uint32_t clocks) {
    enter();
    queue.clear();
    expected.clear();
    at = 0;
    offered = false;
    waiting = false;
    x = y = 0;
    quiet = 0;
    idle_inputs();
    top->rst_ni = 0;
    for (std::uint32_t i = 0; i < (clocks > 0 ? clocks : 1); ++i) {
      settle();
      tick();
    }
    top->rst_ni = 1;
  }

  void stalls(std::uint32_t input_share, std::uint32_t output_share, std::uint64_t seed) {
    input = Flow(input_share, seed * 2 + 1);
    output = Flow(output_share, seed * 2 + 2);
  }

  // Whether one was expected.
  bool take_pixel(std::uint32_t value) {
    bool first = false;
    bool last = false;
    const bool due = !expected.empty();
    if (!due) {
      ++stats.extra_pixels;
    } else {
      first = x == 0 && y == 0;
      last = x + 1 == expected.front().width;
      if (first != static_cast<bool>(top->m_axis_tuser_o)) ++stats.user_errors;
      if (last != static_cast<bool>(top->m_axis_tlast_o)) ++stats.last_errors;
      if (last) {
        x = 0;
        if (++y == expected.front().height) {
          y = 0;
          expected.pop_front();
        }
      } else {
        ++x;
      }
    }
    for (int c = 0; c < kChannels; ++c) pixels.push_back(static_cast<std::uint8_t>(value >> (8 * c)));
    ++pixel_count;
    ++stats.pixels;
    return due;
  }

  // One clock.
  void clock() {
    drive();
    finish_clock();
  }

  // What the streams do in this clock; afterwards all ports have the values that the edge will see.
  void drive() {
    if (!offered && !queue.empty()) {
      offered = input.next();
      if (offered) {
        const Block& b = queue.front();
        put_words(top->s_axis_tdata_i, b.words.data() + at);
        top->s_axis_tlast_i = b.last && at + kBeatWords == b.words.size() ? 1 : 0;
      }
    }
    top->s_axis_tvalid_i = offered ? 1 : 0;
    top->m_axis_tready_i = output.next() ? 1 : 0;
    settle();
  }

  // The edge, and what it passed.
  void finish_clock() {
    const bool ready = top->m_axis_tready_i != 0;
    const bool beat = offered && top->s_axis_tready_o;
    const bool pixel = top->m_axis_tvalid_o;
    const std::uint32_t value = static_cast<std::uint32_t>(top->m_axis_tdata_o);
    const std::uint32_t all = value | static_cast<std::uint32_t>(top->m_axis_tuser_o) << 24 |
                              static_cast<std::uint32_t>(top->m_axis_tlast_o) << 25;
    if (waiting && (!pixel || all != waiting_value)) ++stats.unstable;
    waiting = pixel && !ready;
    waiting_value = all;
    if (!queue.empty()) mark = queue.front().marks[at];
    if (top->s_axis_tready_o && !offered && !queue.empty()) ++stats.starved[mark];
    if (waiting) ++stats.blocked[mark];
    // Pixels that no frame has room for are no progress: a core that never stops sending stands still too.
    const bool due = pixel && ready && take_pixel(value);
    ++stats.cycles;
    quiet = beat || due ? 0 : quiet + (ready && (offered || queue.empty()) ? 1 : 0);

    tick();

    if (beat) {
      offered = false;
      ++stats.beats;
      at += kBeatWords;
      if (at >= queue.front().words.size()) {
        if (queue.front().last) mark = KAGE_RTL_MARKS - 1;
        queue.pop_front();
        at = 0;
      }
    }
  }

  int run(std::uint64_t want, std::uint64_t max_clocks) {
    enter();
    quiet = 0;
    for (std::uint64_t n = 0;; ++n) {
      if (context.gotError() || context.gotFinish()) return KAGE_RTL_ASSERT;
      if (pixel_count >= want) return KAGE_RTL_PIXELS;
      if (quiet >= kIdleClocks) return queue.empty() ? KAGE_RTL_IDLE : KAGE_RTL_STUCK;
      if (n >= max_clocks) return KAGE_RTL_LIMIT;
      clock();
    }
  }

  int run_dry(std::uint64_t max_clocks) {
    enter();
    quiet = 0;
    for (std::uint64_t n = 0;; ++n) {
      if (context.gotError() || context.gotFinish()) return KAGE_RTL_ASSERT;
      if (queue.empty()) return KAGE_RTL_DRY;
      if (quiet >= kIdleClocks) return KAGE_RTL_STUCK;
      if (n >= max_clocks) return KAGE_RTL_LIMIT;
      clock();
    }
  }

  int read(std::uint32_t address, std::uint32_t* value) {
    enter();
    top->s_axil_arvalid_i = 1;
    top->s_axil_araddr_i = static_cast<CData>(address);
    top->s_axil_rready_i = 1;
    for (int n = 0; n < 1000; ++n) {
      drive();
      const bool taken = top->s_axil_arvalid_i && top->s_axil_arready_o;
      const bool answered = top->s_axil_rvalid_o;
      *value = top->s_axil_rdata_o;
      const int response = top->s_axil_rresp_o;
      finish_clock();
      if (answered) {
        top->s_axil_rready_i = 0;
        return response;
      }
      if (taken) top->s_axil_arvalid_i = 0;
    }
    return -1;
  }

  int write(std::uint32_t address, std::uint32_t value, unsigned strobes, int late) {
    enter();
    top->s_axil_awvalid_i = 1;
    top->s_axil_awaddr_i = static_cast<CData>(address);
    top->s_axil_wdata_i = value;
    top->s_axil_wstrb_i = static_cast<CData>(strobes);
    top->s_axil_bready_i = 1;
    for (int n = 0; n < 1000; ++n) {
      if (n == late) top->s_axil_wvalid_i = 1;
      drive();
      const bool aw = top->s_axil_awvalid_i && top->s_axil_awready_o;
      const bool w = top->s_axil_wvalid_i && top->s_axil_wready_o;
      const bool answered = top->s_axil_bvalid_o;
      const int response = top->s_axil_bresp_o;
      finish_clock();
      if (answered) {
        top->s_axil_bready_i = 0;
        return response;
      }
      if (aw) top->s_axil_awvalid_i = 0;
      if (aw) top->s_axil_awaddr_i = static_cast<CData>(~address);
      if (w) top->s_axil_wvalid_i = 0;
    }
    return -1;
  }
};

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
      Block b{std::vector<std::uint32_t>(words, words + count), {}, last != 0};
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
    [](kage_rtl* m, std::uint32_t address, std::uint32_t value) { return m->write(address, value, 15, 0); },
    [](kage_rtl* m, std::uint32_t address, std::uint32_t value, unsigned strobes) {
      return m->write(address, value, strobes, 5);
    },
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
};

}  // namespace

#ifdef KAGE_WAVES
// The library is linked so that these take the place of the C functions (build.py: --wrap): Verilator's writer of FST
// does not look whether what it writes gets written. stdio keeps the error with the file until it is closed.
extern "C" {
size_t __real_fwrite(const void* data, size_t size, size_t count, FILE* file);
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

extern "C" __attribute__((visibility("default"))) const kage_rtl_table* kage_rtl_api(void) { return &kTable; }
