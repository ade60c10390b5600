// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/next_candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kColumns = 20;
constexpr int kRows = 12;

/// Readings of the machine, with the sigma that care with usual tools reaches.
struct MachineReading {
  const char* what;
  const char* side;
  double sigma;
};
constexpr double kTapeErrorSigmaMmPerM = 0.15;  // two metres to 0.3 mm, a good tape's tolerance
constexpr MachineReading kReadings[] = {
    {"motor_spacing_mm", "", 1.0},
    {"beam_rise_mm", "", 1.0},
    {"ring_radius_mm", "", 0.5},
    {"link_pitch_mm", "left", kLinkPitchSigmaMm},
    {"link_pitch_mm", "right", kLinkPitchSigmaMm},
    {"chain_mass_kg_per_m", "", 0.002},
    {"tape_error_mm_per_m", "x", kTapeErrorSigmaMmPerM},
    {"tape_error_mm_per_m", "y", kTapeErrorSigmaMmPerM},
};

/// A session of everything that might be measured, as one more visit each.
class PointCandidates {
 public:
  PointCandidates(const Session& session, const Analysis& a) : session_(session) {
    session_.points.clear();
    session_.readings.clear();
    const model::ReadingModel model(a.state.machine);
    int last = 0;
    for (const SessionPoint& p : session.points) last = std::max(last, p.order);
    add_points(session, a, model, last + 1);
    add_revisits(session, last + 1);
    session_.ordered = false;  // each is a next visit; only their order among them is arbitrary
    add_readings(session);
  }

  [[nodiscard]] NextCandidates take() { return {std::move(session_), std::move(candidates_)}; }

 private:
  void add(model::BedPoint mark, int order, MeasurementKind kind, std::string what) {
    const auto row = 2 * static_cast<Eigen::Index>(session_.points.size());
    session_.points.push_back({0, mark, {}, order});
    candidates_.push_back({{kind, std::move(what), "", mark, 0.0}, {row, row + 1}, 2});
  }

  /// Over the bed, as far as the sheet was measured and a little beyond.
  void add_points(const Session& session,
                  const Analysis& a,
                  const model::ReadingModel& model,
                  int order) {
    double x = 0.0;
    double y = 0.0;
    for (const SessionPoint& p : session.points) {
      x = std::max(x, std::abs(p.mark.x_mm));
      y = std::max(y, std::abs(p.mark.y_mm));
    }
    x = std::min(1.1 * x, 0.49 * session.stated.bed.width_mm);
    y = std::min(1.1 * y, 0.49 * session.stated.bed.height_mm);
    for (int j = 0; j < kRows; ++j) {
      for (int i = 0; i < kColumns; ++i) {
        // Whole millimetres: the list is for a person with a tape.
        const model::BedPoint mark{std::round(x * (2.0 * i / (kColumns - 1) - 1.0)),
                                   std::round(y * (2.0 * j / (kRows - 1) - 1.0))};
        if (model.at(a.state.sheet.to_bed(mark))) {
          add(mark, order, MeasurementKind::point, "a new point");
        }
      }
    }
  }

  void add_revisits(const Session& session, int order) {
    if (!session.ordered) return;
    const SessionPoint& first = session.points.front();
    add(first.mark,
        order,
        MeasurementKind::revisit,
        fmt::format("point {}, the first of the session, once more", first.index + 1));
    const SessionPoint& middle = session.points[session.points.size() / 2];
    add(middle.mark,
        order,
        MeasurementKind::revisit,
        fmt::format("point {} once more, coming from the other side", middle.index + 1));
  }

  void add_readings(const Session& session) {
    Eigen::Index row = session_.observed_rows();
    for (const MachineReading& r : kReadings) {
      const bool done =
          std::any_of(session.readings.begin(), session.readings.end(), [&](const ExtraReading& x) {
            return x.what == r.what && x.side == r.side;
          });
      const bool ring = std::holds_alternative<model::Ring>(session.stated.attachment);
      if (done || (std::string_view(r.what) == "ring_radius_mm" && !ring)) continue;
      session_.readings.push_back({r.what, r.side, 0.0, r.sigma});
      candidates_.push_back(
          {{MeasurementKind::reading, r.what, r.side, std::nullopt, r.sigma}, {row++}, 1});
    }
  }

  Session session_;
  std::vector<Candidate> candidates_;
};

}  // namespace

NextCandidates candidates_at_points(const Session& session, const Analysis& a) {
  return PointCandidates(session, a).take();
}

}  // namespace chaintrue::grid::diagnosis
