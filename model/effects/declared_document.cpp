// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The chapter of docs/effects.md on effects that a user declares.
#include "model/effects/declared_law.hpp"

namespace chaintrue::model::effects {

std::string_view declared_chapter() {
  return R"chapter(## A cause of your own, in a file

Other causes are declared in a [chaintrue_effect](formats/effect.md) file: what the cause acts on, its usual size, a formula and its texts. `--effects FILE...` gives such files to `diagnose`, `fit`, `simulate` and `effects`. The cause is then weighed like those above, and stays with the machine: simulated grids, extended machines and maps contain it.

    chaintrue diagnose grid.json --effects fixtures/effects/second_harmonic.json -o diagnosis.json
    chaintrue fit grid.json --effects fixtures/effects/second_harmonic.json -o map.json

| acts on | formula | what it may use besides its parameters |
|---|---|---|
| `paper` | `adds_x_mm`, `adds_y_mm` | `x`, `y` of the mark, in proportion to them |
| `chain` | `adds_mm` | `L0`, `S`, `phi`, `T`, `H`, `turn` (chain of one turn of the sprocket), `pitch`; `x`, `y` of the tool and `r`, its distance from the middle; `side`, 1 of the left chain and -1 of the right, so that `side * cos(phi)` is what a millimetre of the tool along x adds, `-sin(phi)` along y; or `d` alone, 1 where the chain was paid out and -1 where it was taken in |
| `chain` | `elongation` | nothing: counted length = true length / (1 + elongation) |
| `reading` | `adds_mm` | `n`, `pitch` |
| `visit` | `adds_mm` | `n`, `pitch`; added at the visit that its place names and at no other |

A formula has `+ - * / ^`, brackets, `pi`, `sin cos exp log sqrt abs`, `min(a, b)`, `max(a, b)`, `step(a)` (1 from 0 on, else 0) and `ramp(a)` (a from 0 on, else 0). Its derivatives are exact. Units are checked: the name of a parameter ends in its unit (`_mm`, `_n`, `_rad`, `_visit`, `_mm_per_n`; any other end is a plain number), a bare number takes the unit of what it is added to or compared with, `mm` and `N` make a quantity of a number, and millimetres must come out. Over the bed of the machine the formula must be finite between the bounds, and 0 at null.

The first parameter is the size; a second one with `"role": "place"` says where the effect sets in. A diagnosis tries a place at 24 values and adds up their probabilities: a phase over a turn, a place in the unit of the one variable that the formula uses between the values that occur, any other evenly between its bounds; then it refines the best.

*Not possible as a file:* what changes the equilibrium (the six effects of the station machine), a second size, paper that is bent, play that changes from place to place, effects of four belts. With `"instead_of"` a file takes the place of an effect of the catalogue; the eleven of paper, chain and reading stand so in `fixtures/effects/catalogue` and give the same verdicts and sizes to a millionth. A reading of links or of a tape refers only to the catalogue's chain_pitch_error and tape_scale.

Three examples, in `fixtures/effects`:

| file | acts on | formula | size, place |
|---|---|---|---|
| `second_harmonic.json`: a sprocket that is not round | chain, left or right | `amplitude_mm * sin(4 * pi * L0 / turn + phase_rad)` | 0.2 mm; any phase |
| `creep_that_saturates.json`: the machine warms up and stays warm | reading, left, right or both | `rise_mm * (1 - exp(-n / settled_after_visits))` | 0.4 mm; 12 visits |
| `chain_rubs.json`: a chain lies on the frame below an angle | chain, left or right | `give_mm_per_n * T * ramp(phi - touches_rad)` | 0.01 mm/N; 0.7 rad |

The first one whole:

```json
{
  "file_type": "chaintrue_effect",
  "format_version": "1.0",
  "id": "second_harmonic",
  "acts_on": "chain",
  "sides": ["left", "right"],
  "parameters": [
    {"name": "amplitude_mm", "nominal": 0.2, "prior_sigma": 0.2, "lower": 0, "upper": 5, "meaning": "half of the wave's height"},
    {"name": "phase_rad", "role": "place", "nominal": 0, "prior_sigma": 3.14, "lower": -6.3, "upper": 6.3, "meaning": "where in its half turn the sprocket stands at length 0"}
  ],
  "adds_mm": "amplitude_mm * sin(4 * pi * L0 / turn + phase_rad)",
  "cause": "a sprocket is not round: it was squeezed, or its bore is oval",
  "signature": "a wave along one chain that repeats twice with every turn of its sprocket (31.75 mm)",
  "remedy_kind": "compensate on its own",
  "remedy": "change the sprocket",
  "not_modelled": "its third harmonic",
  "typical": "0.2 mm",
  "source": "run-out of a wheel on its axis, second harmonic"
}
```
)chapter";
}

}  // namespace chaintrue::model::effects
