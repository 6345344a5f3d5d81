// SPDX-License-Identifier: Apache-2.0
#include "explore/plot/module/table.hpp"

extern "C" const kage::ModuleHead* kage_plots_table() {
  static const kage::plot::PlotModule kTable{
      {KAGE_MODULE_VERSION}, kage::plot::module::width, kage::plot::module::image};
  return &kTable;
}
