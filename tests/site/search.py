#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Asks the documents' site, in a browser, what a reader would ask, and looks at its first answers.

Usage: search.py ROOT BROWSER. Exits 77 where the site cannot be made (Debian: python3-markdown).
"""

import html
import json
import pathlib
import re
import subprocess
import sys
import tempfile

# A query, and a document that must be among its first three hits; none: nothing is found.
QUESTIONS = [
    ("worn chain", "diagnosis"),
    ("hook offset", "holes"),
    ("--hook-offset-mm", "holes"),
    ("map still valid", "check"),
    ("after.json", "start"),
    ("anchors Maslow 4", "maslow4"),
    ("chain_stretch", "effects"),
    ("prior probability", "methods"),
    ("outside_map", "gcode"),
    ("test square", "start"),
    ("how many points", "sweeps"),
    ("cite", "methods"),
    ("numpy", "python"),
    ("certificate", "report"),
    ("zzgrblx", None),
]
FIRST = 3

ASK = """
<script>
window.addEventListener("load", () => {
  const answers = QUESTIONS.map((question) => {
    const words = document.getElementById("words");
    words.value = question;
    words.dispatchEvent(new Event("input"));
    const hits = [...document.querySelectorAll("#hits a")];
    return {question, hits: hits.map((hit) => hit.hash.slice(1)), snippet: hits.length ? hits[0].nextSibling.textContent : ""};
  });
  // An address with words shows their hits; a hit that is chosen shows its section with the words marked.
  location.hash = "#search=hook+offset";
  setTimeout(() => {
    const typed = document.getElementById("words").value;
    document.querySelector("#hits a").click();
    setTimeout(() => {
      const marks = document.querySelectorAll("article.shown mark").length;
      document.body.innerHTML = "<pre id='answers'></pre>";
      document.getElementById("answers").textContent = JSON.stringify({answers, typed, marks});
    }, 100);
  }, 100);
});
</script>
"""


def answers_of(browser, page):
    """Runs the questions; the JSON that ASK leaves in the page."""
    dumped = subprocess.run(
        [browser, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom", page.as_uri()],
        capture_output=True, text=True, timeout=120, check=True,
    ).stdout
    found = re.search(r'<pre id="answers">(.*?)</pre>', dumped, re.S)
    if not found:
        sys.exit("the page left no answers")
    return json.loads(html.unescape(found.group(1)))


def problems_of(result):
    for asked, answer in zip(QUESTIONS, result["answers"]):
        question, wanted = asked
        first = [hit.split("--")[0] for hit in answer["hits"][:FIRST]]
        if wanted is None and first:
            yield f'"{question}" finds {first}, and should find nothing'
        if wanted is not None and wanted not in first:
            yield f'"{question}" finds {first}, and {wanted} is not among them'
        if wanted is not None and not answer["snippet"]:
            yield f'"{question}": the first hit shows no text'
    if result["typed"] != "hook offset":
        yield f'#search=hook+offset puts "{result["typed"]}" into the field'
    if result["marks"] == 0:
        yield "the words of a chosen hit are not marked"


def main():
    root, browser = pathlib.Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        page = pathlib.Path(folder) / "index.html"
        made = subprocess.run([sys.executable, root / "tools/site/make.py", root, page], check=False)
        if made.returncode != 0:
            sys.exit(made.returncode)
        text = page.read_text(encoding="utf-8")
        ask = ASK.replace("QUESTIONS", json.dumps([question for question, _ in QUESTIONS]))
        page.write_text(text.replace("</body>", ask + "</body>"), encoding="utf-8")
        problems = list(problems_of(answers_of(browser, page)))
    for problem in problems:
        print(problem)
    print(f"{len(QUESTIONS)} questions, {len(problems)} answered wrongly")
    sys.exit(1 if problems else 0)


main()
