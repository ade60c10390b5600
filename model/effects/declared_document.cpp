// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The chapter of docs/effects.md on effects that a user declares.
#include "model/effects/declared_law.hpp"

namespace chaintrue::model::effects {

std::string_view declared_chapter() {
  return R"chapter(## A cause of your own, in a file

A [chaintrue_effect](formats/effect.md) file declares another cause. `diagnose`, `fit`, `simulate` and `effects` read it with `--effects FILE...`. The cause is then compared like those above, and simulated grids, extended machines and maps contain it.

    chaintrue diagnose grid.json --effects fixtures/effects/second_harmonic.json -o diagnosis.json
    chaintrue fit grid.json --effects fixtures/effects/second_harmonic.json -o map.json

| acts on | formula | variables besides its parameters |
|---|---|---|
| `paper` | `adds_x_mm`, `adds_y_mm` | `x`, `y` of the mark, linearly |
| `chain` | `adds_mm` | `L0`, `S`, `phi`, `T`, `H`, `turn` (chain per turn of the sprocket), `pitch`; `x`, `y` of the tool and its distance `r` from the middle; `side`, 1 for the left chain and -1 for the right (a millimetre of the tool adds `side * cos(phi)` along x, `-sin(phi)` along y); or `d` alone, 1 if the chain was paid out and -1 if it was taken in |
| `chain` | `elongation` | none; counted length = true length / (1 + elongation) |
| `reading` | `adds_mm` | `n`, `pitch` |
| `visit` | `adds_mm` | `n`, `pitch`; added only at the visit given by its place |

A formula has `+ - * / ^`, brackets, `pi`, `sin cos exp log sqrt abs`, `min(a, b)`, `max(a, b)`, `step(a)` (1 from 0 on, else 0) and `ramp(a)` (a from 0 on, else 0). Units are checked: a parameter's name ends in its unit (`_mm`, `_n`, `_rad`, `_visit`, `_mm_per_n`; any other name is a plain number), a bare number takes the unit of what it is added to or compared with, `mm` and `N` are units, and the result must be millimetres. The formula must be finite over the bed and 0 at null.

The first parameter is the size; a second one with `"role": "place"` is where the effect sets in. A diagnosis tries 24 values of a place (a phase over a turn, other places over the values that occur or between the bounds), sums their probabilities, and refines the best.

*Not possible in a file:* effects on the equilibrium (station machine), a second size, bent paper, play that depends on place, effects of four belts. With `"instead_of"` a file replaces an effect of the catalogue; `fixtures/effects/catalogue` has the eleven of paper, chain and reading, with the same verdicts and sizes. Readings of links or of a tape always use the catalogue's chain_pitch_error and tape_scale.

Three examples, in `fixtures/effects`:

| file | acts on | formula | size, place |
|---|---|---|---|
| `second_harmonic.json`: a sprocket that is not round | chain, left or right | `amplitude_mm * sin(4 * pi * L0 / turn + phase_rad)` | 0.2 mm; any phase |
| `creep_that_saturates.json`: the machine warms up and stays warm | reading, left, right or both | `rise_mm * (1 - exp(-n / settled_after_visits))` | 0.4 mm; 12 visits |
| `chain_rubs.json`: a chain touches the frame below an angle | chain, left or right | `give_mm_per_n * T * ramp(phi - touches_rad)` | 0.01 mm/N; 0.7 rad |
)chapter";
}

}  // namespace chaintrue::model::effects
