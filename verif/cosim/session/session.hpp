// SPDX-License-Identifier: Apache-2.0
//
// A co-simulation of one scene or several: what kage cosim does, and cosim::run() (kage/cosim.hpp).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cosim/report/run_record.hpp"
#include "cosim/session/scene_run.hpp"
#include "file/temp_file.hpp"
#include "kage/cosim.hpp"

namespace kage::cosim {

class Session {
 public:
  /// Opens all scenes, so that what cannot be read is found before the work. `host` and `cores` must outlive it.
  Session(const CosimOptions& options, Host& host, Cores& cores = rtl_cores());

  /// Compares all frames of all scenes.
  void compare();

  /// Looks into differences and writes pages. New files get their names with the others of `files`. Throws what ended a
  /// scene before any difference.
  report::RunRecord finish(TempFiles& files);

  // After finish():

  [[nodiscard]] std::size_t scenes() const { return scenes_.size(); }
  /// Sentences for a person on a scene, with its name.
  [[nodiscard]] const std::vector<std::string>& notes(std::size_t scene) const { return scenes_[scene]->notes(); }
  /// Where a scene's files are.
  [[nodiscard]] const std::string& folder(std::size_t scene) const { return scenes_[scene]->options().out; }
  /// Whether it was interrupted after its verdict.
  [[nodiscard]] bool interrupted() const { return scenes_.back()->interrupted(); }

 private:
  [[nodiscard]] std::optional<std::string> joined_page(const report::RunRecord& record, TempFiles& files);

  const CosimOptions options_;
  Host& host_;
  std::vector<std::unique_ptr<SceneRun>> scenes_;
};

}  // namespace kage::cosim
