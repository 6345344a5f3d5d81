// SPDX-License-Identifier: Apache-2.0
#include "explore/plot/plugin/table.hpp"

extern "C" const kage::PluginHead* kage_plots_table() {
  static const kage::plot::PlotPlugin kTable{
      {KAGE_PLUGIN_VERSION}, kage::plot::plugin::width, kage::plot::plugin::image};
  return &kTable;
}
