#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Elaboration refuses every parameter out of its range and every pair that does not fit, by name; the edges of the ranges pass.
#
# usage: parameters.sh SOURCE_DIR
set -uo pipefail
cd "$1" || exit 1
bad=0
try() { # PARAM=VALUE...: what Verilator says
  # shellcheck disable=SC2046 # an option per parameter
  verilator --lint-only -Wall -Irtl/include --top-module kage_top $(printf -- '-G%s ' "$@") rtl/*.sv 2>&1
}
refuses() { # TEXT PARAM=VALUE...
  local text=$1 said
  shift
  said=$(try "$@") && { echo "$*: accepted"; bad=1; return; }
  case $said in *"$text"*) ;; *) echo "$*: refused, but not by: $text"; echo "$said" | head -3; bad=1 ;; esac
}
accepts() {
  local said
  said=$(try "$@") || { echo "$*: refused"; echo "$said" | head -3; bad=1; }
}

refuses "X_BITS must be" X_BITS=3 MAX_WIDTH=7
refuses "X_BITS must be" X_BITS=16
refuses "Z_BITS must be" Z_BITS=3
refuses "Z_BITS must be" Z_BITS=29
refuses "Z_FRAC must be" Z_FRAC=17
refuses "CHANNELS must be" CHANNELS=2
refuses "SMOOTH must be" SMOOTH=2
refuses "COLOR_FRAC must be" COLOR_FRAC=17 SMOOTH=1
refuses "DSF_BITS must be" DSF_BITS=9
refuses "FSF must be" FSF=2
refuses "SHADE_FRAC must be" SHADE_FRAC=17
refuses "ARRANGEMENT must be" ARRANGEMENT=2
refuses "LANES must be" LANES=3
refuses "LANES must be" LANES=64
refuses "MAX_WIDTH must be" MAX_WIDTH=2048
refuses "BEAT_WORDS must be" BEAT_WORDS=3
refuses "FSF needs DSF_BITS" DSF_BITS=0
refuses "COUNT_BITS must be" COUNT_BITS=9
refuses "LIGHTS must be" LIGHTS=9 COUNT_BITS=1 CLASS_BITS=2
refuses "CLASS_BITS must be" CLASS_BITS=12 COUNT_BITS=1
refuses "COUNT_BITS > 0 needs DSF_BITS" COUNT_BITS=1 DSF_BITS=0 FSF=0
refuses "CLASS_BITS > 1 needs COUNT_BITS" CLASS_BITS=2
refuses "LIGHTS > 1 needs" LIGHTS=2
refuses "LIGHTS > 1 needs" LIGHTS=2 COUNT_BITS=1
refuses "COLOR_FRAC > 0 needs SMOOTH" COLOR_FRAC=4
refuses "UNITS must be" UNITS=65
refuses "CLASSIC needs" CLASSIC=1 UNITS=2
refuses "CLASSIC needs" CLASSIC=1 UNITS=2 Z_BITS=15 Z_FRAC=0 DX_BITS=8
accepts X_BITS=4 MAX_WIDTH=15 Z_BITS=4 Z_FRAC=0 CHANNELS=1 DSF_BITS=0 FSF=0 SHADE_FRAC=1 LANES=32 BEAT_WORDS=8
accepts X_BITS=15 MAX_WIDTH=32767 Z_BITS=28 Z_FRAC=16 SMOOTH=1 COLOR_FRAC=16 DSF_BITS=8 SHADE_FRAC=16 LANES=1 BEAT_WORDS=1
accepts X_BITS=11 MAX_WIDTH=2047
accepts MAX_WIDTH=1
accepts MAX_WIDTH=1 ARRANGEMENT=0
accepts UNITS=64 LANES=32 SMOOTH=1 FACE_BITS=12 DX_BITS=15 SEG_BITS=12 ORDER_BITS=16
accepts UNITS=1 MAX_WIDTH=1 ARRANGEMENT=0 DSF_BITS=0 FSF=0 CHANNELS=1 FACE_BITS=2 DX_BITS=2 SEG_BITS=2 ORDER_BITS=1
accepts COUNT_BITS=8 LIGHTS=8 CLASS_BITS=11 SHADE_FRAC=16 TRANSLUCENCY=1 UNITS=3 SMOOTH=1 COLOR_FRAC=16 LANES=32
accepts COUNT_BITS=8 LIGHTS=8 CLASS_BITS=11 SHADE_FRAC=1 FSF=0 DSF_BITS=8 CHANNELS=1 ARRANGEMENT=0 MAX_WIDTH=9
accepts COUNT_BITS=1 CLASS_BITS=2 UNITS=1 LANES=1 BEAT_WORDS=1 SHADE_FRAC=16
accepts COUNT_BITS=1 X_BITS=4 MAX_WIDTH=15 Z_BITS=4 Z_FRAC=0 CHANNELS=1 FSF=0 TRANSLUCENCY=1
accepts UNITS=5 CLASSIC=1 Z_BITS=15 Z_FRAC=0
exit $bad
