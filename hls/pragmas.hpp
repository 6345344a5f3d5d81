// SPDX-License-Identifier: Apache-2.0

/// @file
/// What the vendors' tools are told within kernels, behind names of ours: nothing for kage's own tool and for tests.
/// Not run here: neither Vitis HLS nor Catapult is free to have.
#pragma once

#if defined(KAGE_HLS_AP)
/// The kernel takes an input each clock.
#define KAGE_HLS_PIPELINE _Pragma("HLS PIPELINE II=1")
/// The loop that follows becomes hardware for each of its rounds.
#define KAGE_HLS_UNROLL
/// The same, as the first line of the loop's body, which is where Vitis looks for it.
#define KAGE_HLS_UNROLLED _Pragma("HLS UNROLL")
#elif defined(KAGE_HLS_AC)
#define KAGE_HLS_PIPELINE
#define KAGE_HLS_UNROLL _Pragma("hls_unroll yes")
#define KAGE_HLS_UNROLLED
#else
#define KAGE_HLS_PIPELINE
#define KAGE_HLS_UNROLL
#define KAGE_HLS_UNROLLED
#endif
