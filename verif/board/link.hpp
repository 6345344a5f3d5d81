// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "board/link_frame.hpp"
#include "board/transport.hpp"
#include "kage/error.hpp"

namespace kage::board {

/// Why a link gave up.
enum class LinkFailure {
  no_answer,            ///< nothing that is whole came, or a frame was not taken, in as many tries as are allowed
  reset_in_the_middle,  ///< the board was reset, or another host began a session of its own
  bus_error,            ///< AXI4-Lite answered SLVERR or DECERR, or the address has more than 16 bits
  overrun,              ///< the board was sent a frame for which it had no room
  stalled,              ///< the board answers, and executes nothing: the stream's taker or AXI4-Lite takes nothing
};

/// Failure of a link. The link does nothing more until hello() begins anew.
class LinkError : public Error {
 public:
  LinkError(LinkFailure why, const std::string& what) : Error(what), failure(why) {}
  LinkFailure failure;
};

struct LinkOptions {
  /// Microseconds without an answer after which frames are sent again. More than it takes to send as many frames as the
  /// board has slots, and to be answered: 1,040 bytes at 115,200 baud take 90,000.
  std::uint64_t timeout = 250'000;
  /// How often a frame is sent, at most, without being taken.
  int tries = 10;
  /// Microseconds for which the board may execute nothing while it answers; 0: any time.
  std::uint64_t patience = 10'000'000;
};

struct LinkStatistics {
  std::uint64_t sent = 0;             ///< frames sent, each time counted
  std::uint64_t resent = 0;           ///< of these, those that had been sent before
  std::uint64_t answers = 0;          ///< frames of the board that were whole
  std::uint64_t answers_damaged = 0;  ///< frames of the board that were not
};

/// The host's end of the link of docs/link.md: everything arrives once and in order, whatever the line loses or
/// damages. Functions throw LinkError, and Error of the transport. No threads: things move while a function runs.
class Link {
 public:
  /// The transport stays as long as the link.
  explicit Link(Transport& transport, const LinkOptions& options = {});

  /// Begins a session. Frames that an earlier session had sent and the board had taken are executed first, and their
  /// errors are forgotten. Frames that this link had not sent yet are forgotten, too.
  void hello();

  /// The session's number, 0 .. 255, made of the time at which it began. Two hosts' sessions have the same number once
  /// in 251 times; the first host then hears no answer in place of being told of the other.
  [[nodiscard]] std::uint8_t session() const { return session_; }

  /// Writes words to `address`, address + 4, ..., or, with `same`, all to `address`; a multiple of four, less than
  /// 65536. Returns when all have been sent once: flush() says whether they have been written.
  void write(std::uint32_t address, std::span<const std::uint32_t> words, bool same = false);

  /// Gives words to the stream. Returns when all have been sent once: flush() says whether they have been taken.
  void stream(std::span<const std::uint32_t> words);

  /// Reads `count` words from `address`, address + 4, ..., behind all that was sent before. A lost answer is asked for
  /// again, so a register may be read twice.
  std::vector<std::uint32_t> read(std::uint32_t address, std::size_t count);

  /// Waits until all that was sent has been executed.
  void flush();

  [[nodiscard]] const LinkStatistics& statistics() const { return statistics_; }

 private:
  struct Sent {
    std::vector<std::uint8_t> line;
    bool before = false;  // it has been sent once
  };
  enum class Want { sent, executed, data };

  void post(FrameKind kind, std::vector<std::uint8_t> payload);
  void run(Want want);
  [[nodiscard]] bool reached(Want want) const;
  void send_window();
  void send(const Frame& frame);
  void listen(std::uint64_t deadline);
  void take(const Frame& frame);
  void take_ack(const Frame& frame);
  void take_data(const Frame& frame);
  void timed_out();
  void another_try(const char* what);
  [[noreturn]] void stalled(const char* what) const;
  [[nodiscard]] const char* blame() const;
  void progress();
  void check_flags(std::uint8_t flags) const;

  Transport& transport_;
  LinkOptions options_;
  LinkStatistics statistics_;
  FrameReader reader_;

  bool greeting_ = false;  // hello() is under way: other sessions' frames are no error
  bool greeted_ = false;   // a session has begun, and no error ended it
  std::uint8_t session_ = 0;
  std::deque<Sent> waiting_;  // frames that were not acknowledged, the first with the sequence base_
  std::uint8_t base_ = 0;
  std::size_t next_ = 0;      // the place in waiting_ that is sent next
  std::size_t window_ = 0;    // how many of waiting_ may be sent
  std::uint8_t done_ = 0;     // the first sequence that has not been executed
  std::uint8_t flags_ = 0;    // of the last ACK
  bool heard_ = false;        // of hello(): an ACK of this session
  bool contradicts_ = false;  // since it last took or executed something, the board has said what cannot be
  int rewound_to_ = -1;       // the sequence that was last gone back to for a gap
  int tries_ = 0;
  std::uint64_t timer_ = 0;  // when to send again
  std::uint64_t moved_ = 0;  // when the board last took or executed something

  bool reading_ = false, has_data_ = false, lost_data_ = false;
  std::uint8_t read_sequence_ = 0;
  std::size_t read_words_ = 0;
  std::vector<std::uint32_t> data_;
};

}  // namespace kage::board
