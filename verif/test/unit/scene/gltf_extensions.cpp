// SPDX-License-Identifier: Apache-2.0
// Each extension of the Khronos list is drawn, or named: where a file says that it uses or requires it, and where it
// stands.
#include <set>

#include "gltf_outcome.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::Json;
using test::Outcome;

namespace {

/// The Khronos list: github.com/KhronosGroup/glTF/tree/main/extensions, archived ones too, and drafts.
const std::vector<std::string> kExtensions{"ADOBE_materials_clearcoat_specular",
                                           "ADOBE_materials_clearcoat_tint",
                                           "ADOBE_materials_thin_transparency",
                                           "AGI_articulations",
                                           "AGI_stk_metadata",
                                           "CESIUM_primitive_outline",
                                           "EXT_feature_metadata",
                                           "EXT_implicit_cylinder_region",
                                           "EXT_implicit_ellipsoid_region",
                                           "EXT_instance_features",
                                           "EXT_lights_ies",
                                           "EXT_lights_image_based",
                                           "EXT_mesh_features",
                                           "EXT_mesh_gpu_instancing",
                                           "EXT_mesh_manifold",
                                           "EXT_mesh_primitive_restart",
                                           "EXT_meshopt_compression",
                                           "EXT_primitive_voxels",
                                           "EXT_structural_metadata",
                                           "EXT_texture_avif",
                                           "EXT_texture_webp",
                                           "FB_geometry_metadata",
                                           "GODOT_single_root",
                                           "GRIFFEL_bim_data",
                                           "KHR_accessor_float64",
                                           "KHR_animation_pointer",
                                           "KHR_audio_emitter",
                                           "KHR_collision_shapes",
                                           "KHR_draco_mesh_compression",
                                           "KHR_gaussian_splatting",
                                           "KHR_implicit_shapes",
                                           "KHR_interactivity",
                                           "KHR_lights_punctual",
                                           "KHR_materials_anisotropy",
                                           "KHR_materials_clearcoat",
                                           "KHR_materials_diffuse_transmission",
                                           "KHR_materials_dispersion",
                                           "KHR_materials_emissive_strength",
                                           "KHR_materials_ior",
                                           "KHR_materials_iridescence",
                                           "KHR_materials_pbrSpecularGlossiness",
                                           "KHR_materials_sheen",
                                           "KHR_materials_specular",
                                           "KHR_materials_subsurface",
                                           "KHR_materials_transmission",
                                           "KHR_materials_unlit",
                                           "KHR_materials_variants",
                                           "KHR_materials_volume",
                                           "KHR_materials_volume_scatter",
                                           "KHR_mesh_quantization",
                                           "KHR_meshopt_compression",
                                           "KHR_node_hoverability",
                                           "KHR_node_selectability",
                                           "KHR_node_visibility",
                                           "KHR_physics_rigid_bodies",
                                           "KHR_techniques_webgl",
                                           "KHR_texture_basisu",
                                           "KHR_texture_transform",
                                           "KHR_xmp",
                                           "KHR_xmp_json_ld",
                                           "MPEG_accessor_timed",
                                           "MPEG_animation_timing",
                                           "MPEG_audio_spatial",
                                           "MPEG_buffer_circular",
                                           "MPEG_media",
                                           "MPEG_mesh_linking",
                                           "MPEG_scene_dynamic",
                                           "MPEG_texture_video",
                                           "MPEG_viewport_recommended",
                                           "MSFT_lod",
                                           "MSFT_packing_normalRoughnessMetallic",
                                           "MSFT_packing_occlusionRoughnessMetallic",
                                           "MSFT_texture_dds",
                                           "NV_materials_mdl",
                                           "VRMC_materials_mtoon",
                                           "VRMC_node_constraint",
                                           "VRMC_springBone",
                                           "VRMC_vrm"};

const std::set<std::string> kDrawn{"KHR_lights_punctual",
                                   "KHR_materials_emissive_strength",
                                   "KHR_materials_pbrSpecularGlossiness",
                                   "KHR_materials_transmission",
                                   "KHR_materials_unlit",
                                   "KHR_mesh_quantization",
                                   "KHR_node_visibility"};
const std::set<std::string> kAbout{"KHR_xmp", "KHR_xmp_json_ld"};
const std::set<std::string> kOfTextures{"EXT_texture_avif", "EXT_texture_webp", "KHR_texture_basisu",
                                        "KHR_texture_transform", "MSFT_texture_dds"};

}  // namespace

TEST_CASE("each extension of the Khronos list is drawn, or named once; where it is required, drawn or refused") {
  for (const std::string& name : kExtensions) {
    INFO(name);
    const bool quiet = kDrawn.count(name) + kAbout.count(name) > 0;
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      Json doc = test::base();
      doc[list].push_back(name);
      const Outcome got = test::outcome(doc);
      const bool required = list == std::string("extensionsRequired");
      const bool refused = got.drawn.rfind("refused", 0) == 0;
      CHECK(refused == (required && !quiet && kOfTextures.count(name) == 0));
      if (refused) CHECK(got.drawn.find(name) != std::string::npos);
      if (!refused) CHECK(got.says(name) == !quiet);
      CHECK(got.notes.size() == (refused || quiet ? 0 : 1));
    }
    // Not in any list, which the format demands, but at some place.
    for (const char* place : {"/materials/0", "/nodes/0", "/meshes/0/primitives/0", "/accessors/0", ""}) {
      if (quiet) continue;
      Json doc = test::base();
      doc[Json::json_pointer(std::string(place) + "/extensions/" + name)] = Json::object();
      const Outcome got = test::outcome(doc);
      INFO(place);
      CHECK(got.says(name) != got.says("GPU instances"));
      CHECK(got.notes.size() == 1);
    }
  }
}

TEST_CASE("an extension that is drawn is named where it stands at a wrong place") {
  for (const std::string& name : kDrawn) {
    Json doc = test::base();
    doc["cameras"][0]["extensions"][name] = Json::object();
    const Outcome got = test::outcome(doc);
    CHECK(got.says("cameras/extensions/" + name));
  }
}
