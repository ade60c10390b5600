// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The common interface of all measurements: an observation is a set of readings with their
/// prediction by the machine. Estimators and diagnosis depend on nothing else; a kind of
/// observation is one file pair here and one line in kinds.def.
///
/// Notation
///   y      what was read                       n numbers, mm or the reading's own unit
///   f   the machine's prediction
///   theta  parameters of the mechanism, then of the sheet                 p of them
///   b      nuisances: errors that several readings share, each about zero with a sigma   q of them
///   c_i    added to the two chains at place i (effects, a surface) [mm]
///
///   y = f + A (theta - theta_0) + B b + sum_i D_i c_i + noise,   noise of unit u ~ N(0, C_u)   (1)
///
/// A place is where the tool stood while the machine held it: a mark, or a hole. A unit is the rows
/// that one gross error makes outliers together; noise of different units is independent given b.
/// Whitening W_u with W_u C_u W_u' = I brings a unit to units of noise.
///
/// \code
///   const auto tape = TapeDistances::of(set);                // or ChainLengthReadings, ...
///   const model::ReadingModel model(machine);
///   const auto line = tape->linearise({model, {}}, columns_of(*tape));
///   if (line) residual = tape->measured() - line->predicted;   // y - f
/// \endcode
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "interp/eigen.hpp"
#include "model/calibration/setting.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/effects/effect.hpp"
#include "model/mechanism.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::observation {

/// The names of a kind in files and sentences. One constant for each line of kinds.def.
struct Kind {
  std::string_view id;        ///< of the .def and of files
  std::string_view unit;      ///< "point", "distance": the unit for outliers
  std::string_view units;     ///< "points"
  std::string_view place;     ///< "point", "hole"; empty if the tool stood nowhere
  bool reads_chains = false;  ///< lengths were read at a place, not paid out by a controller
};

/// Where the tool stood.
struct Place {
  std::size_t index = 0;  ///< into the file's points, or holes
  std::string name;       ///< "3", "A"
  MarkPoint mark;         ///< as written, or as commanded
  ChainLengths lengths;   ///< read there, or paid out to get there
  int order = 0;          ///< of the visit
  /// The command to the controller, if the lengths come from a command at this mark.
  std::optional<BedPoint> commanded = std::nullopt;
};

/// Rows that are good or bad together.
struct Unit {
  Index first_row = 0;
  Index rows = 1;
  std::size_t index = 0;  ///< into the file's points, or distances
};

/// Sigmas of the marks' frame, if it was placed on the bed by hand.
struct SheetPrior {
  double shift_sigma_mm = 0.0;
  double rotation_sigma_rad = 0.0;
  /// Directions of its placement on which the readings depend.
  bool knows_x = true;
  bool knows_y = true;
  bool knows_rotation = true;
  /// For x, y and the rotation.
  Vector3d sigma() const { return {shift_sigma_mm, shift_sigma_mm, rotation_sigma_rad}; }
  /// True for a setting that is not the sheet's.
  bool knows(Setting setting) const {
    if (setting == Setting::sheet_x_mm) return knows_x;
    if (setting == Setting::sheet_y_mm) return knows_y;
    return setting != Setting::sheet_rotation_rad || knows_rotation;
  }
};

/// A fit's correction of the machine's lengths over the sheet.
class LengthCorrection {
 public:
  virtual ~LengthCorrection() = default;
  struct At {
    ChainLengths lengths;  ///< corrected
    Matrix2d by_mark;      ///< d(corrected)/d(mark)
    /// d(corrected)/d(the machine's own), one for each chain.
    Vector2d by_length = Vector2d::Ones();
  };
  /// At a mark where the machine alone has `lengths` and their derivative by the mark.
  virtual At at(MarkPoint mark, ChainLengths lengths, const Matrix2d& by_mark) const = 0;
};

/// The point of linearisation: a mechanism, the placement of the marks' sheet, and a correction of
/// the mechanism's lengths.
struct View {
  explicit View(std::shared_ptr<const Mechanism> what_hangs) : mechanism(std::move(what_hangs)) {}
  View(std::shared_ptr<const Mechanism> what_hangs, SheetPlacement placement,
       const LengthCorrection* length_correction = nullptr)
      : mechanism(std::move(what_hangs)), sheet(placement), correction(length_correction) {}
  /// For two chains.
  View(ReadingModel chains, SheetPlacement placement,
       const LengthCorrection* length_correction = nullptr)
      : View(std::make_shared<const ReadingModel>(std::move(chains)), placement,
             length_correction) {}

  /// The two-chain model, for kinds that read only chains. \throws std::logic_error for another
  /// mechanism.
  const ReadingModel& chains() const {
    const auto* own = dynamic_cast<const ReadingModel*>(mechanism.get());
    if (own == nullptr) {
      throw std::logic_error("readings of two chains for a mechanism with " +
                             std::string(mechanism->kind()));
    }
    return *own;
  }

  /// What is read at a mark where the mechanism alone has these lengths, and their derivative by it.
  LengthCorrection::At corrected(MarkPoint mark, ChainLengths lengths,
                                 const Matrix2d& by_mark) const {
    if (correction == nullptr) return {lengths, by_mark};
    return correction->at(mark, lengths, by_mark);
  }

  std::shared_ptr<const Mechanism> mechanism;
  SheetPlacement sheet;
  const LengthCorrection* correction = nullptr;
};

/// The requested columns of A: of the mechanism's parameters, in its order, then of the three of
/// the sheet.
struct Columns {
  bool parameters = false;
  bool sheet = false;
};

/// A place on a two-chain machine as a view predicts it, with the machine's own reading and mark.
struct ChainPlaceState : LengthCorrection::At {
  model::PointReading reading;  ///< of the machine alone
  MarkPoint mark;               ///< on the sheet; for a hole, where the machine puts it
};
ChainPlaceState place_state(const View& view, const model::PointReading& reading, MarkPoint mark);

/// How the chains at a place move a unit: D_i, rows x 2.
struct PlaceColumns {
  std::size_t place = 0;
  Eigen::Matrix<double, Eigen::Dynamic, 2, 0, 4, 2> by_chain;
};

struct UnitState {
  MatrixXd covariance;  ///< C_u
  std::vector<PlaceColumns> places;
  /// If single readings of a unit may be outliers: the effect of a millimetre of each on its rows,
  /// rows x readings; a zero column for a reading that does not count. Empty: the unit is an
  /// outlier as a whole.
  MatrixXd by_reading = {};
};

/// (1) about one view.
struct Linearisation {
  VectorXd predicted;    ///< f, n
  MatrixXd by_setting;   ///< A, n x p
  MatrixXd by_nuisance;  ///< B, n x q
  /// For each place; empty for kinds whose lengths no LengthCorrection corrects.
  std::vector<ChainPlaceState> places;
  std::vector<UnitState> units;
};

/// The machine cannot hold the tool at a place, by its number.
using Unreachable = Failure<model::MechanismReason, std::size_t>;

/// A single reading of a unit.
struct UnitReading {
  std::size_t unit = 0;
  Index reading = 0;  ///< a column of UnitState::by_reading
  friend bool operator==(const UnitReading&, const UnitReading&) = default;
};

/// Readings of one kind, taken in one session with one sheet. Immutable, thread safe. The order of
/// rows does not depend on the file's.
class Observation {
 public:
  virtual ~Observation() = default;
  virtual const Kind& kind() const = 0;

  Index rows() const { return measured_.size(); }
  const std::vector<Place>& places() const { return places_; }
  /// In the order of their rows, which they cover without a gap.
  const std::vector<Unit>& units() const { return units_; }
  /// y: the readings after exact corrections.
  const VectorXd& measured() const { return measured_; }
  /// One sigma of each nuisance.
  const VectorXd& nuisance_sigma() const { return nuisance_sigma_; }
  /// Number of nuisances, the last ones, that belong to the noise: the noise factor scales them
  /// too. Those before them have their stated sigmas.
  virtual Index nuisances_of_noise() const { return 0; }
  /// Absent: the marks' frame is the bed's.
  const std::optional<SheetPrior>& sheet() const { return sheet_; }
  /// The visits' order is known.
  bool ordered() const { return ordered_; }
  /// Degrees of freedom of the noise.
  double noise_dof() const { return noise_dof_; }
  /// Whether units may be outliers; false for careful single measurements with a stated sigma.
  bool may_be_outlier() const { return may_be_outlier_; }

  /// The same rows, linearised without these readings: a position is estimated from the others
  /// alone. Null for a kind whose units are outliers as a whole.
  virtual std::shared_ptr<const Observation> about_others(
      const std::vector<UnitReading>& /*rejected*/) const {
    return nullptr;
  }

  /// f, visit by visit where the order is known; by default that of linearise().
  [[nodiscard]] virtual tl::expected<VectorXd, Unreachable> predicted(const View& view) const {
    return linearise(view, {}).map([](Linearisation line) { return std::move(line.predicted); });
  }
  /// The sheet is this observation's own.
  [[nodiscard]] virtual tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const = 0;

  /// Why this kind cannot show the effect; empty if it can. By default it shows all but those that
  /// need an unknown order.
  virtual std::string untestable(const Effect& effect, EffectSide /*side*/) const {
    const bool needs_order = effect.needs == DataNeed::order;
    return needs_order && !ordered_ ? "the order in which the points were visited is not known"
                                    : "";
  }
  /// Words for a unit: "point 3 at (-900, 400) mm", "the distance A-B".
  virtual std::string name_of(std::size_t unit) const = 0;

 protected:
  Observation(bool ordered, double noise_dof, bool may_be_outlier = true)
      : ordered_(ordered), noise_dof_(noise_dof), may_be_outlier_(may_be_outlier) {}
  Observation(const Observation&) = default;
  Observation(Observation&&) = default;
  Observation& operator=(const Observation&) = default;
  Observation& operator=(Observation&&) = default;

  /// Zeros for so many settings, without places and units.
  Linearisation blank(Index settings) const {
    return {VectorXd::Zero(rows()),
            MatrixXd::Zero(rows(), settings),
            MatrixXd::Zero(rows(), nuisance_sigma_.size()),
            {},
            {}};
  }

  std::vector<Place> places_;
  std::vector<Unit> units_;
  VectorXd measured_;
  VectorXd nuisance_sigma_;
  std::optional<SheetPrior> sheet_;
  bool ordered_;
  double noise_dof_;
  bool may_be_outlier_;
};

using Observations = std::vector<std::shared_ptr<const Observation>>;

/// The mechanism's parameters, and the sheet's where the observation has one.
Columns columns_of(const Observation& observation);
/// The same columns for two chains, by their settings' names.
std::vector<Setting> settings_in(const Columns& columns);

/// Every kind, in the order of kinds.def.
const std::vector<const Kind*>& kinds();

#define CHAINTRUE_OBSERVATION(id) extern const Kind id;
#include "grid/observation/kinds.def"
#undef CHAINTRUE_OBSERVATION

/// C of all units and, separately, B diag(sigma^2) B'.
MatrixXd marginal_covariance(const Linearisation& line, const VectorXd& nuisance_sigma);

/// How settings of two chains move the machine's own lengths at a place, 2 x p; `place` is the
/// requested place on the sheet, with the machine's effects of the paper removed.
Matrix2Xd lengths_by_setting(const View& view, const model::PointReading& reading, MarkPoint place,
                             const std::vector<Setting>& settings);

}  // namespace chaintrue::grid::observation
