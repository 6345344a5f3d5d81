// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "cosim/model/model_cache.hpp"
#include "cosim/phases.hpp"

namespace kage::cosim {

/// The kept verdict on a frame that the RTL had the same as the golden model.
struct Verdict {
  std::string output;        ///< a SHA-256 of what both put out: every line, and how the frame ended
  std::uint64_t cycles = 0;  ///< as in FrameEnd, of the RTL
  PhaseStalls phase_stalls{};
};

/// A verdict's file.
struct StoredVerdict {
  std::string key;
  std::uint64_t bytes = 0;
  std::filesystem::file_time_type last_used = {};
};

/// So many verdicts are kept at most.
inline constexpr std::size_t kMostVerdicts = 20000;

/// The verdicts that are kept in ${XDG_CACHE_HOME:-~/.cache}/kage/verdicts, a file each, whose name is the key (64
/// hexadecimal digits). A file ends with a SHA-256 of its key and content, so one that was cut, damaged or renamed is
/// as good as none. Several threads and programs may use the store at once: two that keep a verdict of one key write
/// the same bytes.
class VerdictStore {
 public:
  /// Makes the folder if it is missing. Throws Error if it cannot be made, or if somebody else could put verdicts there
  /// (cosim/model/trust.hpp).
  explicit VerdictStore(std::size_t most = kMostVerdicts);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// The verdict of that key; none if there is none, or one that is damaged or that somebody else could have written.
  /// Notes that it is used.
  [[nodiscard]] std::optional<Verdict> find(const std::string& key) const;

  /// Keeps a verdict, in place of one that is damaged. False if it cannot be written; then trouble() says why, and no
  /// further one is tried. Now and then removes the verdicts that were used longest ago, so that there are no more than
  /// `most`; programs that keep verdicts at the same time may go beyond that by a twentieth each.
  bool keep(const std::string& key, const Verdict& verdict);

  /// Why verdicts cannot be kept, or empty.
  [[nodiscard]] std::string trouble() const;

  /// All, the most recently used first.
  [[nodiscard]] std::vector<StoredVerdict> list() const;

  /// Whether the verdict of that key is whole.
  [[nodiscard]] bool is_whole(const std::string& key) const { return read(key).has_value(); }

  /// Removes the verdicts that are damaged and those beyond `limits`, whose bytes are those that all verdicts may take;
  /// returns them.
  [[nodiscard]] std::vector<StoredVerdict> prune(const CacheLimits& limits) const;

 private:
  [[nodiscard]] std::size_t sweep_every() const;
  void sweep() const;
  [[nodiscard]] std::optional<Verdict> read(const std::string& key) const;

  std::filesystem::path folder_;
  std::size_t most_;
  mutable std::mutex mutex_;
  std::string trouble_;
  std::size_t kept_ = 0;  // since the last sweep
};

}  // namespace kage::cosim
