# SPDX-License-Identifier: GPL-3.0-or-later
"""The command as a process: how it ended, its output, and what must be true of both for every input.

Words and texts are strings of Latin-1, so that any bytes can stand in them.
"""
import os
import re
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

SANITIZER = "exitcode=99"  # differs from the command's own codes
ENVIRONMENT = os.environ | {"ASAN_OPTIONS": f"detect_leaks=0:{SANITIZER}",
                            "UBSAN_OPTIONS": f"halt_on_error=1:print_stacktrace=1:{SANITIZER}"}
LAST_OWN_CODE = 4
NO_NUMBER = re.compile(r"(?<![\w\x80-\xff])(?:nan|inf)(?![\w\x80-\xff])", re.ASCII)


def text_of(path):
    return path.read_bytes().decode("latin-1") if path.is_file() else ""


def no_number_in(text):
    """The place of the first nan or inf that is a word; empty if there is none.

    A page contains its scripts, which include such words; its numbers are those of files.
    """
    found = None if text.startswith("<!DOCTYPE") else NO_NUMBER.search(text)
    return text[max(0, found.start() - 40):found.start() + 40] if found else ""


@dataclass
class Ended:
    code: int  # below 0: the signal
    seconds: float
    out: str
    err: str
    is_endless: bool = False

    def fault(self):
        """A signal, no end, an internal error, an undocumented exit code, silence, or a number that is not finite."""
        if self.is_endless:
            return "no end within the time limit"
        if self.code < 0:
            return f"signal {-self.code}"
        if "internal error" in self.err:
            return "an internal error"
        if self.code > LAST_OWN_CODE:
            return f"exit code {self.code}"
        if self.code >= 2 and not self.err:
            return "refused without a word"
        number = no_number_in(self.out)
        return f"a number that is none: {number}" if number else ""


@dataclass
class Command:
    program: Path
    folder: Path  # in which it runs
    limit_s: float

    def run(self, words, signal=None, after_s=0.0):
        """`signal`: sent to it after this time."""
        began = time.monotonic()
        # As of a shell, a word ends at its first NUL.
        line = [b"chaintrue"] + [word.split("\0")[0].encode("latin-1") for word in words]
        with subprocess.Popen(line, executable=self.program, cwd=self.folder, env=ENVIRONMENT, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            if signal:
                time.sleep(after_s)
                process.send_signal(signal)
            is_endless = False
            try:
                streams = process.communicate(timeout=self.limit_s)
            except subprocess.TimeoutExpired:
                is_endless = True
                process.kill()
                streams = process.communicate()
        out, err = (stream.decode("latin-1") for stream in streams)
        return Ended(process.returncode, time.monotonic() - began, out, err, is_endless)
