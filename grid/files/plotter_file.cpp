// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/plotter_file.hpp"

#include <fmt/format.h>

#include "grid/files/provenance_record.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::files {
namespace {

auto found_setting_record() {
  RECORD(FoundSetting, "an estimated setting")
  REQUIRED(value, "Its value.", kMillimetres)
  REQUIRED(sigma, "Its uncertainty, 1 sigma.", kSigmaMm);
}

void check_correlations(const Cursor& at, FoundPlotter& found) {
  constexpr std::size_t kPairs = 15;  // of six settings
  if (!at.clean()) return;
  if (found.correlations.size() != kPairs) {
    at.child("correlations")
        .report(fmt::format("{} numbers", found.correlations.size()), ProblemKind::wrong_count,
                "15, of each of the six settings with those after it");
    return;
  }
  // Rounding may move a correlation matrix's least eigenvalue below zero by this.
  constexpr double kRounding = 1e-6;
  const VectorXd scale = found.covariance().diagonal().cwiseSqrt();
  MatrixXd of_ones = found.covariance();
  for (Index i = 0; i < scale.size(); ++i) {
    if (!(scale[i] > 0.0)) return;
    of_ones.row(i) /= scale[i];
    of_ones.col(i) /= scale[i];
  }
  if (linear::SymmetricEigen(of_ones).eigenvalues().minCoeff() >= -kRounding) return;
  at.child("correlations")
      .report("correlations that six quantities can have", ProblemKind::impossible,
              "the ones that chaintrue fit wrote");
}

auto found_plotter_record() {
  const auto setting = found_setting_record();
  RECORD(FoundPlotter, "settings estimated from a drawing")
  REQUIRED(pin_spacing_mm, "Distance between the pins.", setting)
  REQUIRED(pin_rise_mm, "Height of the right pin above the left.", setting)
  REQUIRED(zero_left_mm, "Excess of the controller's length of the left cord.", setting)
  REQUIRED(zero_right_mm, "Excess of the controller's length of the right cord.", setting)
  REQUIRED(scale_left_mm_per_m, "Excess of the controller's length per metre of the left cord.",
           setting)
  REQUIRED(scale_right_mm_per_m, "Excess of the controller's length per metre of the right cord.",
           setting)
  REQUIRED(correlations,
           "Correlations of each of these six, in this order, with those after it: 15 "
           "numbers, used for the expected error of compensated drawings.",
           list({"", -1.0, 1.0}))
      .check(check_correlations);
}

/// A machine with these settings must be valid.
void check_found(const Cursor& at, KnownPlotter& plotter) {
  if (!at.clean() || !plotter.found) return;
  const auto problems = model::problems_of(machine_found(plotter.set, *plotter.found));
  if (problems.empty()) return;
  at.child("found").report(problems.front().parameter.substr(1) + " " + problems.front().value,
                           ProblemKind::impossible, problems.front().expected);
}

const Record<KnownPlotter>& plotter_record() {
  static const auto record = [] {
    RECORD(KnownPlotter, "a V-plotter", kPlotterFormat)
    REQUIRED(set, "The plotter with its controller's settings.", set_plotter_record())
    OPTIONAL(found, "Results of a test drawing; absent before one was measured.",
             found_plotter_record())
    ALSO(add_made_by_key).check(check_found);
  }();
  return record;
}

}  // namespace

KnownPlotter parse_plotter(const std::string& text, const std::string& file) {
  return read_document(plotter_record(), text, file);
}

std::string write_plotter(const KnownPlotter& plotter, const std::vector<std::string>& comments,
                          const std::optional<Provenance>& made_by) {
  Json json = with_made_by(plotter_record().write(plotter), made_by);
  if (!comments.empty()) json["comment"] = comments;
  return print_json(json);
}

Json plotter_schema() { return plotter_record().schema(); }

}  // namespace chaintrue::grid::files
