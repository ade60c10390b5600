// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "grid/containers.hpp"
#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kDegreesOfRadian = 180.0 / std::numbers::pi;

std::string number_words(const ParameterEstimate& own, double factor) {
  constexpr int kMostDigits = 4;
  return own.sigma > 0.0 ? with_sigma(factor * own.value, factor * own.sigma, kMostDigits)
                         : fmt::format("{:.3g}", factor * own.value);
}

/// How a number with a variable's unit is written, and a slope over it.
struct VariableUnit {
  std::string_view unit;  ///< unit_of()
  double factor;
  std::string_view words;
  double slope_factor;
  std::string_view slope_words;
};
constexpr VariableUnit kVariableUnits[] = {
    {"mm", 1.0, "mm", 1000.0, "mm a metre"},
    {"rad", kDegreesOfRadian, "degrees", 1.0 / kDegreesOfRadian, "mm a degree"},
    {"n", 1.0, "N", 1.0, "mm a newton"},
    {"visit", 1.0, "visits", 1.0, "mm a visit"}};

/// Indexed by Enters.
constexpr std::string_view kEntrances[] = {"in the left chain",
                                           "in the right chain",
                                           "in both chains equally",
                                           "in both chains, with opposite signs",
                                           "which moves the tool along x",
                                           "which moves the tool along y",
                                           "",
                                           "which moves the tool in that direction",
                                           "which moves the tool outwards",
                                           "in the top left belt",
                                           "in the top right belt",
                                           "in the bottom left belt",
                                           "in the bottom right belt"};

/// Whether the law's place or period is this value, within two sigmas or `least`.
bool is_near(const Law& law, double value, double least) {
  const ParameterEstimate& own = law.parameters[1];
  return std::abs(own.value - value) < std::max(2.0 * own.sigma, least);
}

/// Whether its period may be a turn of something, if its variable is a chain's or belt's.
bool is_wave_of_length(const Law& law) { return is_periodic(law.shape) && unit_of(law.of) == "mm"; }

}  // namespace

std::string variable_in_words(const Law& law) {
  constexpr std::string_view kVariables[] = {
      "x{anchor}",
      "y{anchor}",
      "the distance{anchor} in the direction {direction:.0f} degrees from x towards y",
      "the distance from the border",
      "the left chain's length",
      "the right chain's length",
      "the left chain's angle below the horizontal",
      "the right chain's angle below the horizontal",
      "the tension in the left chain",
      "the tension in the right chain",
      "the number of the visit",
      "the top left belt's length",
      "the top right belt's length",
      "the bottom left belt's length",
      "the bottom right belt's length",
      "the top left belt's angle against the horizontal",
      "the top right belt's angle against the horizontal",
      "the bottom left belt's angle against the horizontal",
      "the bottom right belt's angle against the horizontal"};  // by Coordinate
  return fmt::format(fmt::runtime(kVariables[static_cast<std::size_t>(law.of)]),
                     fmt::arg("anchor", belt_of(law.enters) ? " from the bottom left anchor" : ""),
                     fmt::arg("direction", law.direction_deg));
}

std::string average_in_words(const Law& law, Observations of) {
  const std::string_view what = of == Observations::distances ? "changes a distance"
                                : of == Observations::belts   ? "changes that belt's length"
                                                              : "moves the tool";
  return fmt::format("{} by {:.2f} mm", what, law.rms_mm);
}

std::string form_in_words(const Law& law) {
  constexpr std::string_view kForms[] = {"a slope",
                                         "a bow",
                                         "a step",
                                         "a kink",
                                         "an exponential",
                                         "a wave",
                                         "a wave with its second harmonic"};
  return fmt::format("{} over {}", kForms[static_cast<std::size_t>(law.shape)],
                     variable_in_words(law));
}

std::string in_words(const Law& law) {
  constexpr std::string_view kSentences[] = {
      "{slope} {per} in proportion to {variable}, {entrance}",
      "a parabola over {variable} about {at} {unit}, {size} mm high half a bed away, {entrance}",
      "a step of {size} mm at {variable} = {at} {unit}, {entrance}",
      "{slope} {per} {side} {variable} = {at} {unit}, {entrance}",
      "{size} mm at {variable} = {end}, falling to a third within {at} {unit}, {entrance}",
      "a wave of {size} mm over {variable} with period {at} {unit}, {entrance}",
      "a wave of {size} mm over {variable} with period {at} {unit} and its second harmonic of "
      "{second} mm, {entrance}"};
  const VariableUnit& unit = *find_where(
      kVariableUnits, [&](const VariableUnit& one) { return one.unit == unit_of(law.of); });
  const auto words_of = [&](std::size_t k, double factor) {
    return k < law.parameters.size() ? number_words(law.parameters[k], factor) : "";
  };
  return fmt::format(fmt::runtime(kSentences[static_cast<std::size_t>(law.shape)]),
                     fmt::arg("size", words_of(0, 1.0)), fmt::arg("second", words_of(3, 1.0)),
                     fmt::arg("slope", words_of(0, unit.slope_factor / (law.to - law.from))),
                     fmt::arg("per", unit.slope_words), fmt::arg("at", words_of(1, unit.factor)),
                     fmt::arg("unit", unit.words),
                     fmt::arg("side", law.towards > 0 ? "beyond" : "below"),
                     fmt::arg("end", law.towards > 0 ? "largest" : "least"),
                     fmt::arg("variable", variable_in_words(law)),
                     fmt::arg("entrance", kEntrances[static_cast<std::size_t>(law.enters)]));
}

std::string given_law_words(const Diagnosis& d) {
  std::vector<std::string> named, gone;
  double sum = 0.0;
  for (const CauseGivenLaw& own : d.unexplained->causes_given_law) {
    std::string cause = sized(own.cause, own.parameters);
    for (const CauseId& same : own.same_as) cause += " or " + sized(same, {});
    if (own.parameters.empty()) {
      gone.push_back(fmt::format("{}: {} instead of {}", cause, percent(own.probability),
                                 percent(own.without_law)));
    } else {
      named.push_back(fmt::format("{}: {}", cause, percent(own.probability)));
      sum += own.probability;
    }
  }
  std::string text;
  // For causes that act together each is more likely than not; of an open set only one acts.
  if (!named.empty()) {
    text += fmt::format(" Given this law, they also name {}.",
                        fmt::join(named, sum > 1.0 ? ", and " : ", or "));
  }
  if (!gone.empty())
    text += fmt::format(" Named only without this law: {}.", fmt::join(gone, "; "));
  return text;
}

std::vector<std::string> hints_of(const Law& law, const model::BeltMachine& machine) {
  const double turn = machine.belt_turn_mm;
  // Tolerance of a belt's pitch: one per cent.
  if (!is_wave_of_length(law) || !belt_of(law.of) || !is_near(law, turn, 0.01 * turn)) return {};
  return {fmt::format(
      "Its period is near one turn of the motor ({:.3f} mm of belt): is its pulley or its magnet "
      "eccentric?",
      turn)};
}

std::vector<std::string> hints_of(const Law& law, const model::Machine& machine) {
  std::vector<std::string> hints;
  const double pitch = machine.sprocket.pitch_mm;
  const double turn = machine.sprocket.teeth * pitch;
  // Tolerance of a period: one per cent of a turn or a link.
  const struct {
    double period_mm, least_mm;
    std::string_view hint;
  } periods[] = {
      {turn, 0.01 * turn, "one turn of the sprocket ({:.1f} mm): is it eccentric?"},
      {0.5 * turn, 0.005 * turn, "half a turn of the sprocket ({:.1f} mm): is it out of round?"},
      {pitch, 0.01 * pitch,
       "one link and one tooth ({:.2f} mm): does the chain ride on the teeth?"}};
  if (is_wave_of_length(law) && chain_of(law.of)) {
    const auto* own = find_where(
        periods, [&](const auto& one) { return is_near(law, one.period_mm, one.least_mm); });
    if (own != nullptr) {
      hints.push_back("Its period is near " + fmt::format(fmt::runtime(own->hint), own->period_mm));
    }
  }
  constexpr double kNearMm = 30.0;  // a hand's breadth to either side is the same place
  if (law.of == Coordinate::x && (law.shape == LawShape::step || law.shape == LawShape::kink)) {
    if (is_near(law, 0.0, kNearMm))
      hints.emplace_back("Its place is near the middle of the beam: is something joined there?");
    for (const model::Side side : model::kSides) {
      if (is_near(law, machine.motors[side].x_mm, kNearMm))
        hints.push_back(fmt::format("Its place is near the {} motor.",
                                    side == model::Side::left ? "left" : "right"));
    }
  }
  if (unit_of(law.of) == "n")
    hints.emplace_back("It follows a chain's tension: something yields under load.");
  return hints;
}

}  // namespace chaintrue::grid::diagnosis
