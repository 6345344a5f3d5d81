// SPDX-License-Identifier: Apache-2.0
// Fields of tokens and pixels by the numbers of the C interface.
#pragma once

#include "kage/core.hpp"
#include "kage/token.hpp"

/// A field that the configuration has, of a pixel of the line; or KAGE_PIXEL_ANY.
int pixel_field(const kage::Config& config, const kage::LineView& line, int x, int field);

/// A field of a token, KAGE_TOKEN_...; 0 if its kind has no such field in the configuration.
long long token_field(const kage::Config& config, const kage::Layout& layout, const kage::Token& t, int field);
