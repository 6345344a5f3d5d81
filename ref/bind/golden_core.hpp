// SPDX-License-Identifier: Apache-2.0
// State behind a handle of the C interface: a core, and what its observer has seen of the current frame.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kage/core.hpp"
#include "kage/golden.h"
#include "kage/stream.hpp"

struct kage_golden final : kage::CoreObserver {
  explicit kage_golden(const kage::Config& c) : config(c), layout(c), core(c) { core.observe(this); }

  kage::Config config;
  kage::Layout layout;
  kage::GoldenCore core;
  std::optional<kage::StreamFile> file;
  std::span<const std::uint32_t> rest;  // words of the file's frame that next() has not read

  int state = KAGE_GOLDEN_MORE;  // MORE: in the frame or before it
  bool accepted = false;         // a token, since it was last asked
  bool line = false;             // there is one at hand
  int height = 0;

  /// A token, and its words.
  struct Whole {
    int kind = KAGE_KIND_HEADER;
    kage::Token token;
    std::vector<std::uint32_t> words;
  };
  int index = -1;
  Whole at_hand;            // of the stream
  bool polygons = false;    // the frame is at that level
  std::vector<Whole> made;  // what the front end made of it, or handed on
  int chosen = -1;          // of those; -1: the stream's own

  [[nodiscard]] const Whole& shown() const { return chosen < 0 ? at_hand : made[static_cast<std::size_t>(chosen)]; }

  kage_golden_taker taker = nullptr;
  void* user = nullptr;
  int out_line = -1;
  std::vector<std::uint8_t> out;

  kage::FrameStatus status;
  std::string error, text;

  void header(std::span<const std::uint32_t> w, const kage::LineView& /*view*/) override {
    take(0, {KAGE_KIND_HEADER, {}, {w.begin(), w.end()}});
    const kage::FrameHeader h = kage::FrameHeader::read(w);
    height = h.height;
    polygons = h.level() == kage::Level::polygons;
    line = accepted = true;
  }

  void before(std::uint32_t i, const kage::Token& t, std::span<const std::uint32_t> w,
              const kage::LineView& /*view*/) override {
    // The core's own token keeps fields of those before it.
    Whole whole{static_cast<int>(t.kind), kage::decode(config, layout, w), {w.begin(), w.end()}};
    if (polygons)
      made.push_back(std::move(whole));
    else
      take(static_cast<int>(i), std::move(whole));
    if (t.kind == kage::Kind::END) {
      state = KAGE_GOLDEN_END;
      line = false;
    }
  }

  void came(std::uint32_t i, const kage::Token& t, std::span<const std::uint32_t> w) override {
    take(static_cast<int>(i),
         {static_cast<int>(t.kind), kage::decode(config, layout, w, kage::Level::polygons), {w.begin(), w.end()}});
    accepted = true;  // unless failed() follows
  }

  void after(std::uint32_t /*index*/, const kage::Token& /*token*/, const kage::LineView& /*view*/) override {
    accepted = true;
  }

  void failed(const kage::FrameStatus& s, std::span<const std::uint32_t> /*words*/,
              const kage::LineView& /*view*/) override {
    status = s;
    state = KAGE_GOLDEN_FAILED;
    line = false;
  }

  void feed(std::span<const std::uint32_t> w) { core.feed(w, sink()); }

  [[nodiscard]] kage::LineSink sink() {
    return [this](int y, std::span<const std::uint8_t> pixels) {
      out_line = y;
      out.assign(pixels.begin(), pixels.end());
      if (taker != nullptr) taker(user, y, out.data(), static_cast<int>(out.size()));
    };
  }

  int word(std::uint32_t w) {
    accepted = false;
    feed({&w, 1});
    return state == KAGE_GOLDEN_MORE && accepted ? KAGE_GOLDEN_TOKEN : state;
  }

  int finish() {
    status = core.finish(sink());
    fresh();
    return static_cast<int>(status.error);
  }

  void take(int i, Whole whole) {
    index = i;
    at_hand = std::move(whole);
    made.clear();
    chosen = -1;
  }

  void fresh() {
    made.clear();
    chosen = -1;
    state = KAGE_GOLDEN_MORE;
    line = false;
    index = out_line = -1;
    rest = {};
  }
};
