# SPDX-License-Identifier: GPL-3.0-or-later
"""The index that the site is searched by: which word stands in which section, and how often.

A section is a heading with what follows it up to the next heading. A word is a run of letters and digits; one
with hyphens or underscores in it (`hook-offset-mm`, `chain_sag`) counts whole and in its parts. The index is

    {"sections": [[id, title, title of the document, kind of the document], ...],
     "words": {word: [section, times, section, times, ...]}}

with sections counted from 0, in the order of the documents. tools/site/search.js reads it.
"""

import collections
import html
import re

HEADING = re.compile(r'<h[1-6] id="([^"]*)"[^>]*>(.*?)</h[1-6]>', re.S)
# Numbers say nothing about what a section is about, and tables are full of them.
WORD = re.compile(r"[^\W\d_][^\W_]*(?:[-_][^\W_]+)*")


def plain(marked_up):
    return html.unescape(re.sub(r"<[^>]+>", " ", marked_up))


def words_of(text):
    for word in WORD.findall(text.lower()):
        yield word
        parts = re.split(r"[-_]", word)
        if len(parts) > 1:
            yield from (part for part in parts if len(part) > 1)


def sections_of(page, title, kind, body):
    """[[id, title, title of the document, kind], text] for each heading of a document."""
    found = list(HEADING.finditer(body))
    for at, heading in enumerate(found):
        end = found[at + 1].start() if at + 1 < len(found) else len(body)
        # The first heading is the document's own: its section is the document.
        where = page if at == 0 else heading[1]
        yield [where, plain(heading[2]).strip(), title, kind], plain(body[heading.end() : end])


def search_index(pages):
    """pages: (id, title, kind, HTML) of each document."""
    sections, words = [], {}
    for page, title, kind, body in pages:
        for section, text in sections_of(page, title, kind, body):
            times = collections.Counter(words_of(text))
            for word in words_of(section[1]):
                times.setdefault(word, 1)
            for word, count in times.items():
                words.setdefault(word, []).extend((len(sections), count))
            sections.append(section)
    return {"sections": sections, "words": dict(sorted(words.items()))}
