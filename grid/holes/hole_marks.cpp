// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/holes/hole_marks.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "grid/map/joint_fit.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;
using model::ChainLengths;
using model::Side;

constexpr Eigen::Index kFirstOfSheet = 6;

/// How the holes lie, as a whole, beside their commands: rows shift x, shift y, turn; by the holes'
/// places. Small turns.
Eigen::MatrixXd whole_motion(const std::vector<Hole>& holes) {
  const auto count = static_cast<Eigen::Index>(holes.size());
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Hole& hole : holes)
    middle +=
        Eigen::Vector2d(hole.commanded.x_mm, hole.commanded.y_mm) / static_cast<double>(count);
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(3, 2 * count);
  double squares = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const BedPoint c = holes[static_cast<std::size_t>(i)].commanded;
    const double x = c.x_mm - middle.x();
    const double y = c.y_mm - middle.y();
    motion(0, 2 * i) = motion(1, 2 * i + 1) = 1.0 / static_cast<double>(count);
    motion(2, 2 * i) = -y;
    motion(2, 2 * i + 1) = x;
    squares += x * x + y * y;
  }
  motion.row(2) /= squares;
  return motion;
}

}  // namespace

interp::Rectangle holes_domain(const model::Bed& bed) {
  constexpr double kBesideMm = 50.0;
  return {-0.5 * bed.width_mm - kBesideMm,
          0.5 * bed.width_mm + kBesideMm,
          -0.5 * bed.height_mm - kBesideMm,
          0.5 * bed.height_mm + kBesideMm};
}

HoleMarks::HoleMarks(const observation::TapeDistances& distances, observation::SheetPrior measured)
    : distances_(distances),
      measured_(measured),
      domain_(holes_domain(distances.set().machine->bed)),
      basis_(domain_, 4, 3),
      columns_{9, basis_.size()},
      settings_(model::kMachineSettings.begin(), model::kMachineSettings.end()) {
  settings_.insert(settings_.end(), model::kSheetSettings.begin(), model::kSheetSettings.end());
}

model::Machine HoleMarks::machine_at(const Eigen::VectorXd& unknowns) const {
  const model::Machine& stated = *distances_.set().machine;
  model::Machine machine = stated;
  for (std::size_t i = 0; i < model::kMachineSettings.size(); ++i) {
    const model::Setting setting = model::kMachineSettings[i];
    machine = model::with_setting(
        std::move(machine),
        setting,
        model::stated_value(stated, setting) + unknowns[static_cast<Eigen::Index>(i)]);
  }
  return machine;
}

model::SheetPlacement HoleMarks::sheet_at(const Eigen::VectorXd& unknowns) const {
  return {unknowns[kFirstOfSheet], unknowns[kFirstOfSheet + 1], unknowns[kFirstOfSheet + 2]};
}

ResidualSurface HoleMarks::residual_at(const Eigen::VectorXd& unknowns) const {
  const auto part = [&](Side side) -> Eigen::VectorXd {
    return unknowns.segment(columns_.spline(side), basis_.size());
  };
  return {basis_,
          {unknowns[columns_.scale(Side::left)], unknowns[columns_.scale(Side::right)]},
          {part(Side::left), part(Side::right)}};
}

tl::expected<HoleMarks::View, std::string> HoleMarks::at(const Eigen::VectorXd& unknowns) const {
  const MeasuredHoles& set = distances_.set();
  const model::ReadingModel model(machine_at(unknowns));
  const model::SheetPlacement sheet = sheet_at(unknowns);
  const ResidualSurface surface = residual_at(unknowns);
  const auto holes = static_cast<Eigen::Index>(set.holes.size());
  View view;
  Eigen::MatrixXd marks_by_unknown(2 * holes, columns_.total());
  for (Eigen::Index i = 0; i < holes; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const ChainLengths paid_out = distances_.places()[at].lengths;
    BedPoint near = set.holes[at].commanded;
    Eigen::Matrix2d by_mark;
    model::PointReading reading;
    // The surface is taken where the hole was found last; it changes by some 1e-3 of a mm's way.
    for (int turn = 0; turn < 3; ++turn) {
      const ChainLengths added = surface.apply(near, {}, Eigen::Matrix2d::Zero()).lengths;
      const auto found =
          model.find({(paid_out.left_mm - added.left_mm) / (1.0 + surface.scale.left),
                      (paid_out.right_mm - added.right_mm) / (1.0 + surface.scale.right)},
                     set.holes[at].commanded);
      if (!found) {
        return tl::unexpected(fmt::format("hole {} at ({:.1f}, {:.1f}): {}",
                                          set.holes[at].name,
                                          set.holes[at].commanded.x_mm,
                                          set.holes[at].commanded.y_mm,
                                          model::explain(found.error())));
      }
      reading = *found;
      near = sheet.to_mark(reading.pose.position);
    }
    by_mark = surface.apply(near, reading.lengths, reading.position_jacobian * sheet.rotation())
                  .mark_jacobian;
    Eigen::MatrixXd by_setting(2, 9);
    for (Eigen::Index s = 0; s < kFirstOfSheet; ++s) {
      by_setting.col(s) = model.sensitivity(reading, settings_[static_cast<std::size_t>(s)]);
    }
    by_setting.rightCols(3) = reading.position_jacobian * sheet.sensitivity(near);
    marks_by_unknown.middleRows(2 * i, 2) =
        -by_mark.inverse() * design_rows(basis_, columns_, near, reading.lengths, by_setting);
    view.marks.push_back(near);
  }
  view.geometry = observation::distance_geometry(set, view.marks);
  view.noise = observation::distance_noise(set, view.geometry);
  view.residual_mm = distances_.measured() - view.geometry.predicted_mm;
  view.design = view.geometry.by_mark * marks_by_unknown;
  free_sheet(view, marks_by_unknown);
  return view;
}

/// Directions that no edge was measured for follow from the definition of the sheet's frame.
void HoleMarks::free_sheet(View& view, const Eigen::MatrixXd& marks_by_unknown) const {
  const std::vector<Hole>& holes = distances_.set().holes;
  std::vector<Eigen::Index> rows;
  const bool measured[] = {measured_.knows_x, measured_.knows_y, measured_.knows_rotation};
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (measured[i]) continue;
    rows.push_back(i);
    view.free.push_back(kFirstOfSheet + i);
  }
  const Eigen::Index total = columns_.total();
  view.follows = Eigen::MatrixXd::Identity(total, total);
  view.to_rest = Eigen::VectorXd::Zero(total);
  view.aligned = view.marks;
  if (rows.empty()) return;
  const Eigen::MatrixXd motion = whole_motion(holes);
  Eigen::VectorXd beside(2 * static_cast<Eigen::Index>(holes.size()));
  for (std::size_t i = 0; i < holes.size(); ++i) {
    beside[2 * static_cast<Eigen::Index>(i)] = view.marks[i].x_mm - holes[i].commanded.x_mm;
    beside[2 * static_cast<Eigen::Index>(i) + 1] = view.marks[i].y_mm - holes[i].commanded.y_mm;
  }
  const Eigen::MatrixXd by_unknown = (motion * marks_by_unknown)(rows, Eigen::all);
  const Eigen::VectorXd now = (motion * beside)(rows);
  const Eigen::MatrixXd by_free = by_unknown(Eigen::all, view.free);
  const Eigen::MatrixXd inverse = by_free.inverse();
  Eigen::MatrixXd following = -inverse * by_unknown;
  following(Eigen::all, view.free).setZero();
  view.follows(view.free, Eigen::all) = following;
  view.to_rest(view.free) = -inverse * now;
  view.residual_mm -= view.design * view.to_rest;
  const Eigen::VectorXd shift = marks_by_unknown * view.to_rest;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    view.aligned[i].x_mm += shift[2 * static_cast<Eigen::Index>(i)];
    view.aligned[i].y_mm += shift[2 * static_cast<Eigen::Index>(i) + 1];
  }
}

void HoleMarks::add_surface_prior(Eigen::MatrixXd& prior, double amplitude_mm) const {
  const Eigen::MatrixXd free = basis_.polynomial_coefficients(1);
  const Eigen::MatrixXd to_free = (free.transpose() * free).ldlt().solve(free.transpose());
  const Eigen::MatrixXd bending = basis_.bending_penalty(2);
  const Eigen::MatrixXd fixed =
      to_free.transpose() * to_free / (kFreePartSigmaMm * kFreePartSigmaMm);
  // Variance of a surface of unit smoothness, averaged over the bed, gives the scale.
  const auto covariance_at = [&](double smoothness) -> Eigen::MatrixXd {
    return (fixed + smoothness * bending)
        .ldlt()
        .solve(Eigen::MatrixXd::Identity(basis_.size(), basis_.size()));
  };
  const double unit = 1.0 / bending.diagonal().mean();
  const Eigen::MatrixXd plane = covariance_at(1e9 * unit);
  const Eigen::MatrixXd bent = covariance_at(unit) - plane;
  double variance = 0.0;
  constexpr int kRaster = 8;
  for (int i = 0; i < kRaster * kRaster; ++i) {
    const double x = domain_.x_min + (i % kRaster + 0.5) / kRaster * domain_.width();
    const double y = domain_.y_min + (i / kRaster + 0.5) / kRaster * domain_.height();
    const Eigen::VectorXd row = basis_.row(x, y);
    variance += row.dot(bent * row) / (kRaster * kRaster);
  }
  const Eigen::MatrixXd covariance = covariance_at(unit * variance / (amplitude_mm * amplitude_mm));
  for (const Side side : model::kSides) {
    prior.block(columns_.spline(side), columns_.spline(side), basis_.size(), basis_.size()) =
        covariance;
  }
}

ModelSurface HoleMarks::surface_of(const Eigen::VectorXd& unknowns,
                                   const Eigen::MatrixXd& covariance,
                                   bool has_surface) const {
  ResidualSurface residual = residual_at(unknowns);
  FitColumns columns = columns_;
  Eigen::MatrixXd kept = covariance;
  if (!has_surface) {
    residual.basis = interp::BsplineBasis(domain_, 1, 1);
    columns.basis = residual.basis.size();
    residual.coefficients = {Eigen::VectorXd::Zero(columns.basis),
                             Eigen::VectorXd::Zero(columns.basis)};
    kept = Eigen::MatrixXd::Zero(columns.total(), columns.total());
    const Eigen::Index known = columns.settings + 2;
    kept.topLeftCorner(known, known) = covariance.topLeftCorner(known, known);
  }
  // The covariance has the rank of the machine's unknowns: jitter on the diagonal lets it be
  // factorised.
  constexpr double kJitter = 1e-12;
  Eigen::MatrixXd lifted = 0.5 * (kept + kept.transpose());
  lifted.diagonal() *= 1.0 + kJitter;
  lifted.diagonal().array() += 1e-14;
  return {machine_at(unknowns),
          sheet_at(unknowns),
          std::move(residual),
          columns,
          settings_,
          lifted.llt().matrixL(),
          {}};
}

}  // namespace chaintrue::grid
