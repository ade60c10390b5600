# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns faults into edits of sources: each becomes a choice at run time, by CHAINTRUE_MUTANT."""
import subprocess

# A choice reads the environment once, so that faults in loops cost little.
PREAMBLE = """\
#ifndef CHAINTRUE_MUTANT_CHOICE
#define CHAINTRUE_MUTANT_CHOICE
#include <cstdlib>
#include <cstring>
inline bool chaintrue_chooses(const char* name, const char* number) {
  const char* const chosen = std::getenv("CHAINTRUE_MUTANT");
  return chosen != nullptr && (std::strcmp(chosen, name) == 0 || std::strcmp(chosen, number) == 0);
}
#define chaintrue_mutant(name, number)                     \\
  ([] {                                                    \\
    static const bool chosen = chaintrue_chooses(name, number); \\
    return chosen;                                         \\
  }())
#endif
"""


class Misfit(Exception):
    """A fault whose fragment is not in the sources, or more than once."""


def tracked(root):
    """Files that git tracks or would."""
    listed = subprocess.run(
        ["git", "-C", root, "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
        check=True, capture_output=True, text=True).stdout
    return [name for name in listed.split("\0") if name and (root / name).is_file()]


def sources_of(root):
    """Text of each source by its path."""
    return {name: (root / name).read_text(encoding="utf-8") for name in tracked(root)
            if name.startswith(("model/", "interp/", "grid/", "tools/"))
            and name.endswith((".cpp", ".hpp"))}


def places_of(fragment, text):
    """Where a fragment stands, whatever the line breaks: pairs of first and end."""
    at = [i for i, c in enumerate(text) if not c.isspace()]
    dense = "".join(text[i] for i in at)
    wanted = "".join(fragment.split())
    places = []
    found = dense.find(wanted)
    while found >= 0:
        places.append((at[found], at[found + len(wanted) - 1] + 1))
        found = dense.find(wanted, found + 1)
    return places


def locate(fault, sources):
    """Path and place of a fault: in its file, or, once that has moved, in the one file with it."""
    own = places_of(fault.original, sources.get(fault.file, ""))
    if len(own) == 1:
        return fault.file, own[0]
    if own:
        raise Misfit(f"{fault.name}: {len(own)} times in {fault.file}: {fault.original}")
    others = [(path, place) for path, text in sources.items()
              for place in places_of(fault.original, text)]
    if len(others) != 1:
        raise Misfit(f"{fault.name}: not in {fault.file}, {len(others)} times elsewhere: "
                     f"{fault.original}")
    return others[0]


def choice(fault, number):
    chosen = f'chaintrue_mutant("{fault.name}", "{number}")'
    if fault.original.endswith(";"):
        return f"if ({chosen}) {{ {fault.faulty} }} else {{ {fault.original} }}"
    return f"({chosen} ? ({fault.faulty}) : ({fault.original}))"


def edited(faults, sources):
    """Sources with all faults in them, by path, and the misfits."""
    edits = {}
    misfits = []
    for number, fault in enumerate(faults, 1):
        try:
            path, place = locate(fault, sources)
            edits.setdefault(path, []).append((place, choice(fault, number)))
        except Misfit as misfit:
            misfits.append(str(misfit))
    texts = {}
    for path, of_file in edits.items():
        text = sources[path]
        for (first, end), replacement in sorted(of_file, reverse=True):
            text = text[:first] + replacement + text[end:]
        texts[path] = PREAMBLE + text
    return texts, misfits
