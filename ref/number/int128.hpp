// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kage {

// __int128 is no ISO C++; __extension__ says that this is meant.
__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 Uint128;

}  // namespace kage
