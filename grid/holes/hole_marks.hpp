// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the holes are on the sheet for given unknowns, with the derivative; and what is said of a
/// fit. Private to grid/holes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/observation/tape_distances.hpp"
#include "grid/holes/holes_fit.hpp"
#include "grid/map/residual_surface.hpp"

namespace chaintrue::grid {

/// Unknowns in the order of FitColumns: settings (the machine's six and the sheet's three), scales,
/// splines.
class HoleMarks {
 public:
  HoleMarks(const observation::TapeDistances& distances, observation::SheetPrior measured);
  [[nodiscard]] const FitColumns& columns() const { return columns_; }

  struct View {
    std::vector<model::BedPoint> marks;
    /// The same with the sheet laid in its free directions as its frame is defined.
    std::vector<model::BedPoint> aligned;
    observation::DistanceGeometry geometry;
    observation::DistanceNoise noise;
    /// Readings less predictions, the free directions of the sheet put right.
    Eigen::VectorXd residual_mm;
    Eigen::MatrixXd design;   ///< n x total
    Eigen::MatrixXd follows;  ///< T, total squared
    std::vector<Eigen::Index> free;
    Eigen::VectorXd to_rest;  ///< what puts the free directions right, by unknown
  };
  /// Fails in words where the machine cannot hold the sled at a hole.
  [[nodiscard]] tl::expected<View, std::string> at(const Eigen::VectorXd& unknowns) const;

  [[nodiscard]] model::Machine machine_at(const Eigen::VectorXd& unknowns) const;
  [[nodiscard]] model::SheetPlacement sheet_at(const Eigen::VectorXd& unknowns) const;
  /// A surface that bends by this much, one sigma averaged over the bed.
  void add_surface_prior(Eigen::MatrixXd& prior, double amplitude_mm) const;
  /// Without a surface its splines and their doubt are nothing, and few.
  [[nodiscard]] ModelSurface surface_of(const Eigen::VectorXd& unknowns,
                                        const Eigen::MatrixXd& covariance,
                                        bool has_surface) const;

 private:
  void free_sheet(View& view, const Eigen::MatrixXd& marks_by_unknown) const;
  [[nodiscard]] ResidualSurface residual_at(const Eigen::VectorXd& unknowns) const;

  const observation::TapeDistances& distances_;
  observation::SheetPrior measured_;
  interp::Rectangle domain_;
  interp::BsplineBasis basis_;
  FitColumns columns_;
  std::vector<model::Setting> settings_;
};

/// The bed, as far as a sheet may lie beside it.
[[nodiscard]] interp::Rectangle holes_domain(const model::Bed& bed);
/// What was set aside and why, what is off, and what is suspected.
[[nodiscard]] std::vector<std::string> fit_notes(const MeasuredHoles& set, const HolesFit& fit);

}  // namespace chaintrue::grid
