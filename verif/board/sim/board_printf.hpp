// SPDX-License-Identifier: Apache-2.0
// Every part of a board's model has this first: what the model prints goes to board_model.cpp.
#pragma once
void kage_board_printf(const char* format, ...) __attribute__((format(printf, 1, 2)));
