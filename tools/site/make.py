#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""All documents as one page that needs no server: contents, search, pictures inside.

Usage: make.py ROOT OUTPUT. The Markdown is that of the repository, nothing is written twice. A link
that leads nowhere is an error (exit 1, nothing written). Exits 77 where Debian's python3-markdown is
missing. Same documents, same bytes.
"""

import base64
import html
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

HERE = pathlib.Path(__file__).resolve().parent
# In the order of reading.
FIRST = ["README.md", "docs/start.md", "docs/holes.md", "docs/diagnosis.md", "docs/gcode.md", "docs/report.md"]
LAST = ["model/README.md", "interp/README.md", "fixtures/README.md", "CHANGELOG.md"]


def documents(root):
    between = sorted(p.relative_to(root).as_posix() for p in (root / "docs").rglob("*.md"))
    return FIRST + [p for p in between if p not in FIRST] + LAST


def page_id(path):
    return re.sub(r"[^a-z0-9]+", "-", path.lower().removesuffix(".md").removeprefix("docs/")).strip("-")


def slug(text, _separator="-"):
    return re.sub(r"\s+", "-", re.sub(r"[^\w\s-]", "", text.lower()).strip())


class Site:
    def __init__(self, root):
        self.root = root
        self.paths = documents(root)
        self.problems = []
        self.titles = {}
        self.bodies = {}
        for path in self.paths:
            text = (root / path).read_text(encoding="utf-8")
            converter = markdown.Markdown(
                extensions=["tables", "fenced_code", "toc", "sane_lists"],
                extension_configs={"toc": {"slugify": slug}},
            )
            body = converter.convert(text)
            found = re.search(r"<h1[^>]*>(.*?)</h1>", body, re.S)
            self.titles[path] = re.sub(r"<[^>]+>", "", found.group(1)) if found else path
            # Ids of one page must differ from those of another.
            self.bodies[path] = re.sub(
                r'(<h[1-6] )id="([^"]*)"', lambda m: f'{m[1]}id="{page_id(path)}--{m[2]}"', body
            )
        self.ids = set(re.findall(r' id="([^"]*)"', "".join(self.bodies.values())))
        self.ids.update(page_id(path) for path in self.paths)
        for path in self.paths:
            self.bodies[path] = re.sub(
                r'(href|src)="([^"]*)"', lambda m, p=path: self.link(p, m[1], html.unescape(m[2])), self.bodies[path]
            )

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
        lines = []
        for path in self.paths:
            lines.append(f'<li><a href="#{page_id(path)}">{self.titles[path]}</a></li>')
        return "\n".join(lines)

    def articles(self):
        return "\n".join(
            f'<article id="{page_id(path)}" data-title="{html.escape(html.unescape(self.titles[path]))}">\n'
            f"{self.bodies[path]}\n</article>"
            for path in self.paths
        )

    def page(self):
        page = (HERE / "page.html").read_text(encoding="utf-8")
        style = (HERE / "page.css").read_text(encoding="utf-8")
        script = (HERE / "page.js").read_text(encoding="utf-8")
        for name, text in (
            ("style", style), ("script", script), ("contents", self.contents()), ("articles", self.articles())
        ):
            page = page.replace(f"<!--{name}-->", text, 1)
        return page


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
