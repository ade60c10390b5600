# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists every sentence that the program can say, as it stands in the sources.

    sentences.py ROOT                  prints the list
    sentences.py ROOT --store FILE     writes it into FILE
    sentences.py ROOT --check FILE     compares it with FILE: exits with 1 and says what is new or gone
    sentences.py ROOT --words          prints those, and lines of charts, with a word that an owner has to look up: exits with 1
                                       if there are any

A sentence is a string with at least two words, adjacent parts joined; `{}` stands for what is put in.
"""

import pathlib
import re
import sys

# What is printed comes from here; generators and tests are not asked.
FOLDERS = ["model", "grid", "tools/cli", "tools/gcode", "tools/live", "tools/report"]
# Tables of docs/methods.md: no verb prints them.
OF_DOCUMENTS = {"constants.def"}
LITERAL = re.compile(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*')
COMMENT = re.compile(r'//[^\n]*|^\s*#\s*include[^\n]*', re.MULTILINE)
SPECIFICATION = re.compile(r"\{[^{}]*\}")
# Words of statistics, or of this project, in what an owner reads.
TO_LOOK_UP = re.compile(r"(?<![-_])\b(stated|beside|told|foretold|alike|settled|seen|unseen|held[ -]out|gone by|set aside|sets aside)\b(?![-_])",
                        re.IGNORECASE)


def without_comments(text):
    """A // within a string is none: strings are kept as they are."""
    parts = []
    last = 0
    for match in re.finditer(r'"(?:[^"\\\n]|\\.)*"|' + COMMENT.pattern, text, re.MULTILINE):
        if match.group(0).startswith('"'):
            continue
        parts.append(text[last:match.start()])
        last = match.end()
    parts.append(text[last:])
    return "".join(parts)


def sentences_of(path):
    for match in LITERAL.finditer(without_comments(path.read_text(encoding="utf-8"))):
        text = re.sub(r'"\s*"', "", match.group(0))[1:-1]
        for line in text.replace("\\n", "\n").replace('\\"', '"').split("\n"):
            line = SPECIFICATION.sub("{}", line).strip()
            words = re.findall(r"[A-Za-z]{2,}", SPECIFICATION.sub("", line))
            is_markup = line.startswith("<") or "</" in line or "{{" in line
            if len(words) >= 2 and " " in line and not is_markup:
                yield line


def all_sentences(root):
    lines = []
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.[chd][pe][pf]")):
            if path.name in OF_DOCUMENTS:
                continue
            seen = sorted(set(sentences_of(path)))
            lines += [f"{path.relative_to(root).as_posix()}: {line}" for line in seen]
    return lines


def chart_lines(root):
    """What a chart shows by itself: its description and the labels of its tips."""
    for path in sorted((root / "tools/report/charts").glob("*.json")):
        for line in path.read_text(encoding="utf-8").splitlines():
            if '"description"' in line or "tip_text" in line:
                yield f"{path.relative_to(root).as_posix()}: {line.strip()}"


def main(arguments):
    root = pathlib.Path(arguments[0])
    lines = all_sentences(root)
    if arguments[1:2] == ["--words"]:
        odd = [line for line in lines + list(chart_lines(root)) if TO_LOOK_UP.search(line.split(": ", 1)[1])]
        print("\n".join(odd) or "no word to look up")
        return 1 if odd else 0
    if arguments[1:2] == ["--store"]:
        pathlib.Path(arguments[2]).write_text("\n".join(lines) + "\n", encoding="utf-8")
        return 0
    if arguments[1:2] != ["--check"]:
        print("\n".join(lines))
        return 0
    stored = pathlib.Path(arguments[2]).read_text(encoding="utf-8").splitlines()
    new = [line for line in lines if line not in set(stored)]
    gone = [line for line in stored if line not in set(lines)]
    for title, some in [("new", new), ("gone", gone)]:
        for line in some:
            print(f"{title}: {line}")
    if new or gone:
        print("Read them aloud as an owner would; then store them: ninja -C build sentences", file=sys.stderr)
    return 1 if new or gone else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
