# SPDX-License-Identifier: GPL-3.0-or-later
"""Random damage to a file's text: errors of disks, editors, spreadsheets and people, and malicious changes."""
import copy
import json
import math
import re

ODD_NUMBERS = """0 -0 -1 1 1e-6 1e-12 1e-300 1e-999 0.001 1e6 1e12 1e300 1e999 -1e9 NaN -Infinity 1,5 0x10 1e --1
    99999999999999999999 2147483648 -2147483649 0.1.2 +3 .5 5. 3000""".split()
WORDS = ["{", "}", "[", "]", '"', ",", ":", "null", "true", "\n", "\r\n", "\t", "\\", "\\u0000", "\xEF\xBB\xBF", "\xFF",
         "\xC3", "# ", "<script>alert(1)</script>", "'", ";", "()", '"comment": 1,', "%"]
ENTRIES = [0, -1, 1e9, "", [], {}, True, [1, 2, 3]]
FACTORS = [-1.0, 0.0, 0.01, 0.1, 0.5, 0.98, 0.9999, 1.0001, 1.02, 2.0, 10.0, 100.0]
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


class Damage:
    def __init__(self, random):
        self.random = random

    def odd_number(self, _=""):
        """A value that a user or a script may give to a numeric option."""
        return self.random.choice(ODD_NUMBERS)

    def near_number(self, number):
        factor = self.random.choice(FACTORS)
        other = float(number) + factor if self.random.random() < 1 / 3 else float(number) * factor
        return f"{other if math.isfinite(other) else 0.0:.8g}"

    def with_number(self, text, other):
        """With `other` of it for one of the numbers."""
        numbers = list(NUMBER.finditer(text))
        if not numbers:
            return text + other("0")
        chosen = self.random.choice(numbers)
        return text[:chosen.start()] + other(chosen[0]) + text[chosen.end():]

    def with_another_entry(self, text):
        """An entry of a JSON document is removed, doubled, exchanged or of another kind."""
        try:
            document = json.loads(text)
        except ValueError:
            document = None
        if not document or not isinstance(document, (dict, list)):
            return self.with_number(text, self.near_number)

        def any_key():
            return self.random.choice(list(parent) if isinstance(parent, dict) else range(len(parent)))

        parent = document
        while self.random.random() < 0.75:  # down to a random level
            child = parent[any_key()]
            if not child or not isinstance(child, (dict, list)):
                break
            parent = child
        key, other = any_key(), any_key()
        way = self.random.randrange(4)
        if way == 0:
            del parent[key]
        elif way == 1:
            parent[key], parent[other] = parent[other], parent[key]
        elif way == 2 and isinstance(parent, list):
            parent.append(copy.deepcopy(parent[key]))
        else:
            parent[key] = None if way == 2 else self.random.choice(ENTRIES)
        return json.dumps(document, indent=1, ensure_ascii=False)

    def slip(self, text):
        place = self.random.randrange(len(text) + 1)
        before, part, after = text[:place], text[place:place + self.random.randint(1, 40)], text[place:]
        rest = after[len(part):]
        ways = [lambda: before,
                lambda: before + chr(self.random.randrange(256)) + after[1:],
                lambda: before + rest,
                lambda: before + part + after,
                lambda: before + "\n" + after.split("\n")[0] * self.random.randrange(20) + after,
                lambda: before + self.random.choice(WORDS) + after,
                lambda: before + self.random.choice(WORDS) + rest]
        weights = [1] * len(ways) + [3]
        return self.random.choices(ways + [lambda: self.with_number(text, self.odd_number)], weights)[0]()

    def damaged(self, text):
        """With one to four errors of one sort."""
        way = self.random.choice([lambda text: self.with_number(text, self.near_number), self.with_another_entry,
                                  self.slip, self.slip])
        for _ in range(self.random.randint(1, 4)):
            text = way(text)
        return text
