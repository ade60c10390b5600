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

/// Two digits of the sigma.
std::string number_words(double value, double sigma) {
  if (!(sigma > 0.0)) return fmt::format("{:.3g}", value);
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, 4);
  return fmt::format("{:.{}f} +- {:.{}f}", value, digits, sigma, digits);
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

const VariableUnit& unit_of_variable(const Law& law) {
  return *find_where(kVariableUnits,
                     [&](const VariableUnit& one) { return one.unit == unit_of(law.of); });
}

/// A place, scale or period with its unit.
std::string quantity_words(const Law& law, const ParameterEstimate& estimate) {
  const VariableUnit& unit = unit_of_variable(law);
  return fmt::format("{} {}",
                     number_words(unit.factor * estimate.value, unit.factor * estimate.sigma),
                     unit.words);
}

std::string entrance_words(Enters enters) {
  if (const auto belt = belt_of(enters)) return fmt::format("in the {} belt", model::words(*belt));
  constexpr std::string_view kWords[] = {"in the left chain",
                                         "in the right chain",
                                         "in both chains equally",
                                         "in both chains, with opposite signs",
                                         "which moves the tool along x",
                                         "which moves the tool along y",
                                         "",
                                         "which moves the tool in that direction",
                                         "which moves the tool outwards"};
  return std::string(kWords[static_cast<std::size_t>(enters)]);
}

/// A slope over the whole range, converted to its natural unit.
std::string slope_words(const Law& law, const ParameterEstimate& size) {
  const VariableUnit& unit = unit_of_variable(law);
  const double per = unit.slope_factor / (law.to - law.from);
  return fmt::format("{} {}", number_words(size.value * per, size.sigma * per), unit.slope_words);
}

/// Whether the law's place or period is this value, within two sigmas or `least`.
bool is_near(const Law& law, double value, double least) {
  const ParameterEstimate& own = law.parameters[1];
  return std::abs(own.value - value) < std::max(2.0 * own.sigma, least);
}

}  // namespace

std::string variable_in_words(const Law& law) {
  const bool of_belts = belt_of(law.enters).has_value();
  switch (law.of) {
    case Coordinate::x:
      return of_belts ? "x from the bottom left anchor" : "x";
    case Coordinate::y:
      return of_belts ? "y from the bottom left anchor" : "y";
    case Coordinate::across:
      return fmt::format("the distance{} in the direction {:.0f} degrees from x towards y",
                         of_belts ? " from the bottom left anchor" : "", law.direction_deg);
    case Coordinate::border:
      return "the distance from the border";
    case Coordinate::visit:
      return "the number of the visit";
    default:
      break;
  }
  const auto belt = belt_of(law.of);
  const std::string owner =
      belt ? fmt::format("the {} belt", model::words(*belt))
           : fmt::format("the {} chain", chain_of(law.of) == model::Side::left ? "left" : "right");
  const std::string_view unit = unit_of(law.of);
  if (unit == "n") return "the tension in " + owner;
  if (unit == "mm") return owner + "'s length";
  return owner + (belt ? "'s angle against the horizontal" : "'s angle below the horizontal");
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
      "{slope} in proportion to {variable}, {entrance}",
      "a parabola over {variable} about {at}, {size} mm high half a bed away, {entrance}",
      "a step of {size} mm at {variable} = {at}, {entrance}",
      "{slope} {side} {variable} = {at}, {entrance}",
      "{size} mm at {variable} = {end}, falling to a third within {at}, {entrance}",
      "a wave of {size} mm over {variable} with period {at}, {entrance}",
      "a wave of {size} mm over {variable} with period {at} and its second harmonic of {second} "
      "mm, "
      "{entrance}"};
  const std::vector<ParameterEstimate>& own = law.parameters;
  const auto size_words = [&](std::size_t k) {
    return k < own.size() ? number_words(own[k].value, own[k].sigma) : "";
  };
  return fmt::format(fmt::runtime(kSentences[static_cast<std::size_t>(law.shape)]),
                     fmt::arg("size", size_words(0)), fmt::arg("second", size_words(3)),
                     fmt::arg("slope", slope_words(law, own.front())),
                     fmt::arg("at", own.size() > 1 ? quantity_words(law, own[1]) : ""),
                     fmt::arg("side", law.towards > 0 ? "beyond" : "below"),
                     fmt::arg("end", law.towards > 0 ? "largest" : "least"),
                     fmt::arg("variable", variable_in_words(law)),
                     fmt::arg("entrance", entrance_words(law.enters)));
}

std::string given_law_words(const Diagnosis& d) {
  if (!d.unexplained) return "";
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
  const bool of_length = belt_of(law.of) && unit_of(law.of) == "mm";
  // Tolerance of a belt's pitch: one per cent.
  if (!of_length || !is_periodic(law.shape) || !is_near(law, turn, 0.01 * turn)) return {};
  return {fmt::format(
      "Its period is near one turn of the motor ({:.3f} mm of belt): is its pulley or its magnet "
      "eccentric?",
      turn)};
}

std::vector<std::string> hints_of(const Law& law, const model::Machine& machine) {
  std::vector<std::string> hints;
  const bool of_length = chain_of(law.of) && unit_of(law.of) == "mm";
  if (is_periodic(law.shape) && of_length) {
    const double pitch = machine.sprocket.pitch_mm;
    const double turn = machine.sprocket.teeth * pitch;
    // Tolerance of a period: one per cent.
    if (is_near(law, turn, 0.01 * turn)) {
      hints.push_back(fmt::format(
          "Its period is near one turn of the sprocket ({:.1f} mm): is it eccentric?", turn));
    } else if (is_near(law, 0.5 * turn, 0.005 * turn)) {
      hints.push_back(fmt::format(
          "Its period is near half a turn of the sprocket ({:.1f} mm): is it out of round?",
          0.5 * turn));
    } else if (is_near(law, pitch, 0.01 * pitch)) {
      hints.push_back(
          fmt::format("Its period is near one link and one tooth ({:.2f} mm): does the chain ride "
                      "on the teeth?",
                      pitch));
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
