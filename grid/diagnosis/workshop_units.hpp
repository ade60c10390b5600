// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers in workshop units and words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::grid::diagnosis {

/// "zero_left_mm" is {"zero left", "mm"}, "scale_left_mm_per_m" {"scale left", "mm per m"}.
struct NameAndUnit {
  std::string name;
  std::string unit;
};
NameAndUnit parameter_words(std::string_view parameter);

/// Rounded to the sigma's first two digits, at most so many behind the point; a value without a sigma to its own
/// first two digits.
std::string with_sigma(double value, double sigma, int most_digits = 6);

/// "0.120 +- 0.010 %", "1 link", "sets in at 52.0 degrees": from the parameter's name and the effect, which
/// may elongate links or a belt.
std::string in_workshop_units(const CauseId& cause, const ParameterEstimate& estimate);

/// All its parameters, separated by commas.
std::string sizes_in_words(const CauseId& cause, const std::vector<ParameterEstimate>& parameters);
/// A cause with its side, and its sizes, if any, in brackets.
std::string sized(const CauseId& cause, const std::vector<ParameterEstimate>& parameters);
/// "1.2 mm too short"
std::string off_in_words(double residual_mm);

/// "the angle of the left chain" for angle_left.
std::string coordinate_words(std::string_view coordinate);

/// " on the left", " along x": after a cause; empty if it has no side.
std::string side_words(const CauseId& cause);

/// What to do about these causes, in their order. Causes on several sides with the same remedy
/// share a line that lists the sides.
std::vector<std::string> remedies(const std::vector<Cause>& causes);

/// "87 %", "99.6 %", "above 99.9 %": a probability, the same in sentences and in tables.
std::string percent(double probability);

/// "a; b and c": `last` comes before the last one.
std::string joined(const std::vector<std::string>& parts, std::string_view last,
                   std::string_view between = "; ");

/// "the distance between the motors' axes, with a tape" for motor_spacing_mm.
std::string reading_words(ReadingOf what, std::string_view side);

}  // namespace chaintrue::grid::diagnosis
