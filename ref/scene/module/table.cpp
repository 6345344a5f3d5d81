// SPDX-License-Identifier: Apache-2.0
#include "scene/module/table.hpp"

extern "C" const kage::ModuleHead* kage_meshes_table() {
  static const kage::scene::MeshModule kTable{{KAGE_MODULE_VERSION}, kage::scene::mesh_module::read};
  return &kTable;
}
