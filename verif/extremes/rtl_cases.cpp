// SPDX-License-Identifier: Apache-2.0
#include "extremes/rtl_cases.hpp"

namespace kage::verif {

const std::vector<const char*>& model_names() {
  static const std::vector<const char*> names{"flat4"};
  return names;
}

}  // namespace kage::verif
