// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/table.hpp"

extern "C" const kage::PluginHead* kage_pictures_table() {
  static const kage::PicturePlugin kTable{
      {KAGE_PLUGIN_VERSION}, kage::picture_plugin::open, kage::picture_plugin::encode_exr, kage::picture_plugin::yee};
  return &kTable;
}
