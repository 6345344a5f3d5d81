// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cosim/diverge/divergence.hpp"
#include "cosim/report/page.hpp"
#include "cosim/run.hpp"
#include "cosim/session/source.hpp"
#include "kage/cosim.hpp"

namespace kage::cosim {

/// Versions of kage and of the tools that make RTL models, a line each.
std::vector<std::string> versions();

/// Hears the words of a run's frames on their way and keeps what the page needs of them.
class Listener {
 public:
  explicit Listener(Source& source);

  /// As the source gives them. That their tokens cannot be kept for the page does not end the run.
  TokenCounts frame(int index, const WordSink& sink);

  /// Takes over the frames of another listener, which come behind these.
  void absorb(const Listener& later);

  /// Throws Error if they could not be kept.
  [[nodiscard]] const report::TokenStore& tokens() const;

 private:
  /// A step of keeping tokens, unless one has failed.
  void keep(const std::function<void()>& step);

  Source& source_;
  std::optional<report::TokenStore> tokens_;  // empty once they could not be kept, which is trouble_
  std::string trouble_;
  std::size_t frames_ = 0;  // given so far
};

/// The report page of a run, written when there is a verdict.
class RunReport {
 public:
  /// `host` must outlive it.
  RunReport(Source& source, CommandLines lines, Host& host);

  /// Who hears the frames that the source makes.
  [[nodiscard]] Listener& listener() { return listener_; }

  using Watch = std::function<ReplayOptions()>;

  /// Writes FOLDER/report.html, which gets its name with the others of `files`, the run's pictures among them, and
  /// returns it. `record` is that of `run`. `watch` gives the options to run the RTL with monitors by; it is asked only
  /// after a difference, and empty where no stage is to be looked for. Throws Error if there can be no page.
  std::string write(TempFiles& files, const std::string& folder, const Report& run, const report::SceneRecord& record,
                    const std::optional<Divergence>& divergence, const Watch& watch);

 private:
  void tell_pixels(report::Page& page, const std::optional<Divergence>& divergence, const Watch& watch);

  Source& source_;
  CommandLines lines_;
  Host& host_;
  Listener listener_;
};

}  // namespace kage::cosim
