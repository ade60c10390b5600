// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A measured file in a joint fit: its observation, and the treatment specific to its kind.
/// joint_fit() uses nothing else of a file. Private to grid/map.
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/fit.hpp"
#include "grid/map/fitted_points.hpp"

namespace chaintrue::grid {

/// The input of the fit, and its estimate. The observations of the files come first, in their
/// order.
struct Fitting {
  estimation::EstimationInput input;
  estimation::Estimate estimate;

  /// The estimate of `input`.
  [[nodiscard]] static tl::expected<Fitting, FitFailure> of(estimation::EstimationInput input);
  /// A place on a file's sheet in the frame of the first file's marks.
  MarkPoint in_frame(std::size_t file, MarkPoint mark) const;
};

/// Collects the files' parts of a map.
struct MapDraft {
  MapContents map;
  std::vector<MarkPoint> good;      ///< places that count, in the map's frame
  std::vector<FittedPoint> points;  ///< of all grids
  std::vector<FittedDistances> distances;
  double tape_sigma_mm = 0.0;            ///< of the first set, if all files are sets of holes
  std::vector<std::string> sources;      ///< the contribution of each file, if there are several
  std::vector<std::string> notes;        ///< for each file's readings
  std::vector<std::string> frame_notes;  ///< of the placement of the first file's frame
  std::vector<std::string> last_notes;
};

class FitPart {
 public:
  FitPart() = default;
  FitPart(const FitPart&) = delete;
  FitPart& operator=(const FitPart&) = delete;
  virtual ~FitPart() = default;

  Machine machine;  ///< as stated; for a grid without the effects removed from its data
  std::shared_ptr<const observation::Observation> observation;
  interp::NoiseScale noise;
  interp::Rectangle domain;
  /// The observation's units that are left out together.
  std::vector<estimation::UnitGroup> held_out_together;
  std::vector<ExtraReading> readings;    ///< of the machine
  std::vector<std::string> corrections;  ///< what was corrected in the data, whole sentences
  std::size_t fewest_good = 0;           ///< units that a map of this file alone needs
  std::optional<SheetUncertainty> sheet;

  /// Work steps if the noise has to be estimated too, for a single file.
  static constexpr int kStepsToFindNoise = 4;
  /// Fits again with the noise estimated, if none is stated. For a single file.
  [[nodiscard]] virtual tl::expected<void, FitFailure> find_noise(Fitting& /*alone*/) { return {}; }
  /// States the noise found from this file alone.
  virtual void take_noise(const Fitting& /*alone*/) {}
  /// What to check if a single file has too few good units.
  virtual std::string to_check() const = 0;
  /// Puts the file, `file` by its number, into the map. `name` is empty if it is the only one.
  virtual void add_to(MapDraft& draft, const Fitting& fitting, std::size_t file,
                      const std::string& name) const = 0;
};

/// Fails if the file states no machine, or readings with which none is possible.
[[nodiscard]] tl::expected<std::unique_ptr<FitPart>, FitFailure> part_of(const MeasuredGrid& grid);
/// \throws std::invalid_argument for a set without distances.
[[nodiscard]] tl::expected<std::unique_ptr<FitPart>, FitFailure> part_of(const MeasuredHoles& set);

/// The machine with its direct readings applied, if it is possible. `what` has the readings.
[[nodiscard]] tl::expected<void, FitFailure> check_readings_of(
    const Machine& machine, const std::vector<ExtraReading>& readings, const char* what);

}  // namespace chaintrue::grid
