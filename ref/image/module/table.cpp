// SPDX-License-Identifier: Apache-2.0
#include "image/module/table.hpp"

extern "C" const kage::ModuleHead* kage_pictures_table() {
  static const kage::PictureModule kTable{
      {KAGE_MODULE_VERSION}, kage::picture_module::open, kage::picture_module::encode_exr, kage::picture_module::yee};
  return &kTable;
}
