# SPDX-License-Identifier: GPL-3.0-or-later
"""The attacks on the command, drawn one after the other from a seed, and their counts."""
import json
import random
import shutil
import signal
from collections import defaultdict
from dataclasses import dataclass, field

from command import no_number_in, text_of
from damage import Damage
from targets import is_output, make_files, output_of, targets

MISUSED, REFUSED = 2, 3
HASHED = {"map.json", "anchors.json"}
NO_FILES = ["", "..", "nowhere/x", "-", "x" * 300]  # no file is there, or none can be made
SCRIPTS = ["</script><script>alert(1)</script>", '\\"><img src=x onerror=alert(1)>', "<!--", "]]></style>",
           "\\u003cscript\\u003ealert(1)", "${alert(1)}"]
SWEEP = "sweep sweep.json -o out".split()


@dataclass
class Attack:
    kind: str
    words: list
    inputs: list = field(default_factory=list)
    outputs: list = field(default_factory=list)  # may exist afterwards
    must_be_refused: bool = False


@dataclass
class Tally:
    runs: int = 0
    answered: int = 0  # exit codes 0 and 1
    refused: int = 0   # 2, 3 and 4
    stopped: int = 0   # by a signal from here
    failures: int = 0
    slowest_s: float = 0.0

    def add(self, ended):
        self.runs += 1
        self.answered += ended.code in (0, 1)
        self.refused += ended.code >= 2
        self.stopped += ended.code < 0
        self.slowest_s = max(self.slowest_s, ended.seconds)


def without_comments(text):
    """What a JSON text says; None if it is not JSON."""
    try:
        return json.loads(text, object_pairs_hook=lambda pairs: {key: value for key, value in pairs if key != "comment"})
    except ValueError:
        return None


class Campaign:
    def __init__(self, command, failures, seed):
        self.command, self.failures, self.seed = command, failures, seed
        self.random = random.Random(seed)
        self.damage = Damage(self.random)
        self.number = 0
        self.tallies = defaultdict(Tally)
        make_files(command)
        self.targets = targets(lambda verb: command.run(verb.split() + ["--help"]).out)
        if command.run("sweep sweep.json -o whole".split()).code != 0:
            raise SystemExit("the sweep could not be prepared")
        self.sweep_results = text_of(command.folder / "whole/results.csv")
        shutil.rmtree(command.folder / "whole")
        self.permanent = {path.name: text_of(path) for path in command.folder.iterdir()}

    def write(self, name, text):
        (self.command.folder / name).write_bytes(text.encode("latin-1"))

    def strays(self):
        """All files in the folder but the permanent ones."""
        return [path for path in self.command.folder.iterdir() if path.name not in self.permanent]

    def clean(self):
        for path in self.strays():
            shutil.rmtree(path) if path.is_dir() else path.unlink()

    def run(self, attack, **stop):
        ended = self.command.run(attack.words, **stop)
        self.tallies[attack.kind].add(ended)
        return ended

    def judge(self, attack, ended, fault):
        """Counts a fault, keeps what it came from, and cleans up."""
        if fault:
            self.tallies[attack.kind].failures += 1
            kept = self.failures / f"seed{self.seed}_{self.number}"
            kept.mkdir(parents=True, exist_ok=True)
            for path in self.strays():
                shutil.copytree(path, kept / path.name) if path.is_dir() else shutil.copy(path, kept)
            line = "chaintrue" + "".join(f" '{word}'" for word in attack.words)
            (kept / "command.txt").write_bytes(f"{line}\n{fault}\n{ended.err}".encode("latin-1"))
            print(f"FAILED seed {self.seed} attack {self.number} ({attack.kind}): {fault}\n  {line!a}", flush=True)
        self.clean()

    def fault_of(self, attack, ended):
        if fault := ended.fault():
            return fault
        for name, text in self.permanent.items():
            if text_of(self.command.folder / name) != text:
                return f"an input was changed: {name}"
        for path in self.strays():
            if path.name not in attack.inputs + attack.outputs:
                return f"left behind: {path.name}"
            if path.name not in attack.outputs or not path.is_file():
                continue
            if ended.code == REFUSED:
                return f"refused, and yet written: {path.name}"
            if number := no_number_in(text_of(path)):
                return f"a number that is none in the output: {number}"
        if attack.must_be_refused and ended.code not in (REFUSED, MISUSED):
            return f"taken, exit code {ended.code}"
        return ""

    def judged(self, attack):
        ended = self.run(attack)
        self.judge(attack, ended, self.fault_of(attack, ended))

    def reading(self, kind, reader, text, must_be_refused=False):
        file, _, words = reader
        self.write(f"in_{file}", text)
        out = output_of(words)
        line = [out if word == "OUT" else word.replace("IN", f"in_{file}", 1) if word.startswith("IN") else word
                for word in words]
        self.judged(Attack(f"{kind} {file}", line, [f"in_{file}"], [out], must_be_refused))

    def damaged_input(self):
        readers = self.targets.readers
        reader = self.random.choices(readers, [weight for _, weight, _ in readers])[0]
        self.reading("damaged", reader, self.damage.damaged(self.permanent[reader[0]]))

    def tampered_file(self):
        reader = self.random.choice([reader for reader in self.targets.readers if reader[0] in HASHED])
        original = self.permanent[reader[0]]
        other = self.random.choice([self.damage.odd_number, self.damage.near_number])
        text = self.damage.with_number(original, other)
        # Another text may be the same number (0 for -0), and a comment may be anything.
        is_same = without_comments(text) == without_comments(original)
        self.reading("tampered", reader, text, must_be_refused=not is_same)

    def any_text(self, option):
        choose = self.random.choice
        good = option.values or [""]
        return self.random.choices([lambda: choose(good), lambda: self.damage.damaged(choose(good)),
                                    lambda: choose(list(self.permanent)), self.damage.odd_number,
                                    lambda: choose(NO_FILES)], [4, 2, 2, 1, 1])[0]()

    def any_output(self, words):
        read = [word for word in words if word in self.permanent]
        return self.random.choice([self.random.choice(NO_FILES), self.random.choice(read or ["out"]), "out", "out2.html"])

    def add(self, option, words):
        """Sets an option to an unusual value, in its place or at the end."""
        def value():
            if is_output(option.name):
                return self.any_output(words)
            return self.any_text(option) if option.type == "TEXT" else self.damage.odd_number()

        stands = next((i for i, word in enumerate(words) if word in option.names), None)
        if not option.type:
            words += [option.name] if stands is None else []
        elif stands is not None and stands + 1 < len(words):
            words[stands + 1] = value()
        elif option.count == 1:
            words.append(f"{option.name}={value()}")
        else:
            words += [option.name] + [value() for _ in range(option.count)]

    def odd_options(self):
        verb = self.random.choice(list(self.targets.options))
        call = self.random.choice(self.targets.calls[verb])
        words = [output_of(call) if word == "OUT" else word for word in call]
        for i, word in enumerate(words):
            # A number by itself, or the line of a program.
            head, colon, number = word.rpartition(":")
            if number.isdigit() and self.random.random() < 0.5:
                words[i] = head + colon + self.damage.odd_number()
        if options := self.targets.options[verb]:
            for _ in range(self.random.randint(1, 3)):
                self.add(self.random.choice(options), words)
        self.judged(Attack(f"odd options, {verb}", words, [], ["out", "out.html", "out2.html", "nowhere"]))

    def soon(self, least_s, most_s):
        return least_s * (most_s / least_s) ** self.random.random()

    def resume(self, kind, what, may_be_refused):
        """Resumes a sweep after `what`, which must give the results of one without."""
        attack = Attack(kind, SWEEP + ["--resume"])
        ended = self.run(attack)
        fault = ended.fault()
        if ended.code != 0 and not may_be_refused:
            fault = fault or "could not be resumed"
        if ended.code == 0 and text_of(self.command.folder / "out/results.csv") != self.sweep_results:
            fault = fault or f"other results than without the {what}"
        self.judge(attack, ended, fault)

    def resume_a_damaged_sweep(self):
        kind = "damaged sweep, resumed"
        self.run(Attack(kind, SWEEP + ["--shard", "1/2"]))
        part = self.random.choice(sorted(path for path in (self.command.folder / "out").rglob("*") if path.is_file()))
        part.write_bytes(self.damage.damaged(text_of(part)).encode("latin-1"))
        self.resume(kind, "damage", may_be_refused=True)

    def kill_a_sweep(self):
        kind = "killed sweep"
        for _ in range(2):
            self.run(Attack(kind, SWEEP + ["--resume"]), signal=signal.SIGKILL, after_s=self.soon(0.01, 1.5))
        self.resume(kind, "kills", may_be_refused=False)

    def kill_while_writing(self):
        attack = Attack("stopped while writing", "gcode lengths in_long.nc --map map.json -o out".split())
        own = self.random.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGPIPE])
        self.write("in_long.nc", "G21 G90\nG0 X0 Y0\n" + "".join(f"G1 X{i % 700} Y{i % 300} F500\n" for i in range(3000)))
        old = "line,kind,x_mm,y_mm,z_mm,left_mm,right_mm,\n"
        self.write("out", old)
        ended = self.run(attack, signal=own, after_s=self.soon(0.001, 0.3))
        now = text_of(self.command.folder / "out")
        fault = ""
        if ended.code < 0 and now != old and len(now) < 100_000:
            fault = "half a file"
        # A process that was killed cannot remove its files.
        elif own != signal.SIGKILL and len(self.strays()) != 2:
            fault = "left behind"
        self.judge(attack, ended, fault)

    def script_in_a_page(self):
        head, key, tail = self.permanent["grid.json"].partition('"name": "')
        self.write("in_grid.json", head + key + self.random.choice(SCRIPTS) + tail[tail.index('"'):])
        attack = Attack("script in a page", "fit in_grid.json -o in_map.json".split())
        self.run(attack)
        made = self.command.folder / "in_map.json"
        odd = "in_<b>\xFF\xC3.json"  # no UTF-8, and a tag
        if made.exists():
            made.rename(self.command.folder / odd.encode("latin-1").decode("utf-8", "surrogateescape"))
        attack.words = ["report", odd, "-o", "out.html"]
        ended = self.run(attack)
        page = text_of(self.command.folder / "out.html")
        fault = ""
        if ended.code != 0:
            fault = "no page"
        elif any(part in page for part in ("<script>alert", "<img src=x", "<b>\xFF")):
            fault = "a name that became part of the page"
        elif "\xFF" in page:
            fault = "a page that is no UTF-8"
        self.judge(attack, ended, fault)

    def attack(self):
        self.number += 1
        kinds = {self.damaged_input: 56, self.tampered_file: 10, self.odd_options: 25, self.kill_while_writing: 5,
                 self.kill_a_sweep: 1, self.resume_a_damaged_sweep: 1, self.script_in_a_page: 2}
        self.random.choices(list(kinds), kinds.values())[0]()
