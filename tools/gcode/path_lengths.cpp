// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sampling a path.
#include "tools/gcode/path_lengths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "grid/precondition.hpp"

namespace chaintrue::gcode {
namespace {

/// Samples per turn, so that a circle smaller than the step keeps its shape.
constexpr double kRowsPerTurn = 8.0;

class Sampler final : public Sink {
 public:
  Sampler(const grid::LengthMap& map,
          double every_mm,
          const std::function<void(const PathLengths&)>& write,
          Findings& findings)
      : map_(map), every_mm_(every_mm), write_(write), findings_(findings) {}

  Result<void> move(const Move& move) override {
    const double length = length_mm(move);
    const double turns = move.arc ? std::fabs(move.arc->sweep_rad) / (2.0 * std::numbers::pi) : 0.0;
    const double pieces =
        std::max({1.0, std::ceil(length / every_mm_), std::ceil(kRowsPerTurn * turns - 1e-9)});
    const double feed = move.kind == MoveKind::rapid ? 0.0 : feed_mm_per_min(move);
    for (double i = 1.0; i <= pieces; i += 1.0) {
      const Point place = at(move, i / pieces);
      const auto answer = map_.query({place.x_mm, place.y_mm});
      if (answer) {
        write_({move.line, move.kind, place, *answer, feed});
        continue;
      }
      findings_.add(Problem{ProblemName::outside_map,
                            {move.line, 0},
                            fmt::format("X{:.3f} Y{:.3f} {}",
                                        place.x_mm,
                                        place.y_mm,
                                        correction_failure(answer.error()).sentence())});
      return {};
    }
    return {};
  }
  Result<void> comment(const Comment& comment) override { return refuse_compensated(comment); }
  void note(const Note& note) override { findings_.add(note); }
  bool goes_on_after(const Problem& problem) override {
    findings_.add(problem);
    return true;
  }

 private:
  const grid::LengthMap& map_;
  double every_mm_;
  const std::function<void(const PathLengths&)>& write_;
  Findings& findings_;
};

}  // namespace

Result<ProgramSummary> path_lengths(LineSource& source,
                                    const Dialect& dialect,
                                    const grid::LengthMap& map,
                                    double every_mm,
                                    const std::function<void(const PathLengths&)>& write,
                                    Findings& findings) {
  if (!(every_mm > 0.0)) throw grid::precondition("places every {} mm make no path", every_mm);
  Sampler sampler(map, every_mm, write, findings);
  return run_program(source, dialect, sampler);
}

}  // namespace chaintrue::gcode
