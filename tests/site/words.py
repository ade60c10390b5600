#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages for the owner of a machine use a workshop's words: none of WORDS in their prose.

Usage: words.py ROOT. What the command prints (indented blocks) and code are not prose; the command's own
sentences have a test of their own. The pages are those of docs/index.md under "Tutorial" and, under "How to",
"At the machine", and what README.md and docs/index.md say.
"""

import pathlib
import re
import sys

# Where a plain word serves: for "stated" what the file says, for "beside" next to or off by, for "told" said.
WORDS = ["stated", "beside", "told", "foretold", "alike", "held out", "gone by", "likeness", "nominal", "residual", "compliance"]
FEWEST_PAGES = 8


def pages_of(root):
    index = (root / "docs/index.md").read_text(encoding="utf-8")
    owners = index[index.index("## Tutorial") : index.index("With a compiler:")]
    return ["README.md", "docs/index.md"] + [f"docs/{name}" for name in re.findall(r"\]\(([\w.]+\.md)\)", owners)]


def problems_of(page, text):
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        fenced ^= line.startswith("```")
        if fenced or line.startswith("    "):
            continue
        prose = re.sub(r"`[^`]*`|\]\([^)]*\)", " ", line).lower()
        for word in WORDS:
            if re.search(rf"\b{word}\b", prose):
                yield f'{page}, line {number}: "{word}"; say it in a workshop\'s words'


root = pathlib.Path(sys.argv[1])
pages = pages_of(root)
problems = [problem for page in pages for problem in problems_of(page, (root / page).read_text(encoding="utf-8"))]
if len(pages) < FEWEST_PAGES:
    problems.append(f"docs/index.md lists {len(pages)} pages for owners only: is it read as it is written?")
print("\n".join(problems) if problems else f"{len(pages)} pages")
sys.exit(1 if problems else 0)
