// SPDX-License-Identifier: Apache-2.0
#include "board/link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace kage::board {
namespace {

constexpr std::size_t kAckFields = 5;  // expected is the frame's sequence; limit, done, session, flags follow
constexpr std::size_t kMostSlots = 64;
// Most bytes taken from the line before the clock is looked at again, so that time-outs work with a board that never
// falls silent.
constexpr std::size_t kMostHeard = std::size_t{1} << 16;

std::uint8_t add(std::uint8_t sequence, std::size_t n) { return static_cast<std::uint8_t>((sequence + n) & 0xFF); }
std::uint8_t behind(std::uint8_t from, std::uint8_t to) { return static_cast<std::uint8_t>((to - from) & 0xFF); }

void check_address(std::uint32_t address, std::size_t words) {
  if (address % 4 != 0 || address > 0xFFFF || words > (0x10000 - address) / 4)
    throw Error(fmt::format("link: address {:#x}, {} words: no multiple of 4, or beyond 0xffff", address, words));
}

}  // namespace

Link::Link(Transport& transport, const LinkOptions& options) : transport_(transport), options_(options) {}

void Link::hello() {
  // A new sequence each time: of an earlier session's ACKs none looks like this one's.
  session_ = static_cast<std::uint8_t>((session_ + 1 + (transport_.now() >> 4) % 251) & 0xFF);
  waiting_.clear();
  base_ = add(session_, 1);
  next_ = window_ = 0;
  done_ = add(base_, 256 - kMostSlots);  // of what an earlier session sent, so much may be left
  contradicts_ = false;
  rewound_to_ = -1;
  tries_ = 0;
  reading_ = false;
  greeted_ = false;
  greeting_ = true;
  moved_ = transport_.now();
  bool again = true;
  while (true) {
    if (again) {
      heard_ = false;
      send({FrameKind::hello, session_, {}});
      timer_ = transport_.now() + options_.timeout;
      again = false;
    }
    listen(timer_);
    const std::uint64_t now = transport_.now();
    if (heard_ && done_ == base_) {
      // Frames of an earlier session that were executed meanwhile may have failed. One more HELLO clears their errors.
      if ((flags_ & (kAxiError | kOverrun)) == 0) break;
      another_try("the board keeps its errors");
      again = true;
    } else if (now >= timer_) {
      if (!heard_) another_try("no answer to HELLO");
      if (heard_ && options_.patience != 0 && now - moved_ >= options_.patience)
        stalled("the board does not execute what an earlier session sent it");
      if (heard_ && contradicts_) another_try("the board answers HELLO");
      if (heard_) {
        heard_ = false;  // until the next timer at least one answer must come
        if (!contradicts_) tries_ = 0;
        send({FrameKind::poll, 0, {}});
        timer_ = now + options_.timeout;
      } else {
        again = true;
      }
    }
  }
  greeting_ = false;
  greeted_ = true;
  tries_ = 0;
  moved_ = timer_ = transport_.now();
  timer_ += options_.timeout;
}

void Link::write(std::uint32_t address, std::span<const std::uint32_t> words, bool same) {
  check_address(address, same ? std::min<std::size_t>(words.size(), 1) : words.size());
  while (!words.empty()) {
    const auto piece = words.first(std::min(words.size(), kMostWritten));
    std::vector<std::uint8_t> payload;
    put_word(payload, address);
    for (const std::uint32_t word : piece) put_word(payload, word);
    post(same ? FrameKind::write_same : FrameKind::write, std::move(payload));
    if (!same) address += static_cast<std::uint32_t>(4 * piece.size());
    words = words.subspan(piece.size());
  }
}

void Link::stream(std::span<const std::uint32_t> words) {
  while (!words.empty()) {
    const auto piece = words.first(std::min(words.size(), kMostStreamed));
    std::vector<std::uint8_t> payload;
    for (const std::uint32_t word : piece) put_word(payload, word);
    post(FrameKind::stream, std::move(payload));
    words = words.subspan(piece.size());
  }
}

std::vector<std::uint32_t> Link::read(std::uint32_t address, std::size_t count) {
  check_address(address, count);
  std::vector<std::uint32_t> all;
  for (int tries = 0; all.size() < count;) {
    read_words_ = std::min(count - all.size(), kMostRead);
    std::vector<std::uint8_t> payload;
    put_word(payload, address);
    payload.push_back(static_cast<std::uint8_t>(read_words_));
    read_sequence_ = add(base_, waiting_.size());
    reading_ = true;
    has_data_ = lost_data_ = false;
    post(FrameKind::read, std::move(payload));
    run(Want::data);
    reading_ = false;
    if (has_data_) {
      tries = 0;
      all.insert(all.end(), data_.begin(), data_.end());
      address += static_cast<std::uint32_t>(4 * read_words_);
    } else if (++tries >= options_.tries) {
      greeted_ = false;
      throw LinkError(LinkFailure::no_answer,
                      fmt::format("link: no answer: {} answers to READ of {:#x} were lost", tries, address));
    }
  }
  return all;
}

void Link::flush() { run(Want::executed); }

void Link::post(FrameKind kind, std::vector<std::uint8_t> payload) {
  if (!greeted_) throw Error("link: no session: hello() comes first, and after an error");
  waiting_.push_back({encoded({kind, add(base_, waiting_.size()), std::move(payload)})});
  run(Want::sent);
}

bool Link::reached(Want want) const {
  switch (want) {
    case Want::sent:
      return next_ == waiting_.size();
    case Want::executed:
      return waiting_.empty() && done_ == base_;
    case Want::data:
      return has_data_ || lost_data_;
  }
  return true;
}

void Link::run(Want want) {
  if (!greeted_) throw Error("link: no session: hello() comes first, and after an error");
  try {
    // While nobody waited for the board it was not silent.
    moved_ = transport_.now();
    timer_ = moved_ + options_.timeout;
    listen(0);
    send_window();
    while (!reached(want)) {
      listen(timer_);
      send_window();
      if (!reached(want) && transport_.now() >= timer_) timed_out();
    }
  } catch (...) {
    greeted_ = reading_ = false;
    throw;
  }
}

void Link::send_window() {
  for (; next_ < std::min(window_, waiting_.size()); ++next_) {
    Sent& frame = waiting_[next_];
    transport_.write(frame.line);
    ++statistics_.sent;
    if (std::exchange(frame.before, true)) ++statistics_.resent;
    timer_ = transport_.now() + options_.timeout;
  }
}

void Link::send(const Frame& frame) {
  transport_.write(encoded(frame));
  ++statistics_.sent;
}

// Takes all that has come; waits for it until the deadline.
void Link::listen(std::uint64_t deadline) {
  std::array<std::uint8_t, 512> bytes;
  for (std::size_t all = 0; all < kMostHeard;) {
    const std::size_t n = transport_.read(bytes, deadline);
    if (n == 0) return;
    all += n;
    for (const std::uint8_t byte : std::span(bytes).first(n)) {
      if (const auto frame = reader_.take(byte)) take(*frame);
      statistics_.answers_damaged = reader_.damaged();
    }
    deadline = 0;
  }
}

void Link::take(const Frame& frame) {
  const std::size_t size = frame.payload.size();
  if (frame.kind == FrameKind::ack && size == kAckFields - 1) {
    ++statistics_.answers;
    take_ack(frame);
  } else if (frame.kind == FrameKind::data && size % 4 == 1) {
    ++statistics_.answers;
    take_data(frame);
  }
}

void Link::take_ack(const Frame& frame) {
  const std::uint8_t expected = frame.sequence;
  const std::uint8_t limit = frame.payload[0];
  const std::uint8_t done = frame.payload[1];
  const std::uint8_t flags = frame.payload[3];
  const bool ours = (flags & kFresh) == 0 && frame.payload[2] == session_;
  if (!ours) {
    if (greeting_) return;
    throw LinkError(LinkFailure::reset_in_the_middle,
                    (flags & kFresh) != 0 ? "link: the board was reset in the middle of the session"
                                          : "link: another host has begun a session in the middle of this one");
  }
  if (!greeting_) check_flags(flags);
  // No other frames than those that were sent can have been taken.
  const std::size_t taken = behind(base_, expected);
  const bool sent = taken <= waiting_.size() && (taken == 0 || waiting_[taken - 1].before);
  // Frames are executed in order, each once, and after they were taken: `done` goes up to `expected`, and never back.
  // So each answer that counts as progress uses up a frame, and a session ends whatever a board says.
  if (!sent || behind(done_, done) > behind(done_, expected)) {
    contradicts_ = true;
    return;
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(taken));
  next_ -= std::min(next_, taken);
  base_ = expected;
  window_ = behind(expected, limit);
  if (window_ > kMostSlots) window_ = 0;
  if (taken > 0 || done != done_) progress();
  done_ = done;
  flags_ = flags;
  heard_ = true;
  if (greeting_) return;
  // The board puts a READ's answer on the line before it is done with it.
  if (reading_ && !has_data_ && behind(read_sequence_, done) - 1U < 128) lost_data_ = true;
  // A gap. The frames behind it are dropped as well, so the link goes back to it only once.
  if ((flags & kDropped) != 0 && next_ > 0 && rewound_to_ != base_) {
    rewound_to_ = base_;
    next_ = 0;
  }
}

void Link::take_data(const Frame& frame) {
  if (!reading_ || frame.sequence != read_sequence_) return;
  const std::uint8_t flags = frame.payload.back();
  check_flags(flags);
  if (frame.payload.size() != 4 * read_words_ + 1) return;
  data_.clear();
  for (std::size_t i = 0; i < read_words_; ++i) data_.push_back(word_at(frame.payload, 4 * i));
  has_data_ = true;
  progress();
}

void Link::check_flags(std::uint8_t flags) const {
  if ((flags & kOverrun) != 0)
    throw LinkError(LinkFailure::overrun, "link: overrun: a frame came for which the board had no room");
  if ((flags & kAxiError) != 0)
    throw LinkError(LinkFailure::bus_error,
                    "link: bus error: an address of this session is none of the board's, or refused");
}

void Link::progress() {
  tries_ = 0;
  contradicts_ = false;
  rewound_to_ = -1;
  moved_ = transport_.now();
  timer_ = moved_ + options_.timeout;
}

void Link::timed_out() {
  const std::uint64_t now = transport_.now();
  timer_ = now + options_.timeout;
  if (next_ > 0) {  // frames that may be taken were not
    another_try("a frame was not taken");
    next_ = 0;
    rewound_to_ = base_;
    send_window();
    return;
  }
  if (options_.patience != 0 && heard_ && now - moved_ >= options_.patience)
    stalled("the board answers, and executes nothing");
  // Nothing is on its way that could be lost: only silence counts, and answers that cannot be.
  if (std::exchange(heard_, false) && !contradicts_)
    tries_ = 0;
  else
    another_try("the board is silent");
  send({FrameKind::poll, 0, {}});
}

void Link::another_try(const char* what) {
  if (++tries_ >= options_.tries)
    throw LinkError(LinkFailure::no_answer, fmt::format("link: no answer: {}{}, in {} tries of {} ms", what, blame(),
                                                        tries_, static_cast<double>(options_.timeout) / 1000));
}

void Link::stalled(const char* what) const {
  throw LinkError(LinkFailure::stalled, fmt::format("link: stalled: {}{}", what, blame()));
}

const char* Link::blame() const {
  return contradicts_ ? ", and says it has executed frames that it was not sent, or fewer than before" : "";
}

}  // namespace kage::board
