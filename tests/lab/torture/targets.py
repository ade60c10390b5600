# SPDX-License-Identifier: GPL-3.0-or-later
"""What is attacked, by the tables of tests/inputs: every reader of a file, and every verb with its options.

In a call `IN` stands for the file under attack, `OUT` for the output.
"""
import re
import shutil
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
INPUTS = ROOT / "tests/inputs"
SLOW = {"diagnose", "sweep", "plan"}  # drawn less often
# Files that have every key, or another form.
MORE_FILES = {"grid_every_key.json": "good/grid_every_key.json", "commas.csv": "good/grid_decimal_commas_and_semicolons.csv",
              "machine_every_key.json": "good/machine_every_key.json", "holes.csv": "good/holes_plain.csv",
              "belts_every_key.json": "good/belts_every_key.json", "diagnosis_every_key.json": "good/diagnosis_every_key.json",
              "part.nc": "gcode/bracket.nc"}
MORE_READERS = [("grid_every_key.json", 4, "fit IN -o OUT"),
                ("commas.csv", 4, "fit IN --machine classic.json -o OUT"),
                ("holes.csv", 4, "fit IN --machine classic.json -o OUT"),
                ("machine_every_key.json", 4, "simulate --machine IN --grid 3x3"),
                ("machine_every_key.json", 4, "start IN OUT"),
                ("belts_every_key.json", 4, "fit IN -o OUT"),
                ("diagnosis_every_key.json", 4, "report IN -o OUT"),
                ("diagnosis_every_key.json", 2, "export groundcontrol IN"),
                ("part.nc", 10, "gcode check IN"),
                ("part.nc", 10, "gcode compensate IN --map map.json -o OUT")]
OPTION = re.compile(r"\s+(?:(-\w),)?(--(?!help)[a-z0-9-]+)(?: (TEXT|INT|FLOAT)(?::\{([^}]*)\})?[^ ]*( x 2)?)?(?:\s.*)?")


def rows(table):
    lines = (INPUTS / table).read_text().splitlines()
    return [line.split("\t") for line in lines if not line.startswith("#")]


VALUES = {row[0]: [value.removeprefix("@") for value in row[1:]] for row in rows("values.tsv")}


def is_output(option):
    return VALUES.get(option) == ["OUT"]


@dataclass
class Option:
    names: set
    name: str
    type: str  # TEXT, INT, FLOAT; empty: a flag
    values: list
    count: int


def options_in(text):
    found = (OPTION.fullmatch(line) for line in text.split("Example")[0].splitlines())
    return [Option({one[1], one[2]}, one[2], one[3] or "", one[4].split(",") if one[4] else VALUES.get(one[2], []),
                   2 if one[5] else 1) for one in found if one]


def words_of(line):
    words = line.split()
    for i, word in enumerate(words[:-1]):
        if word == "-o" or is_output(word):
            words[i + 1] = "OUT"
    return words[:-1] + ["OUT"] if words[0] == "start" else words


def plain(words):
    return [word.removeprefix("@") for word in words]


def output_of(words):
    return "out.html" if words[0] == "report" else "out"


@dataclass
class Targets:
    readers: list = field(default_factory=list)  # of (file, weight, words)
    calls: dict = field(default_factory=dict)    # by verb: lists of words that succeed
    options: dict = field(default_factory=dict)  # by verb


def targets(help_of):
    """Of the verbs of --help, each of which must have a call in the table."""
    found = Targets([(file, weight, line.split()) for file, weight, line in MORE_READERS])
    for verb, _, _, line in rows("invocations.tsv"):
        words = words_of(line)
        found.calls.setdefault(verb, []).append(plain(words))
        for i, word in enumerate(words):
            if word.startswith("@"):
                file, colon, rest = word[1:].partition(":")
                call = plain(words[:i]) + ["IN" + colon + rest] + plain(words[i + 1:])
                found.readers.append((file, 1 if verb in SLOW else 4, call))

    def below(verb):
        seconds = re.findall(r"^  ([a-z0-9]+) ", help_of(verb).partition("Subcommands:\n")[2], re.MULTILINE)
        return [f"{verb} {second}".strip() for second in seconds]

    for verb in below(""):
        for own in below(verb) or [verb]:
            found.options[own] = options_in(help_of(own))
    if uncovered := found.options.keys() - found.calls.keys():
        raise SystemExit(f"no call of {', '.join(uncovered)} in {INPUTS / 'invocations.tsv'}")
    return found


def make_files(command):
    """A file of every kind, in the command's folder."""
    for name, fixture in MORE_FILES.items() | map(tuple, rows("copied_files.tsv")):
        shutil.copy(ROOT / "fixtures" / fixture, command.folder / name)
    shutil.copytree(INPUTS / "files", command.folder, dirs_exist_ok=True)
    for line, in rows("made_files.tsv"):
        # A map unfit for cutting gives exit code 1 but is written.
        if (ended := command.run(plain(line.split()))).code > 1:
            raise SystemExit(f"cannot make a file: {line}\n{ended.err}")
