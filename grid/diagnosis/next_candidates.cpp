// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/next_candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/raster.hpp"

namespace chaintrue::grid::diagnosis {
namespace {


/// Readings of the machine, with the sigma that careful work with usual tools reaches.
struct MachineReading {
  ReadingOf what;
  const char* side;
  double sigma;
};
constexpr double kTapeErrorSigmaMmPerM = 0.15;  // two metres to 0.3 mm, a good tape's tolerance
constexpr MachineReading kReadings[] = {
    {ReadingOf::motor_spacing, "", 1.0},
    {ReadingOf::beam_rise, "", 1.0},
    {ReadingOf::ring_radius, "", 0.5},
    {ReadingOf::link_pitch, "left", kLinkPitchSigmaMm},
    {ReadingOf::link_pitch, "right", kLinkPitchSigmaMm},
    {ReadingOf::chain_mass, "", 0.002},
    {ReadingOf::tape_error, "x", kTapeErrorSigmaMmPerM},
    {ReadingOf::tape_error, "y", kTapeErrorSigmaMmPerM},
};

/// All measurements at a mark, one more visit each.
class PointCandidates {
 public:
  PointCandidates(const Analysis& a, std::size_t part)
      : session_(a.session),
        part_(part),
        own_(dynamic_cast<const observation::ChainLengthReadings&>(
            *a.session.parts[part].observation)),
        model_(a.state.machine),
        sheet_(a.state.sheet_of(a.session.parts[part])) {
    for (const observation::Place& p : own_.places()) next_visit_ = std::max(next_visit_, p.order);
    ++next_visit_;
    add_points();
    add_revisits();
  }

  [[nodiscard]] CandidateReadings take() {
    // Each is a next visit; their order is arbitrary.
    return {{std::make_shared<const observation::ChainLengthReadings>(
                 observation::ChainLengthReadings::in_given_order(
                     std::move(places_), false, own_.noise(), own_.noise_dof(), own_.sheet())),
             part_},
            std::move(candidates_)};
  }

 private:
  void add(model::MarkPoint mark, MeasurementKind kind, std::string what) {
    const auto row = 2 * std::ssize(places_);
    places_.push_back({0, "", mark, {}, next_visit_});
    candidates_.push_back({{kind, std::move(what), "", mark, 0.0}, {row, row + 1}, 2});
  }

  /// Over the bed, as far as the sheet was measured and slightly beyond.
  void add_points() {
    double x = 0.0;
    double y = 0.0;
    for (const observation::Place& p : own_.places()) {
      x = std::max(x, std::abs(p.mark.x_mm));
      y = std::max(y, std::abs(p.mark.y_mm));
    }
    x = std::min(1.1 * x, 0.49 * session_.stated.bed.width_mm);
    y = std::min(1.1 * y, 0.49 * session_.stated.bed.height_mm);
    for (const model::MarkPoint& place : raster({-x, x, -y, y}, 20, 12, RasterOf::nodes)) {
      // Whole millimetres: the list is for a person with a tape.
      const model::MarkPoint mark{std::round(place.x_mm), std::round(place.y_mm)};
      if (model_.at(sheet_.to_bed(mark))) add(mark, MeasurementKind::point, "a new point");
    }
  }

  void add_revisits() {
    if (!own_.ordered()) return;
    const observation::Place& first = own_.places().front();
    add(first.mark,
        MeasurementKind::revisit,
        fmt::format("point {}, the first of the session, again", first.index + 1));
    const observation::Place& middle = own_.places()[own_.places().size() / 2];
    add(middle.mark,
        MeasurementKind::revisit,
        fmt::format("point {} again, coming from the other side", middle.index + 1));
  }

  const ObservationSet& session_;
  std::size_t part_;
  const observation::ChainLengthReadings& own_;
  model::ReadingModel model_;
  model::SheetPlacement sheet_;
  int next_visit_ = 0;
  std::vector<observation::Place> places_;
  std::vector<Candidate> candidates_;
};

/// Readings of the machine that were not taken.
std::optional<CandidateReadings> candidate_readings(const ObservationSet& session) {
  const std::vector<ExtraReading>& taken = session.readings();
  std::vector<ExtraReading> readings;
  for (const MachineReading& r : kReadings) {
    const bool done =
        any_of(taken, [&](const ExtraReading& x) { return x.what == r.what && x.side == r.side; });
    const ExtraReading reading{r.what, r.side, 0.0, r.sigma};
    if (!done && observation::is_predictable(session.stated, reading)) readings.push_back(reading);
  }
  if (readings.empty()) return std::nullopt;
  const auto observation =
      std::make_shared<const observation::SingleReadings>(observation::SingleReadings(readings));
  std::vector<Candidate> candidates;
  for (const ExtraReading& r : readings) {
    const auto& sorted = observation->readings();
    const auto at = std::find_if(sorted.begin(), sorted.end(), [&](const ExtraReading& x) {
      return x.what == r.what && x.side == r.side;
    });
    NextMeasurement next{MeasurementKind::reading, "", r.side, std::nullopt, r.sigma};
    next.reading = r.what;
    candidates.push_back({std::move(next), {at - sorted.begin()}, 1});
  }
  return CandidateReadings{{observation, 0}, std::move(candidates)};
}

}  // namespace

NextCandidates next_candidates(const Analysis& a) {
  std::vector<FollowUp> observations;
  std::vector<Candidate> all;
  Eigen::Index rows = 0;
  const auto take = [&](std::optional<CandidateReadings> more) {
    if (!more) return;
    for (Candidate& candidate : more->all) {
      for (Eigen::Index& row : candidate.rows) row += rows;
      all.push_back(std::move(candidate));
    }
    rows += more->observation.observation->rows();
    observations.push_back(std::move(more->observation));
  };
  bool chains_read = false;
  for (std::size_t part = 0; part < a.session.parts.size(); ++part) {
    // Another point is set out on the first sheet.
    if (a.session.parts[part].reads_chains() && !chains_read) {
      take(PointCandidates(a, part).take());
      chains_read = true;
    }
    if (!a.session.parts[part].reads_chains()) take(candidate_distances(a, part));
  }
  take(candidate_readings(a.session));
  return {with_observations(a.session, std::move(observations)), std::move(all)};
}

}  // namespace chaintrue::grid::diagnosis
