// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A law: the variable of a pattern that no listed cause explains, with its shape, its place or
/// period, and where it enters.
///
/// With v what it is a function of, from `from` to `to` over the readings, middle and span of these:
///
/// | shape       | adds, in mm                                      | parameters               |
/// |-------------|--------------------------------------------------|--------------------------|
/// | linear      | size (v - middle) / span                         | size_mm                  |
/// | square      | size ((v - place) / (span / 2))^2                | size_mm, place           |
/// | step        | size for v >= place, else 0                      | size_mm, place           |
/// | kink        | size max(0, towards (v - place)) / span          | size_mm, place           |
/// | exponential | size exp(-distance of v from the end / scale), the end being `to` where `towards` is 1, `from` where -1 | size_mm, scale |
/// | wave        | size sin(w + phase), w = 2 pi (v - middle) / period | size_mm, period, phase_rad |
/// | harmonics   | size sin(w + phase) + second_size sin(2 w + second_phase) | size_mm, period, phase_rad, second_size_mm, second_phase_rad |
///
/// A place, scale or period has the unit of v in its name: mm, rad, n (newtons), visit.
#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/belts/belt.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid::estimation {
struct SystemPlace;
}
namespace chaintrue::grid::diagnosis {

/// A coordinate of a place where readings were taken, on which a pattern, a law or a residual may be a
/// function: unit_of(Coordinate::tension_left) is "n", chain_of() it Side::left, and value_at() a place
/// its newtons there.
enum class Coordinate {
  x,              ///< mm
  y,              ///< mm
  across,         ///< mm, over the bed in any direction
  border,         ///< mm, from the nearest border of the bed inwards
  length_left,    ///< mm
  length_right,   ///< mm
  angle_left,     ///< rad
  angle_right,    ///< rad
  tension_left,   ///< N, at the sprocket
  tension_right,  ///< N
  visit,          ///< number of the visit
  length_tl,      ///< mm, of a belt
  length_tr,      ///< mm
  length_bl,      ///< mm
  length_br,      ///< mm
  angle_tl,       ///< rad, of a belt against the horizontal, at its anchor
  angle_tr,       ///< rad
  angle_bl,       ///< rad
  angle_br,       ///< rad
  place,          ///< both x and y
};
/// Its name in files.
std::string_view name(Coordinate of);
/// "mm", "rad", "n", "visit": what a parameter's name ends in.
std::string_view unit_of(Coordinate of);
/// The chain or belt that it belongs to, if any.
std::optional<Side> chain_of(Coordinate of);
std::optional<Belt> belt_of(Coordinate of);

/// `across_rad`: of Coordinate::across, from x towards y. \pre A coordinate of such a machine, and not the place.
double value_at(const estimation::SystemPlace& place, Coordinate of, double across_rad = 0.0);

/// Where an unlisted pattern enters: one chain, both equally or opposite to each other, the tool
/// along an axis of the sheet, or none of these by itself. Of a law also: the tool along the
/// direction that the law runs in, the tool outwards over every border, and one of four belts.
enum class Enters { left, right, equal, opposite, x, y, mixed, along, outwards, tl, tr, bl, br };
std::string_view name(Enters enters);

/// For a law that enters a belt or one chain; null for all others.
std::optional<Belt> belt_of(Enters enters);
std::optional<Side> chain_of(Enters enters);

enum class LawShape { linear, square, step, kink, exponential, wave, harmonics };
std::string_view name(LawShape shape);
/// Whether it has a period.
bool is_periodic(LawShape shape);
/// The names of the parameters of a law of this shape in a variable, in the order of the table.
std::vector<std::string> parameter_names(LawShape shape, Coordinate of);

struct ParameterEstimate {
  std::string parameter;
  double value = 0.0;
  double sigma = 0.0;  ///< 0 for an integer that these data determine
};

/// A point next to a law's curve. If the law moves the tool outwards a point has two, along x and
/// along y.
struct LawResidual {
  std::size_t index = 0;  ///< of the point
  double at = 0.0;        ///< what the law is a function of
  /// Partial residual: the law's contribution here plus the unexplained residual in the coordinate
  /// that the law enters.
  double residual_mm = 0.0;
  /// Residual shift of the tool without the law and the settings and causes that act with it; a
  /// smooth pattern remains in it. Empty for belts, which do not determine where the tool should
  /// have been.
  std::optional<double> left_x_mm{};
  std::optional<double> left_y_mm{};
};

/// rms error of predicting left-out readings from the others, mm: without a law and with it.
struct LawHeldOut {
  struct Errors {
    double without_mm = 0.0;
    double with_mm = 0.0;
  };
  Errors inside;   ///< every fourth place
  Errors outside;  ///< a quarter of the bed on one side of a line
};

/// The variable of a law, and where it enters.
struct LawTerm {
  Coordinate of = Coordinate::x;  ///< anything but Coordinate::place
  Enters enters = Enters::mixed;
  double direction_deg = 0.0;  ///< of Coordinate::across and Enters::along, from x towards y
  double direction_rad() const { return direction_deg * std::numbers::pi / 180.0; }
};
/// With the shape, over a range of the variable.
struct LawForm : LawTerm {
  LawShape shape = LawShape::linear;
  int towards = 0;  ///< of a kink or an exponential: 1, -1; else 0
  double from = 0.0;
  double to = 0.0;
  double span() const { return to - from; }
  double middle() const { return 0.5 * (from + to); }
};

struct Law : LawForm {
  /// Probability that the pattern is a function of this variable and enters there, whatever its
  /// shape.
  double probability = 0.0;
  double shape_probability = 0.0;  ///< of this shape, given the law
  double rms_mm = 0.0;  ///< of the tool at the points; with four belts, of one of the belts
  double share = 0.0;   ///< of the mean square of the residual of the settings
  std::vector<ParameterEstimate> parameters;  ///< in the order of the table
  std::vector<LawResidual> points;            ///< those that were not rejected, in their order
  std::optional<LawHeldOut> held_out{};
};

/// In mm, at one value of its variable. \throws std::invalid_argument for a law whose parameters
/// are not those of its shape.
double value_of(const Law& law, double v);

}  // namespace chaintrue::grid::diagnosis
