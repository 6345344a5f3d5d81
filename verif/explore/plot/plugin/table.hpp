// SPDX-License-Identifier: Apache-2.0
//
// The plugin of plots: what needs Cairo.
#pragma once

#include <cstddef>
#include <string_view>

#include "explore/plot/drawing.hpp"
#include "plugin/plugin.hpp"

namespace kage::plot {

/// How wide the edges of marks and of a text's halo are.
inline constexpr double kMarkEdge = 1.5;
inline constexpr double kHalo = 3;

struct PlotPlugin : PluginHead {
  static constexpr const char* kPlugin = "kage_plots";
  static constexpr const char* kWhatFor = "plots are drawn with it";
  /// Cairo starts no thread, and says where it finds no memory.
  static std::size_t room() { return 0; }

  /// As width_of().
  double (*width)(std::string_view text, double size, bool bold);
  /// As to_image().
  Image (*image)(const Drawing& drawing, double scale);
};

// Functions of the plugin, in its own files.
namespace plugin {
double width(std::string_view text, double size, bool bold);
Image image(const Drawing& drawing, double scale);
}  // namespace plugin

}  // namespace kage::plot
