// SPDX-License-Identifier: Apache-2.0
//
// What is wrong in the pictures of a run, as pictures and as numbers: kage render --error-map.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cosim/session/source.hpp"
#include "file/temp_file.hpp"
#include "options.hpp"
#include "results.hpp"
#include "trade/sweep_scene.hpp"

namespace kage::cli {

class ErrorMaps {
 public:
  /// `source` is of a scene, drawn as the options say.
  ErrorMaps(const Options& options, const cosim::Source& source);

  /// Makes the maps of a frame beside its picture: NAME_error.png, and NAME_error_SOURCE.png for each source that has
  /// any error. One of an earlier run for a source that has none now goes.
  void frame(int index, const std::filesystem::path& picture, TempFiles& files);

  /// An entry for each frame: docs/schema/render.json, "errors".
  [[nodiscard]] const Json& json() const { return json_; }
  /// A line for each frame.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  trade::SweepPoint point_;
  std::unique_ptr<trade::SweepScene> scene_;
  Json json_ = Json::array();
  std::string text_;
};

}  // namespace kage::cli
