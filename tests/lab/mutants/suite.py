# SPDX-License-Identifier: GPL-3.0-or-later
"""The default suite of a build: what ctest would run, by program, up to the first failure."""
import json
import os
import re
import selectors
import signal
import subprocess
import time
from pathlib import Path
from typing import NamedTuple

MOST_CASES = 400  # in one filter: a command line is finite


class Entry(NamedTuple):
    """A line of ctest's list: a part of a test program, or another command."""
    name: str
    command: list
    environment: dict
    folder: str
    cases: list  # Suite.Name of each; empty: not a GoogleTest program

    @property
    def program(self):
        return Path(self.command[0]).name


class Failure(NamedTuple):
    test: str  # program/Suite.Name, or ctest's name
    entry: Entry
    case: str  # empty: the command as a whole
    how: str   # failed, crashed, timeout


def _properties(test):
    return {p["name"]: p["value"] for p in test.get("properties", [])}


def _cases_of(command, environment, folder):
    """Suite.Name of each case that a command would run; empty if it is no GoogleTest program."""
    try:
        listed = subprocess.run(command + ["--gtest_list_tests"], cwd=folder, env=environment,
                                capture_output=True, text=True, errors="replace", timeout=60, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return []
    cases = []
    suite = ""
    for line in listed.stdout.splitlines():
        word = line.split("#")[0].strip()
        if re.fullmatch(r"[\w/]+\.", word) and not line.startswith(" "):
            suite = word
        elif line.startswith("  ") and suite and "DISABLED_" not in suite + word:
            cases.append(suite + word)
    return cases


def _with_filter(command, cases, skipped):
    """A command for these cases, all where none are named, less those that are skipped."""
    wanted = ":".join(c for c in cases if c not in skipped) or "*"
    if skipped and not cases:
        wanted += "-" + ":".join(skipped)
    return command if wanted == "*" else command + [f"--gtest_filter={wanted}"]


class Suite:
    """The tests of a build folder."""

    def __init__(self, build, limit_s):
        self.build = Path(build)
        self.limit_s = limit_s
        self.excluded = set()  # tests that fail without a fault
        self.seconds = {}      # of each command that passed
        listed = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, check=True,
                                capture_output=True, text=True, errors="replace").stdout
        self.entries = [self._entry(test) for test in json.loads(listed)["tests"]
                        if "command" in test and not _properties(test).get("DISABLED")]

    def _entry(self, test):
        properties = _properties(test)
        environment = dict(v.split("=", 1) for v in properties.get("ENVIRONMENT", []))
        folder = properties.get("WORKING_DIRECTORY", str(self.build))
        command = test["command"]
        in_tests = str(self.build / "tests") in command[0]
        cases = _cases_of(command, os.environ | environment, folder) if in_tests else []
        if not cases:  # ctest knows what a pass is
            command = ["ctest", "--test-dir", str(self.build), "-R",
                       "^" + re.escape(test["name"]) + "$", "--output-on-failure"]
        return Entry(test["name"], command, environment, folder, cases)

    def first_failure(self, fault, folder, tell):
        """The first test that fails with a fault and passes without; None if all pass."""
        flaky = set()
        for entry, cases in self._order(fault, folder):
            while True:
                failure = self._run(entry, cases, flaky, fault.name)
                if failure is None:
                    break
                if self._is_caught(failure, fault.name):
                    return failure
                flaky.add(failure.test)
                tell(f"{fault.name}: {failure.test} is not counted")
                if not failure.case:
                    break
        return None

    def _order(self, fault, folder):
        """Tests named like the fault, then all: those of the folder first."""
        near = re.compile(fault.near, re.IGNORECASE)
        entries = sorted(self.entries, key=lambda entry: self._rank(entry, folder))
        for entry in entries:
            cases = [c for c in entry.cases if near.search(f"{entry.program}/{entry.name}/{c}")][:MOST_CASES]
            if cases or not entry.cases and near.search(entry.name):
                yield entry, cases
        for entry in entries:
            yield entry, entry.cases

    def _rank(self, entry, folder):
        is_near = any(word in entry.name for word in folder)
        return (not entry.cases, not is_near, self.seconds.get(entry.name, 60.0))

    def _is_caught(self, failure, fault):
        """Whether a test fails alone with the fault again, and passes without."""
        cases = [failure.case] if failure.case else []
        if self._run(failure.entry, cases, set(), None) is not None:
            self.excluded.add(failure.test)
            return False
        if failure.how == "timeout":
            return True
        return self._run(failure.entry, cases, set(), fault) is not None

    def _run(self, entry, cases, left_out, fault):
        """Runs cases of an entry until one fails."""
        environment = os.environ | entry.environment | {"GTEST_FAIL_FAST": "1"}
        environment.pop("CHAINTRUE_MUTANT", None)
        if fault:
            environment["CHAINTRUE_MUTANT"] = fault
            left_out = left_out | self.excluded
        program = entry.program
        skipped = [t[len(program) + 1:] for t in left_out if t.startswith(program + "/")]
        if entry.name in left_out or (cases and set(cases) <= set(skipped)):
            return None
        is_whole = cases == entry.cases
        if not is_whole:  # what another shard would run is named here
            environment.pop("GTEST_TOTAL_SHARDS", None)
            environment.pop("GTEST_SHARD_INDEX", None)
        command = _with_filter(entry.command, [] if is_whole else cases, skipped)
        begun = time.monotonic()
        code, case, is_hung = self._watched(command, environment, entry)
        if code == 0 and not is_hung:
            if is_whole:
                self.seconds[entry.name] = time.monotonic() - begun
            return None
        how = "timeout" if is_hung else "failed" if code > 0 else "crashed"
        return Failure(f"{program}/{case}" if entry.cases else entry.name, entry, case, how)

    def _watched(self, command, environment, entry):
        """Exit code, the case that failed or ran last, and whether it was silent for too long."""
        process = subprocess.Popen(command, cwd=entry.folder, env=environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL, start_new_session=True)
        case = failed = ""
        rest = b""
        has_begun = False  # until then it may wait for its turn
        with selectors.DefaultSelector() as waiting:
            waiting.register(process.stdout, selectors.EVENT_READ)
            while True:
                if not waiting.select(self.limit_s if has_begun else None):
                    os.killpg(process.pid, signal.SIGKILL)
                    process.wait()
                    return process.returncode, case, True
                block = os.read(process.stdout.fileno(), 65536)
                if not block:
                    break
                has_begun = True
                *lines, rest = (rest + block).split(b"\n")
                for line in lines:
                    if found := re.match(rb"\[ RUN      \] (\S+)", line):
                        case = found.group(1).decode()
                    elif found := re.match(rb"\[  FAILED  \] ([\w/]+\.[\w/]+)", line):
                        failed = failed or found.group(1).decode()
        return process.wait(), failed or case, False
