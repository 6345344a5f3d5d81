#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The leavings of a run that is killed at any moment, and how signals end one: killed.py.
. "$(dirname "$0")/common.bash"

python3 "$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/killed.py" "$kage" "$source" || fail "killed.py"
done_testing
