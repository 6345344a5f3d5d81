# SPDX-License-Identifier: Apache-2.0
"""The steps of a build: tools that are run, what they say, and how the build ends where one fails."""

import errno
import os
import re
import signal
import subprocess
import sys
import tempfile


def fail(message):
    print(f"build.py: {message}", file=sys.stderr)
    sys.exit(2)


# Messages of a tool that may write no more, in the system's words.
NO_ROOM = [os.strerror(e) for e in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS)]


class Log:
    """Text of the steps. The disk of its file may be full: then the build goes on, or says its cause, without one."""

    def __init__(self, path):
        self.path = path
        self.whole = True
        self.write("", "w")

    def write(self, text, mode="a"):
        try:
            with open(self.path, mode) as out:
                out.write(text)
        except OSError:
            self.whole = False


def no_room(text, folder):
    """Why a step could not write, or None: as its tool said it, or, as not every tool says it, as a try in the folder says it."""
    said = next((words for words in NO_ROOM if words in text), None)
    if said:
        return said
    try:
        with tempfile.TemporaryFile(dir=folder) as probe:
            probe.write(bytes(1 << 18))
            probe.flush()
            os.fsync(probe.fileno())
    except OSError as e:
        return e.strerror
    return None


# Folders with blanks in their names, and the names that tools get for them: Verilator takes a blank for the end of a file's
# name. Each is an open descriptor, which the tools inherit and which leaves nothing behind.
PLAIN = {}


def without_blanks(folder):
    """Tools get a name without blanks for `folder`, and messages the one that it has."""
    folder = str(folder)
    if any(c.isspace() for c in folder) and folder not in PLAIN:
        PLAIN[folder] = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)


def for_tools(text):
    for folder in sorted(PLAIN, key=len, reverse=True):
        text = re.sub(re.escape(folder) + r"(?=[/\s;]|$)", f"/proc/self/fd/{PLAIN[folder]}", text)
    return text


def for_people(text):
    for folder, descriptor in PLAIN.items():
        text = text.replace(f"/proc/self/fd/{descriptor}/", folder + "/")
    return text


def run(step, command, log, otherwise=None):
    """A step of the build, which ends it if it fails; or, with `otherwise`, if that makes nothing of what the step said."""
    command = [str(c) for c in command]
    try:
        done = subprocess.run(
            [for_tools(c) for c in command],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            restore_signals=False,
            pass_fds=tuple(PLAIN.values()),
        )
    except OSError as e:
        fail(f"{step}: {command[0]}: {e.strerror}")
    text = for_people(done.stdout.decode(errors="replace"))
    log.write("$ " + " ".join(command) + "\n" + text)
    if done.returncode == 0:
        return True
    if otherwise and otherwise(text):
        return False
    if log.whole:
        print(f"build.py: the log is {log.path}", file=sys.stderr)
    wanted = [
        line.strip() for line in text.splitlines() if "rror" in line or "FAILED" in line or line.startswith("%Warning")
    ]
    cause = no_room(text, log.path.parent) or (wanted[0] if wanted else f"exit status {done.returncode}")
    fail(f"{step} failed: {cause}")


def end_all(number, _):
    """The build is over, and so are the tools that it has started."""
    signal.signal(number, signal.SIG_IGN)
    if os.getpgrp() == os.getpid():
        os.killpg(0, number)
    sys.exit(128 + number)
