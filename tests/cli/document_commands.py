#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command that a document shows has verbs and options that the command has, whether a test runs it or not.

Usage: document_commands.py COMMAND ROOT. Looked at are lines of indented blocks, and code within a line, that
begin with chaintrue or build/chaintrue; and code within a line that begins with a verb and has an option. A link
in docs/index.md makes a document one of those looked at.
"""

import functools
import pathlib
import re
import subprocess
import sys

FEWEST = 100


@functools.lru_cache(maxsize=None)
def help_of(command, *verbs):
    return subprocess.run([command, *verbs, "--help"], capture_output=True, text=True, timeout=30, check=True).stdout


def verbs_in(text):
    """Those below "Subcommands:" of a help text."""
    below = re.search(r"^Subcommands:\n(.*?)(?:\n\n|\Z)", text, re.S | re.M)
    return re.findall(r"^  ([a-z0-9]+)", below[1], re.M) if below else []


def documents(root):
    index = (root / "docs/index.md").read_text(encoding="utf-8")
    found = [(root / "docs" / target).resolve() for target in re.findall(r"\]\(([^)#]*\.md)\)", index)]
    # A changelog mentions versions with other options.
    return [root / "README.md"] + [path for path in found if path.name != "CHANGELOG.md"]


def commands_in(text, verbs):
    """(line number, words after the command's name) of each."""
    text = re.sub(r"\\\n\s*", " ", text)
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("    "):
            shown = [line.strip().removeprefix("$ ")]
        else:
            shown = re.findall(r"`([^`]+)`", line)
            shown = [code if code.split()[0] not in verbs or "--" not in code else f"chaintrue {code}" for code in shown if code.split()]
        for code in shown:
            found = re.match(r"(?:build/)?chaintrue ((?:[^|;&#`]|#\S)*)", code)
            if found:
                yield number, found[1].split()


def problem_of(command, words):
    """Follows the words through the verbs; what is wrong, or nothing."""
    verbs, at = [], 0
    offered = verbs_in(help_of(command))
    while at < len(words) and words[at] in offered:
        verbs.append(words[at])
        offered = verbs_in(help_of(command, *verbs))
        at += 1
    if not verbs and words and re.fullmatch(r"[a-z][a-z0-9]*", words[0]) and words[0] != "help":
        return f"there is no verb {words[0]}"
    # Options before a verb are also accepted after it.
    known = set(re.findall(r"(?<![\w-])--?[a-zA-Z][\w-]*", help_of(command) + help_of(command, *verbs)))
    for word in words[at:]:
        option = re.match(r"(--[a-z][\w-]*|-[a-zA-Z])(?=[=,.)\]]|$)", word)
        if option and option[1] not in known:
            return f"chaintrue {' '.join(verbs)} has no option {option[1]}"
    return None


def main():
    command, root = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    verbs = verbs_in(help_of(command))
    looked_at = problems = 0
    for document in documents(root):
        for number, words in commands_in(document.read_text(encoding="utf-8"), verbs):
            looked_at += 1
            problem = problem_of(command, words)
            if problem:
                problems += 1
                print(f"{document.relative_to(root)}, about line {number}: {problem}: {' '.join(words)}")
    print(f"{looked_at} commands, {problems} with a verb or an option that there is not")
    sys.exit(1 if problems or looked_at < FEWEST else 0)


main()
