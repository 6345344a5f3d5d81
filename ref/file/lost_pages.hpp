// SPDX-License-Identifier: Apache-2.0
//
// A mapped file raises SIGBUS where its bytes cannot be had: another program has cut it off, or a disk is full on which
// they were to be. From guard_pages() on, such pages are zeros instead, in memory alone, and are counted: whoever uses
// a mapped file asks lost_pages() whether what it read or wrote is true.
#pragma once

namespace kage {

/// From now on lost pages end no program. To be called before the first mapped file is used.
void guard_pages();

/// How many pages have been lost so far.
int lost_pages();

/// The count is as it was: for pages of files that are needed no more.
void forget_lost_pages(int count);

}  // namespace kage
