// SPDX-License-Identifier: Apache-2.0
#include "scene/plugin/table.hpp"

extern "C" const kage::PluginHead* kage_meshes_table() {
  static const kage::scene::MeshPlugin kTable{{KAGE_PLUGIN_VERSION}, kage::scene::mesh_plugin::read};
  return &kTable;
}
