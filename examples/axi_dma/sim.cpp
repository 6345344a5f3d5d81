// SPDX-License-Identifier: Apache-2.0
// The testbench of kage_dma: a memory behind its AXI4 ports, and a processor that is this program. The driver's reads
// and writes are AXI4-Lite transactions, its wait is the interrupt line. All frames of a pack are drawn, sound and
// malformed; then the output and the memory stand still on purpose. Afterwards the pixels in memory are compared with
// the pack's.
//
// usage: sim PACK [SEED]      Exit code 0: all the same. 1: different. 2: trouble.
#include <kage/registers.h>
#include <verilated.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "Vkage_dma.h"
#include "kage_driver.h"
#include "kage_pack.h"

namespace {

constexpr std::uint32_t kCore = 0x40000000, kDma = 0x40010000;  // as the interconnect of a design would have them
constexpr std::uint32_t kMemory = 0x80000000, kSize = 1U << 24;
constexpr std::uint32_t kFrames = kMemory + 4096 - 3 * 32;  // near a multiple of 4 KB: bursts have to end there
constexpr std::uint32_t kPixels = kMemory + kSize / 2 + 4096 - 20;
constexpr std::uint32_t kBeatBytes = 4 * KAGE_PACK_BEAT_WORDS;
constexpr std::uint32_t kWatchdog = 500;  // clocks; this memory rests for 20 at most, but where it is told to
constexpr std::uint8_t kUntouched = 0xA5;
constexpr int kAnswerError = 2;  // SLVERR

[[noreturn]] void trouble(const std::string& what) {
  std::fprintf(stderr, "sim: %s\n", what.c_str());
  std::exit(2);
}

std::vector<std::uint8_t> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) trouble(path + ": cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

// An AXI4-Lite port, as the processor's side of it sees it.
struct LitePort {
  CData &awvalid, &awready, &awaddr, &wvalid, &wready;
  IData& wdata;
  CData &wstrb, &bvalid, &bready, &bresp, &arvalid, &arready, &araddr, &rvalid, &rready;
  IData& rdata;
  CData& rresp;
};

class Bench {
 public:
  explicit Bench(unsigned seed) : dice_(seed), memory_(kSize, kUntouched) {
    top_.aresetn = 0;
    for (int i = 0; i < 4; ++i) clock();
    top_.aresetn = 1;
    clock();
  }

  ~Bench() { top_.final(); }

  std::uint8_t* at(std::uint32_t address) { return &memory_.at(address - kMemory); }
  std::uint64_t clocks() const { return clocks_; }
  // Behind so many more beats the memory answers no read for so many clocks.
  void rest(std::uint32_t beats, std::uint64_t clocks) {
    rest_in_ = beats;
    rest_for_ = clocks;
  }

  std::uint32_t read(std::uint32_t address) {
    LitePort& port = port_of(address);
    port.araddr = address & 0xFF;
    port.arvalid = 1;
    port.rready = 1;
    std::uint32_t value = 0;
    for (bool answered = false; !answered;) {
      settle();
      const bool asked = port.arvalid && port.arready;
      answered = port.rvalid;
      value = port.rdata;
      if (answered && port.rresp != 0) complain("a read was answered with an error", address);
      clock();
      if (asked) port.arvalid = 0;
      limit(address);
    }
    port.rready = 0;
    waited_ = 0;
    return value;
  }

  void write(std::uint32_t address, std::uint32_t value) {
    LitePort& port = port_of(address);
    port.awaddr = address & 0xFF;
    port.wdata = value;
    port.wstrb = 0xF;
    port.awvalid = port.wvalid = port.bready = 1;
    for (bool answered = false; !answered;) {
      settle();
      const bool address_taken = port.awready, data_taken = port.wready;
      answered = port.bvalid;
      if (answered && port.bresp != 0) complain("a write was answered with an error", address);
      clock();
      if (address_taken) port.awvalid = 0;
      if (data_taken) port.wvalid = 0;
      limit(address);
    }
    port.bready = 0;
    waited_ = 0;
  }

  bool wait() {
    for (int i = 0; i < 1000000; ++i) {
      if (top_.irq) return true;
      clock();
    }
    return false;
  }

  // The broken rule of the bus; empty: none.
  const std::string& complaint() const { return complaint_; }

 private:
  // A burst that the memory serves.
  struct Burst {
    std::uint32_t address = 0, beats = 0;
  };

  bool chance(int percent) { return std::uniform_int_distribution<>(0, 99)(dice_) < percent; }

  void settle() {
    top_.aclk = 0;
    top_.eval();
  }

  // One clock. Inputs change behind its edge by what was there before it.
  void clock() {
    settle();
    const bool ar = top_.m_axi_frames_arvalid && top_.m_axi_frames_arready;
    const bool r = top_.m_axi_frames_rvalid && top_.m_axi_frames_rready;
    const bool aw = top_.m_axi_video_awvalid && top_.m_axi_video_awready;
    const bool w = top_.m_axi_video_wvalid && top_.m_axi_video_wready;
    const bool b = top_.m_axi_video_bvalid && top_.m_axi_video_bready;
    if (ar) read_ = burst(top_.m_axi_frames_araddr, top_.m_axi_frames_arlen, top_.m_axi_frames_arsize, kBeatBytes);
    if (aw) write_ = burst(top_.m_axi_video_awaddr, top_.m_axi_video_awlen, top_.m_axi_video_awsize, 4);
    if (w) words_.push_back(top_.m_axi_video_wdata);
    const bool wlast = w && top_.m_axi_video_wlast;
    top_.aclk = 1;
    top_.eval();
    ++clocks_;
    if (r) {
      read_.address += kBeatBytes;
      --read_.beats;
      if (rest_in_ != 0 && --rest_in_ == 0) resting_until_ = clocks_ + rest_for_;
    }
    if (r || !top_.m_axi_frames_rvalid) {
      top_.m_axi_frames_rvalid = read_.beats != 0 && clocks_ >= resting_until_ && chance(70);
      if (top_.m_axi_frames_rvalid) answer_read();
    }
    if (wlast) last_ = true;
    // Data may come before their address: AXI4 allows both orders.
    if (write_.beats != 0 && last_) store();
    if (b) top_.m_axi_video_bvalid = 0;
    if (stored_ && !top_.m_axi_video_bvalid && chance(30)) {
      top_.m_axi_video_bvalid = 1;
      top_.m_axi_video_bresp = store_failed_ ? kAnswerError : 0;
      stored_ = false;
    }
    top_.m_axi_frames_arready = read_.beats == 0 && chance(40);
    top_.m_axi_video_awready = write_.beats == 0 && !stored_ && chance(40);
    top_.m_axi_video_wready = !last_ && chance(60);
  }

  Burst burst(std::uint32_t address, std::uint32_t length, std::uint32_t size, std::uint32_t bytes) {
    const std::uint32_t whole = (length + 1) * bytes;
    if (1U << size != bytes || address % bytes != 0) complain("a burst with beats of another size", address);
    if (address / 4096 != (address + whole - 1) / 4096) complain("a burst passes a multiple of 4 KB", address);
    return {address, length + 1};
  }

  bool in_memory(std::uint32_t address, std::uint32_t bytes) const {
    return address >= kMemory && address - kMemory <= kSize - bytes;
  }

  void answer_read() {
    const bool there = in_memory(read_.address, kBeatBytes);
    std::array<std::uint8_t, kBeatBytes> beat{};
    if (there) std::memcpy(beat.data(), at(read_.address), kBeatBytes);
    std::memcpy(&top_.m_axi_frames_rdata, beat.data(), kBeatBytes);
    top_.m_axi_frames_rresp = there ? 0 : kAnswerError;
  }

  void store() {
    const auto bytes = static_cast<std::uint32_t>(4 * words_.size());
    if (words_.size() != write_.beats) complain("a burst has not as many beats as its address says", write_.address);
    store_failed_ = !in_memory(write_.address, bytes);
    if (!store_failed_) std::memcpy(at(write_.address), words_.data(), bytes);
    words_.clear();
    write_ = {};
    last_ = false;
    stored_ = true;
  }

  LitePort& port_of(std::uint32_t address) {
    if (address - kCore < 0x100) return core_;
    if (address - kDma < 0x100) return dma_;
    trouble("the driver asks for an address that is nobody's");
  }

  void complain(const std::string& what, std::uint32_t address) {
    std::array<char, 16> hex{};
    std::snprintf(hex.data(), hex.size(), "0x%08x", address);
    if (complaint_.empty()) complaint_ = what + ", at " + hex.data();
  }

  void limit(std::uint32_t address) {
    if (++waited_ < 1000) return;
    complain("no answer", address);
    trouble(complaint_);
  }

  Vkage_dma top_;
  std::mt19937 dice_;
  std::vector<std::uint8_t> memory_;
  std::string complaint_;
  std::uint64_t clocks_ = 0, resting_until_ = 0, rest_for_ = 0;
  std::uint32_t rest_in_ = 0;
  int waited_ = 0;
  Burst read_, write_;
  std::vector<std::uint32_t> words_;
  bool last_ = false, stored_ = false, store_failed_ = false;
#define PORT(name)                                                                              \
  {                                                                                             \
    top_.s_axil_##name##_awvalid, top_.s_axil_##name##_awready, top_.s_axil_##name##_awaddr,    \
        top_.s_axil_##name##_wvalid, top_.s_axil_##name##_wready, top_.s_axil_##name##_wdata,   \
        top_.s_axil_##name##_wstrb, top_.s_axil_##name##_bvalid, top_.s_axil_##name##_bready,   \
        top_.s_axil_##name##_bresp, top_.s_axil_##name##_arvalid, top_.s_axil_##name##_arready, \
        top_.s_axil_##name##_araddr, top_.s_axil_##name##_rvalid, top_.s_axil_##name##_rready,  \
        top_.s_axil_##name##_rdata, top_.s_axil_##name##_rresp                                  \
  }
  LitePort core_ PORT(core);
  LitePort dma_ PORT(dma);
#undef PORT
};

int different = 0;

void check(bool same, const std::string& what) {
  if (same) return;
  std::printf("different: %s\n", what.c_str());
  ++different;
}

// A frame of the pack in memory, and what must come of it.
struct Frame {
  kage_job job;
  const std::uint8_t* pixels;  // of the pack
  std::uint32_t error;
};

// The pixels in memory, and that nothing is written behind them. Returns how many there are.
std::uint32_t compare(Bench& bench, const Frame& frame, const std::string& name) {
  const std::uint32_t count = frame.job.width * frame.job.height;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint8_t* got = bench.at(frame.job.destination + 4 * i);
    for (std::uint32_t c = 0; c < 4; ++c) {
      const int wanted = c < KAGE_PACK_CHANNELS ? frame.pixels[i * KAGE_PACK_CHANNELS + c] : 0;
      if (got[c] == wanted) continue;
      check(false, name + ", line " + std::to_string(i / frame.job.width) + ", x " +
                       std::to_string(i % frame.job.width) + ", byte " + std::to_string(c) + ": expected " +
                       std::to_string(wanted) + ", got " + std::to_string(got[c]));
      return count;
    }
  }
  for (std::uint32_t i = 0; i < 64; ++i) {
    check(bench.at(frame.job.destination + 4 * count)[i] == kUntouched, name + ": more is written than its pixels");
  }
  return count;
}

// Before a frame is drawn nothing of it is there.
void wipe(Bench& bench, const Frame& frame) {
  std::memset(bench.at(frame.job.destination), kUntouched, 4 * frame.job.width * frame.job.height + 64);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) trouble("usage: sim PACK [SEED]");
  const std::string pack = argv[1];
  const std::vector<std::uint8_t> beats = read_file(pack + "/stimulus.bin");
  const std::vector<std::uint8_t> pixels = read_file(pack + "/pixels.bin");
  if (beats.size() != std::size_t{KAGE_PACK_BEATS} * kBeatBytes ||
      pixels.size() != std::size_t{KAGE_PACK_PIXELS} * KAGE_PACK_CHANNELS) {
    trouble(pack + ": not the pack that this program was built for");
  }
  if (beats.size() > kSize / 2 - 8192 || 4 * std::size_t{KAGE_PACK_PIXELS} > kSize / 2 - 8192)
    trouble(pack + ": larger than the memory");
  Bench bench(argc > 2 ? static_cast<unsigned>(std::strtoul(argv[2], nullptr, 10)) : 1);
  std::memcpy(bench.at(kFrames), beats.data(), beats.size());
  std::vector<Frame> frames;
  std::uint32_t source = kFrames;
  const std::uint8_t* wanted = pixels.data();
  for (const kage_pack_frame& f : kage_pack_frames) {
    // Who draws does not know that a header will be refused, and asks for lines: as many as the first frame has.
    const bool refused = f.lines == 0;
    frames.push_back(
        {{source, f.beats, kPixels, f.width, refused ? kage_pack_frames[0].lines : f.lines}, wanted, f.error});
    source += f.beats * kBeatBytes;
    wanted += std::size_t{f.lines} * f.width * KAGE_PACK_CHANNELS;
  }
  if (frames[0].error != KAGE_ERR_NONE) trouble(pack + ": its first frame is not sound");

  kage_bus bus{};
  bus.context = &bench;
  bus.core = kCore;
  bus.dma = kDma;
  bus.read = [](void* b, std::uint32_t address) { return static_cast<Bench*>(b)->read(address); };
  bus.write = [](void* b, std::uint32_t address, std::uint32_t value) {
    static_cast<Bench*>(b)->write(address, value);
  };
  bus.wait = [](void* b) { return static_cast<Bench*>(b)->wait(); };

  // Version and parameters are those of the first frame's header.
  std::array<std::uint32_t, 3> header{};
  std::memcpy(header.data(), beats.data(), sizeof header);
  const std::uint32_t version = header[0] & 0xFFFF, hash = header[2];
  kage_device device{};
  check(kage_open(&device, &bus, version + 2, hash, kWatchdog) == KAGE_WRONG_VERSION, "another version is opened");
  check(kage_open(&device, &bus, KAGE_VERSION_POLYGONS, hash, kWatchdog) == KAGE_NO_FRONT_END,
        "frames of polygons are opened on a core without a front end");
  check(kage_open(&device, &bus, version, ~hash, kWatchdog) == KAGE_WRONG_PARAMETERS,
        "a core with other parameters is opened");
  const kage_result opened = kage_open(&device, &bus, version, hash, kWatchdog);
  if (opened != KAGE_OK) trouble(kage_result_text(opened));

  std::uint32_t compared = 0, malformed = 0;
  kage_outcome outcome{};
  // draw NAME: as the pack says, and a line about it.
  const auto draw = [&](const Frame& frame, const std::string& name) {
    wipe(bench, frame);
    const kage_result result = kage_draw(&device, &frame.job, &outcome);
    std::printf("%s: %s", name.c_str(), kage_result_text(result));
    if (result == KAGE_MALFORMED) {
      std::printf(": %s, line %u, token %u", kage_error_name(outcome.error), outcome.line, outcome.token);
      ++malformed;
    }
    std::printf(", %u pixels, %u clocks\n", outcome.pixels, outcome.cycles);
    const bool sound = frame.error == KAGE_ERR_NONE;
    check(result == (sound ? KAGE_OK : KAGE_MALFORMED),
          name + ": expected " + (sound ? "no error" : kage_error_name(frame.error)));
    check(outcome.error == frame.error, name + ": expected " + kage_error_name(frame.error));
    check(outcome.pixels == frame.job.width * frame.job.height, name + ": other pixels than were asked for");
    compared += compare(bench, frame, name);
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    draw(frames[i], "frame " + std::to_string(i));
    check(outcome.frames == i + 1, "frame " + std::to_string(i) + ": FRAMES is " + std::to_string(outcome.frames));
    for (const kage_pack_register& r : kage_pack_registers) {
      if (r.frame != i || r.address == KAGE_REG_IRQ) continue;  // the driver has cleared IRQ
      const std::uint32_t value = bench.read(kCore + r.address);
      check((value & r.mask) == r.value, "frame " + std::to_string(i) + ": register " + std::to_string(r.address) +
                                             ": expected " + std::to_string(r.value) + ", got " +
                                             std::to_string(value));
    }
  }

  // recover NAME: from a standstill; then the next frame is as if nothing had been.
  const auto stalled = [&](const std::string& name, kage_result result, bool on_input) {
    std::printf("%s: %s on %s at line %u\n", name.c_str(), kage_result_text(result),
                outcome.stalled_on_input ? (outcome.stalled_on_output ? "both" : "input")
                                         : (outcome.stalled_on_output ? "output" : "neither"),
                outcome.stalled_line);
    check(result == KAGE_STALLED && outcome.stalled_on_input == on_input && outcome.stalled_on_output == !on_input,
          name + ": expected a standstill of the " + (on_input ? "input" : "output"));
  };
  // The output: a capture of one line, behind which nobody takes a pixel.
  Frame frame = frames[0];
  frame.job.height = 1;
  wipe(bench, frames[0]);
  stalled("nobody takes the pixels", kage_draw(&device, &frame.job, &outcome), false);
  check(kage_draw(&device, &frame.job, &outcome) == KAGE_BUSY, "a frame is begun within another");
  check(kage_recover(&device, 1000000, &outcome) == KAGE_OK,
        "the core does not recover from a standstill of its output");
  compared += compare(bench, frame, "nobody takes the pixels");
  draw(frames[0], "the frame behind it");

  // The input: memory answers no read for a time; the frame waits, and is whole in the end.
  wipe(bench, frames[0]);
  bench.rest(frames[0].job.beats / 2, 4 * kWatchdog);
  stalled("memory rests", kage_draw(&device, &frames[0].job, &outcome), true);
  check(kage_recover(&device, 1000000, &outcome) == KAGE_OK,
        "the core does not recover from a standstill of its input");
  compared += compare(bench, frames[0], "memory rests");

  // A capture of more lines than come, and memory that is not there.
  frame = frames[0];
  ++frame.job.height;
  kage_result result = kage_draw(&device, &frame.job, &outcome);
  std::printf("a line too many is asked for: %s, %u pixels\n", kage_result_text(result), outcome.pixels);
  check(result == KAGE_WRONG_SIZE, "a line too many is asked for, and nobody says so");
  frame = frames[0];
  frame.job.source = kMemory + kSize;
  result = kage_draw(&device, &frame.job, &outcome);
  std::printf("a frame where no memory is: %s\n", kage_result_text(result));
  check(result == KAGE_MEMORY_ERROR, "a frame where no memory is: expected an error of the memory");
  draw(frames[0], "the frame behind it");

  check(bench.complaint().empty(), bench.complaint());
  if (different != 0) {
    std::printf("kage_dma: different: %d checks failed\n", different);
    return 1;
  }
  std::printf("kage_dma: same: %zu frames, %u of them malformed, %u pixels compared, %llu clocks\n", frames.size(),
              malformed, compared, static_cast<unsigned long long>(bench.clocks()));
  return 0;
}
