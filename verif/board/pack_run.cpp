// SPDX-License-Identifier: Apache-2.0
#include "board/pack_run.hpp"

#include <string>
#include <utility>

#include "board/board_fault.hpp"
#include "board/pack_play.hpp"
#include "kage/error.hpp"

namespace kage::board {
namespace {

constexpr const char* kNotIdle = "; the board could not be left idle: reset it";

}  // namespace

PackVerdict play_pack(Link& link, Transport& clock, const std::string& port, const std::filesystem::path& folder,
                      const vectors::Pack& pack, const PackRunOptions& options) {
  PackPlay play(link, clock, port, folder, pack, options);
  try {
    play.run();
  } catch (const LinkError& e) {
    // Silence says that the board cannot be reached: one that is told nothing more is idle when its words are played.
    const bool idle = e.failure != LinkFailure::no_answer && play.player().leave_idle();
    throw Error(advice(e.failure, port, play.doing()) + (idle ? "" : kNotIdle));
  } catch (const Error& e) {
    if (play.player().leave_idle()) throw;
    throw Error(std::string(e.what()) + kNotIdle);
  } catch (...) {
    if (!play.player().leave_idle() && options.not_idle) options.not_idle();
    throw;
  }
  PackVerdict& verdict = play.verdict();
  const bool left = verdict.loop && verdict.loop->left;
  if (!left && !play.player().leave_idle()) verdict.notes.emplace_back("the board could not be left idle: reset it");
  return std::move(verdict);
}

}  // namespace kage::board
