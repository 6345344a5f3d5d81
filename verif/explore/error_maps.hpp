// SPDX-License-Identifier: Apache-2.0
//
// Errors in the pictures of a run, as pictures and as numbers: kage render --error-map.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cosim/report/run_record.hpp"
#include "cosim/session/source.hpp"
#include "explore/sweep_scene.hpp"
#include "file/temp_file.hpp"
#include "kage/cosim.hpp"

namespace kage::explore {

class ErrorMaps {
 public:
  /// `source` is of a scene, drawn as the options say. `host` must outlive it.
  ErrorMaps(const cosim::SourceOptions& options, const cosim::Source& source, cosim::Host& host);

  /// Makes the maps of a frame beside its picture: NAME_error.png, and NAME_error_SOURCE.png for each source that has
  /// any error. One of an earlier run for a source that has none now goes.
  void frame(int index, const std::filesystem::path& picture, TempFiles& files);

  /// An entry for each frame: docs/schema/render.json, "errors".
  [[nodiscard]] const report::Json& json() const { return json_; }
  /// A line for each frame.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  cosim::Host& host_;
  SweepPoint point_;
  std::unique_ptr<SweepScene> scene_;
  report::Json json_ = report::Json::array();
  std::string text_;
};

}  // namespace kage::explore
