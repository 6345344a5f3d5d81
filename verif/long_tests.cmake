# SPDX-License-Identifier: Apache-2.0
# The long tests: those that take half a minute of processor time and more, or whose programs and models take it to build, and
# that show a case more rather than another thing. `tools/test` leaves them out, and builds nothing for them alone;
# `tools/test --long` runs them, and CI does both.
set(long_tests
    axi/fault_lost_token
    axi/fault_polite_ready
    axi/fault_silent_registers
    axi/fault_wrong_compare
    axi/rebuild
    axi/tiny
    board/rehearsal # tools/rehearse, which CI runs, has it with faults
    cli/area
    cli/assertion
    cli/assimp_models
    cli/broken_frame
    cli/ci_docs
    cli/cosim_jobs
    cli/cosim_polyhedra
    cli/cosim_verdicts
    cli/degrade
    cli/faults
    cli/front_end_scenes
    cli/full_disk
    cli/hang
    cli/killed
    cli/little_memory
    cli/memory
    cli/model_cache
    cli/model_source
    cli/random
    cli/register_answers
    cli/regress
    cli/renamed_net
    cli/report
    cli/schema
    cli/sweep_page
    cli/sweep_place
    cli/vectors_played
    examples/axi_dma
    examples/dpi
    contract/counted
    contract/told_figures
    formal/async_fifo
    formal/compare_tree
    formal/kage_top
    formal/line_out
    formal/registers
    formal/sdram_controller
    formal/token_reader
    gates/models_ecp5
    gates/models_ice40
    mutants/all
    package/consumer
    rtl/cells
    rtl/core_clocks
    rtl/core_display
    rtl/elaborate_verilator # tools/lint verilator, too
    rtl/elaborate_yosys
    rtl/families_39_40_41_collision
    rtl/families_39_40_41_glass1
    rtl/families_39_40_41_glass32
    rtl/families_39_40_41_glass_grey
    rtl/families_39_40_41_glass_systolic
    rtl/families_39_40_41_glass_tree_systolic
    rtl/families_39_40_41_grey32
    rtl/families_39_40_41_lights_glass1
    rtl/families_39_40_41_lights_glass32
    rtl/families_39_40_41_lights_smooth
    rtl/families_39_40_41_lights_tree
    rtl/families_39_40_41_smooth16
    rtl/families_39_40_41_soft_glass
    rtl/families_39_40_41_systolic
    rtl/families_39_40_41_systolic640
    rtl/families_39_40_41_tree1
    rtl/families_39_40_41_tree3systolic
    rtl/families_39_40_41_tree3wide
    rtl/families_39_40_41_tree4
    rtl/family_12_glass
    rtl/family_12_lights
    rtl/family_12_trees
    rtl/fault_count_wraps
    rtl/fault_early_refill
    rtl/fault_early_table
    rtl/fault_resolve_leaves_flags
    rtl/fault_sample_leaks
    rtl/fault_swallowed_toggle
    rtl/parameters
    rtl/tree_clocks
    scene/builtin_truth
    scene/depth_begin
    scene/meshes
    scene/plan
    scene/plan_measured
    scene/plan_reasons
    scene/polygon_level_large
    scene/precision
    tools/stub-cores
    tools/lint-verilator
    unit/cosim/stages)

# Target of all that long tests alone need: programs, models, and files that no test runs but that must compile.
add_custom_target(long_tests)

# kage_long_program(TARGET): one that `tools/test` does not build.
function(kage_long_program target)
  set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
  add_dependencies(long_tests ${target})
endfunction()

# kage_label_long_tests(): labels those of the folder at hand. To be called behind all of its tests.
function(kage_label_long_tests)
  get_property(tests DIRECTORY PROPERTY TESTS)
  foreach(test IN LISTS tests)
    if(test IN_LIST long_tests)
      set_property(
        TEST ${test}
        APPEND
        PROPERTY LABELS long)
      set_property(GLOBAL APPEND PROPERTY kage_long_tests_found ${test})
    endif()
  endforeach()
endfunction()
