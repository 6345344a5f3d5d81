# SPDX-License-Identifier: Apache-2.0
"""Clicks and keys on the pages that run.sh had written, held against kage itself.

usage: report.py KAGE CHROMIUM PICTURES
"""

import sys

from browser import Browser
from different import different_run
from front_end import front_end_run
from histories import histories
from joined import joined_run
from limits import full_page, odd_name
from looks import before_pictures
from page import check, chromium, failures
from same import recalled_run, same_run

with Browser(chromium) as browser:
    parts = (before_pictures, same_run, recalled_run, different_run, front_end_run, full_page, odd_name, joined_run)
    for part in (*parts, histories):
        part(browser)
    check(not browser.errors, f"the console has errors: {browser.errors[:3]}")
    outside = [
        u
        for u in browser.requests
        if not u.startswith(("data:", "file:")) or (u.startswith("file:") and not u.endswith("report.html"))
    ]
    check(not outside, f"the page loads {outside[:3]}")
sys.exit(len(failures) != 0)
