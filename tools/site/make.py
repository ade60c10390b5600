#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""All documents as one page that needs no server: contents, search, pictures inside.

Usage: make.py ROOT OUTPUT. The Markdown is that of the repository, nothing is written twice; the order and the
kinds of documents are those of docs/index.md. A link that leads nowhere, and a document that docs/index.md does
not list, are errors (exit 1, nothing written). Exits 77 where Debian's python3-markdown is missing. Same
documents, same bytes.
"""

import base64
import html
import json
import mimetypes
import os
import pathlib
import re
import sys

try:
    import markdown
except ImportError:
    print("python3-markdown is not installed: apt-get install python3-markdown", file=sys.stderr)
    sys.exit(77)

sys.dont_write_bytecode = True
from search_index import search_index  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
INDEX = "docs/index.md"
# Read first, and listed in no group.
FIRST = ["README.md", INDEX]


def page_id(path):
    return re.sub(r"[^a-z0-9]+", "-", path.lower().removesuffix(".md").removeprefix("docs/")).strip("-")


def slug(text, _separator="-"):
    return re.sub(r"\s+", "-", re.sub(r"[^\w\s-]", "", text.lower()).strip())


def groups_of(root):
    """Of docs/index.md: [kind, [(path, text of its link)]] in their order."""
    groups = []
    for line in (root / INDEX).read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            groups.append((line[3:].strip(), []))
        for text, target in re.findall(r"\[([^\]]*)\]\(([^)#]*\.md)\)", line):
            path = os.path.relpath((root / INDEX).parent / target, root)
            words = f"File: {text}" if path.startswith("docs/formats/") else text
            groups[-1][1].append((pathlib.PurePath(path).as_posix(), words))
    return groups


class Site:
    def __init__(self, root):
        self.root = root
        self.groups = groups_of(root)
        self.paths = FIRST + [path for _, pages in self.groups for path, _ in pages]
        self.problems = self.unlisted()
        self.titles = {}
        self.bodies = {}
        if self.problems:
            return
        for path in self.paths:
            self.convert(path)
        self.ids = set(re.findall(r' id="([^"]*)"', "".join(self.bodies.values())))
        self.ids.update(page_id(path) for path in self.paths)
        for path in self.paths:
            self.bodies[path] = self.titled(path)
            self.bodies[path] = re.sub(
                r'(href|src)="([^"]*)"', lambda m, p=path: self.link(p, m[1], html.unescape(m[2])), self.bodies[path]
            )

    def unlisted(self):
        problems = [f"{INDEX}: {path} stands there twice" for path in set(self.paths) if self.paths.count(path) > 1]
        there = {p.relative_to(self.root).as_posix() for p in (self.root / "docs").rglob("*.md")}
        problems += [f"{INDEX} does not list {path}" for path in sorted(there - set(self.paths))]
        problems += [f"{INDEX}: there is no {path}" for path in self.paths if not (self.root / path).exists()]
        return sorted(problems)

    def convert(self, path):
        converter = markdown.Markdown(
            extensions=["tables", "fenced_code", "toc", "sane_lists"], extension_configs={"toc": {"slugify": slug}}
        )
        body = converter.convert((self.root / path).read_text(encoding="utf-8"))
        found = re.search(r"<h1[^>]*>(.*?)</h1>", body, re.S)
        self.titles[path] = html.unescape(re.sub(r"<[^>]+>", "", found[1])) if found else path
        # Ids of one page must differ from those of another.
        self.bodies[path] = re.sub(
            r'(<h[1-6] )id="([^"]*)"', lambda m: f'{m[1]}id="{page_id(path)}--{m[2]}"', body
        )

    def titled(self, path):
        """A link that is called by its file's name, as it must be in a folder, is called by its document's title."""

        def title(found):
            relative = os.path.relpath(self.root / pathlib.PurePath(path).parent / found[2], self.root)
            return found[1] + html.escape(self.titles.get(relative, found[4])) + "</a>"

        return re.sub(r'(<a href="([^"#]*)(#[^"]*)?">)([\w/.]+\.md)</a>', title, self.bodies[path])

    def link(self, path, kind, target):
        if re.match(r"[a-z]+:", target):
            return f'{kind}="{html.escape(target)}"'
        name, _, anchor = target.partition("#")
        file = (self.root / path).parent / name if name else self.root / path
        relative = os.path.relpath(file.resolve(), self.root.resolve())
        if kind == "src":
            return f'src="{self.picture(path, file)}"'
        if relative in self.paths:
            goal = page_id(relative) + (f"--{anchor}" if anchor else "")
            if goal not in self.ids:
                self.problems.append(f"{path}: {target} has no such heading")
            return f'href="#{goal}"'
        if not file.exists():
            self.problems.append(f"{path}: {target} leads nowhere")
            return ""
        if file.suffix == ".json":
            return f'download="{file.name}" href="{self.data_of(file)}"'
        # Other files exist in the repository only.
        return f'title="{html.escape(relative)}, in the repository"'

    def picture(self, path, file):
        if not file.exists():
            self.problems.append(f"{path}: the picture {file.name} is missing")
            return ""
        return self.data_of(file)

    @staticmethod
    def data_of(file):
        kind = mimetypes.guess_type(file.name)[0] or "application/octet-stream"
        return f"data:{kind};base64," + base64.b64encode(file.read_bytes()).decode()

    def contents(self):
        def line(path, words):
            return f'<li><a href="#{page_id(path)}">{html.escape(words)}</a></li>'

        blocks = ["<ul>", *(line(path, self.titles[path]) for path in FIRST), "</ul>"]
        for kind, pages in self.groups:
            blocks += [f"<h2>{html.escape(kind)}</h2>", "<ul>", *(line(*page) for page in pages), "</ul>"]
        return "\n".join(blocks)

    def articles(self):
        return "\n".join(
            f'<article id="{page_id(path)}" data-title="{html.escape(self.titles[path])}">\n'
            f"{self.bodies[path]}\n</article>"
            for path in self.paths
        )

    def index(self):
        kinds = {path: kind for kind, pages in self.groups for path, _ in pages}
        pages = [(page_id(p), self.titles[p], kinds.get(p, ""), self.bodies[p]) for p in self.paths]
        # "</" would end the script that the index stands in.
        return json.dumps(search_index(pages), ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")

    def page(self):
        page = (HERE / "page.html").read_text(encoding="utf-8")
        parts = {"contents": self.contents(), "articles": self.articles(), "index": self.index()}
        for name, file in (("style", "page.css"), ("search", "search.js"), ("script", "page.js")):
            parts[name] = (HERE / file).read_text(encoding="utf-8")
        return re.sub(r"<!--(\w+)-->", lambda m: parts[m[1]], page)


def main():
    root, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    site = Site(root)
    for problem in site.problems:
        print(problem, file=sys.stderr)
    if site.problems:
        sys.exit(1)
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(site.page(), encoding="utf-8")
    print(f"{output}: {len(site.paths)} documents; open it in any browser")


main()
