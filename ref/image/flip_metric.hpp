// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kage/diff.hpp"
#include "kage/image.hpp"

namespace kage {

/// The difference evaluator FLIP for pictures of a limited range ("LDR-FLIP"): how large a difference a person sees who
/// flips between two pictures on one screen, 0 to 1 a pixel. [Andersson 2020]: P. Andersson, J. Nilsson, T.
/// Akenine-Moeller, M. Oskarsson, K. Astroem, M. Fairchild, "FLIP: A Difference Evaluator for Alternating Images",
/// Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2). Both pictures have three channels of
/// sRGB and one size. The screen is that paper's: 67.02 pixels a degree (0.7 m wide, 3840 pixels, seen from 0.7 m).
/// Computed in double; for diagnosis only, as exp() and pow() may differ between machines in the last bits.
FlipNumbers flip_metric(const Image& a, const Image& b);

}  // namespace kage
