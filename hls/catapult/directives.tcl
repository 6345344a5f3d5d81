# not run here
# Catapult: catapult -shell -file directives.tcl, in this folder. One kernel at a time: TOP names it. The functions are
# those of hls/tops/kernels.cpp.
set TOP hls_edge_setup
solution new -state initial
solution options set /Input/CppStandard c++14
solution options set /Input/CompilerFlags {-DKAGE_HLS_AC -I..}
solution file add ../tops/kernels.cpp -type C++
directive set -DESIGN_HIERARCHY $TOP
go compile
solution library add mgc_Xilinx-ARTIX-7-1_beh -- -rtlsyntool Vivado -manufacturer Xilinx -family ARTIX-7 -speed -1 -part xc7a100tcsg324-1
go libraries
directive set -CLOCKS {clk {-CLOCK_PERIOD 8.0}}
go assembly
directive set /$TOP/core/main -PIPELINE_INIT_INTERVAL 1
go architect
go allocate
go extract
