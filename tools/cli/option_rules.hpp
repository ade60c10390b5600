// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which option acts on which kind of input: one table (option_rules.def) for all verbs. An option
/// that would do nothing with what a verb was given is refused by the sentence that the table has
/// for it, before any work; tests/inputs tries every cell.
///
/// \code
///   refuse_what_does_nothing(verb, facts::grid | facts::several);
/// \endcode
#pragma once

#include <cstdint>
#include <string_view>

#include "tools/cli/arguments.hpp"

namespace chaintrue::cli {

/// What a verb works on, as far as options depend on it; several hold at once.
using Facts = std::uint32_t;

namespace facts {
// Kinds of files.
inline constexpr Facts grid = 1U << 0;
inline constexpr Facts holes = 1U << 1;
inline constexpr Facts belts = 1U << 2;
inline constexpr Facts belt_holes = 1U << 3;  ///< on four belts, alone or with their lengths
inline constexpr Facts map = 1U << 4;
inline constexpr Facts anchors = 1U << 5;
inline constexpr Facts diagnosis = 1U << 6;
inline constexpr Facts machine = 1U << 7;
/// One grid and nothing with it.
inline constexpr Facts one_grid = 1U << 8;
/// fit: a smooth correction on the calibrated machine, or splines through the lengths.
inline constexpr Facts residual = 1U << 9;
inline constexpr Facts direct = 1U << 10;
/// --outside fade.
inline constexpr Facts fade = 1U << 11;
// plan and simulate: what is planned or made.
inline constexpr Facts lattice = 1U << 12;    ///< marks in columns and rows
inline constexpr Facts scattered = 1U << 13;  ///< marks anywhere
inline constexpr Facts marks = 1U << 14;      ///< marks of a list
inline constexpr Facts places = 1U << 15;     ///< true places of a list
inline constexpr Facts tape = 1U << 16;       ///< holes and a tape
inline constexpr Facts check = 1U << 17;      ///< points that check a map
inline constexpr Facts follow_up = 1U << 18;  ///< after a diagnosis
/// A program is written (--gcode).
inline constexpr Facts program = 1U << 21;
/// That drills, where it does not only stop above the marks.
inline constexpr Facts drilled = 1U << 22;
/// A program by itself, without --map.
inline constexpr Facts no_map = 1U << 23;
/// fit: without --plain.
inline constexpr Facts causes = 1U << 24;
/// A table (CSV) is among the files.
inline constexpr Facts table = 1U << 28;
/// fit and diagnose: a V-plotter's test drawing, alone.
inline constexpr Facts drawing = 1U << 29;
/// Everything that these take but that.
inline constexpr Facts no_drawing = grid | holes | belts | belt_holes;
/// In a map's place: a V-plotter whose drawing was measured.
inline constexpr Facts plotter = 1U << 30;
/// Of an option that other verbs have of the same file.
inline constexpr Facts nothing = 0;
inline constexpr Facts any = ~0U;

}  // namespace facts

struct OptionRule {
  std::string_view verb;  ///< "fit", "gcode check"
  std::string_view option;
  /// It acts where one of these holds; of what a verb is given at least one always does.
  Facts acts_on;
  /// What is expected instead where none does: "to be left out of holes: ...". Empty where it acts
  /// on everything.
  std::string_view otherwise;
  /// A value that says what happens in any case, and is not refused.
  std::string_view harmless = "";
};

/// Several of one option hold together.
inline constexpr OptionRule kOptionRules[] = {
#define CHAINTRUE_ACTS(verb, option) {verb, option, facts::any, ""},
#define CHAINTRUE_ACTS_ON(verb, option, on, otherwise) {verb, option, on, otherwise},
#define CHAINTRUE_ACTS_UNLESS(verb, option, on, otherwise, harmless) \
  {verb, option, on, otherwise, harmless},
#include "tools/cli/option_rules.def"
#undef CHAINTRUE_ACTS
#undef CHAINTRUE_ACTS_ON
#undef CHAINTRUE_ACTS_UNLESS
};

/// The first rule that refuses the option there; null where it acts.
[[nodiscard]] constexpr const OptionRule* refusal_of(std::string_view verb,
                                                     std::string_view option,
                                                     Facts facts) {
  for (const OptionRule& rule : kOptionRules) {
    if (rule.verb == verb && rule.option == option && (rule.acts_on & facts) == 0) return &rule;
  }
  return nullptr;
}

/// Of the options that were given to this verb. \throws files::InputError with a sentence for each
/// that would do nothing.
void refuse_what_does_nothing(Verb verb, Facts facts);

}  // namespace chaintrue::cli
