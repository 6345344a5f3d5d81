# SPDX-License-Identifier: Apache-2.0
"""An error of the user, in one line."""


class Trouble(Exception):
    pass
