# SPDX-License-Identifier: Apache-2.0
"""What a person did wrong, told in one line."""


class Trouble(Exception):
    pass
