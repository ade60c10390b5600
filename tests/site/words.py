#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that pages for owners and everything that the program prints avoid words that an owner has to look up.

Usage: words.py ROOT. The pages are README.md, docs/index.md and those that it lists under "Tutorial" and, under
"How to", "At the machine"; indented blocks and code are not prose. The program's sentences are the strings of at
least two words in FOLDERS, and the text of the charts.
"""

import pathlib
import re
import sys

# Plain words serve: for "stated" what the file says, for "beside" next to or off by, for "told" said.
IN_BOTH = ["stated", "beside", "told", "foretold", "alike", "held out", "gone by"]
IN_PAGES = IN_BOTH + ["likeness", "nominal", "residual", "compliance"]
IN_SENTENCES = IN_BOTH + ["held-out", "settled", "seen", "unseen", "set aside", "sets aside"]
FEWEST_PAGES = 8
FEWEST_SENTENCES = 3000

FOLDERS = ["model", "grid", "tools/cli", "tools/gcode", "tools/report"]
# Strings stand before comments, so that a // within a string starts none.
STRING_OR_COMMENT = re.compile(r'((?:"(?:[^"\\\n]|\\.)*"\s*)+)|//[^\n]*|^\s*#\s*include[^\n]*', re.MULTILINE)


def words_in(text, words):
    pattern = r"(?<![-_])\b(" + "|".join(words) + r")\b(?![-_])"
    return re.findall(pattern, text, re.IGNORECASE)


def prose_of(page):
    fenced = False
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        fenced ^= line.startswith("```")
        if not fenced and not line.startswith("    "):
            yield f"line {number}", re.sub(r"`[^`]*`|\]\([^)]*\)", " ", line)


def sentences_of(source):
    for match in STRING_OR_COMMENT.finditer(source.read_text(encoding="utf-8")):
        text = re.sub(r'"\s*"', "", match[1].strip())[1:-1] if match[1] else ""
        for line in text.replace('\\"', '"').split("\\n"):
            plain = re.sub(r"\{[^{}]*\}", "", line)
            is_markup = line.startswith("<") or "</" in line or "{{" in line
            if not is_markup and " " in line.strip() and len(re.findall(r"[A-Za-z]{2,}", plain)) >= 2:
                yield f'"{line}"', plain


def chart_lines_of(chart):
    for line in chart.read_text(encoding="utf-8").splitlines():
        if '"description"' in line or "tip_text" in line:
            yield line.strip(), line


def pages_for_owners(root):
    index = (root / "docs/index.md").read_text(encoding="utf-8")
    owners = index[index.index("## Tutorial") : index.index("With a compiler:")]
    return [root / "README.md", root / "docs/index.md"] + [root / "docs" / name for name in re.findall(r"\]\(([\w.]+\.md)\)", owners)]


def main(root):
    pages = pages_for_owners(root)
    sources = [path for folder in FOLDERS for path in sorted((root / folder).rglob("*.[chd][pe][pf]"))]
    looked_at = [(page, prose_of, IN_PAGES) for page in pages]
    looked_at += [(path, sentences_of, IN_SENTENCES) for path in sources]
    looked_at += [(path, chart_lines_of, IN_SENTENCES) for path in sorted((root / "tools/report/charts").glob("*.json"))]
    sentences = problems = 0
    for path, texts_of, words in looked_at:
        for place, text in texts_of(path):
            sentences += texts_of is sentences_of
            for word in words_in(text, words):
                problems += 1
                print(f'{path.relative_to(root)}, {place}: "{word}"; use a plain word')
    print(f"{len(pages)} pages, {sentences} sentences, {problems} words to look up")
    # Fewer mean that the pages or the sources are not found where this command looks for them.
    return 1 if problems or len(pages) < FEWEST_PAGES or sentences < FEWEST_SENTENCES else 0


sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
