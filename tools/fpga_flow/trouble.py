# SPDX-License-Identifier: Apache-2.0
"""An error that ends a run: one line on standard error, exit code 2."""


class Trouble(Exception):
    """Its text names file or option, and the cause."""
