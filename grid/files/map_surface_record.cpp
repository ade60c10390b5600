// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/map_surface_record.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/containers.hpp"
#include "grid/files/machine_record.hpp"
#include "grid/files/parse_double.hpp"
#include "grid/files/record_values.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::files {
namespace {

Value<Numbers> numbers(std::size_t fewest = 0) { return list(number(kAnyNumber), fewest); }

Record<model::SheetPlacement> sheet_placement_record() {
  return Record<model::SheetPlacement>("a sheet's placement")
      .required(
          "x_mm", "x of the marks' origin on the bed.", &model::SheetPlacement::x_mm, kPlaceMm)
      .required(
          "y_mm", "y of the marks' origin on the bed, up.", &model::SheetPlacement::y_mm, kPlaceMm)
      .required("rotation_rad",
                "Rotation of the marks, counter-clockwise.",
                &model::SheetPlacement::rotation_rad,
                number({"rad", -7.0, 7.0}));
}

Record<SplinePart> spline_record() {
  return Record<SplinePart>("a residual surface")
      .required("rectangle_mm",
                "Where the splines are defined.",
                &SplinePart::rectangle,
                rectangle_record())
      .required(
          "x_intervals", "Equal intervals along x.", &SplinePart::x_intervals, integer(1, 1000))
      .required(
          "y_intervals", "Equal intervals along y.", &SplinePart::y_intervals, integer(1, 1000))
      .required("scale_left",
                "Correction of the left chain per mm of length.",
                &SplinePart::scale_left,
                number({"", -0.1, 0.1}))
      .required("scale_right",
                "Correction of the right chain per mm of length.",
                &SplinePart::scale_right,
                number({"", -0.1, 0.1}))
      .required("coefficients_left_mm",
                "Coefficients of cubic B-splines for the left chain, y varying fastest: "
                "(x_intervals + 3) (y_intervals + 3) values.",
                &SplinePart::left_mm,
                numbers())
      .required("coefficients_right_mm",
                "Coefficients for the right chain, in the same order.",
                &SplinePart::right_mm,
                numbers())
      .check([](const Cursor& at, SplinePart& part) {
        if (!at.clean()) return;
        const auto size = static_cast<std::size_t>((part.x_intervals + 3) * (part.y_intervals + 3));
        const std::string expected = fmt::format("{} coefficients, as the intervals say", size);
        if (part.left_mm.size() != size) at.child("coefficients_left_mm").expect(expected);
        if (part.right_mm.size() != size) at.child("coefficients_right_mm").expect(expected);
      });
}

void check_model_part(const Cursor& at, ModelPart& part) {
  if (!at.clean()) return;
  const std::size_t unknowns = part.unknown_settings.size() + 2 + part.residual.left_mm.size() * 2;
  bool triangle = part.covariance_factor.size() == unknowns;
  for (std::size_t i = 0; triangle && i < unknowns; ++i)
    triangle = part.covariance_factor[i].size() == i + 1;
  if (!triangle) {
    at.child("covariance_factor")
        .expect(
            fmt::format("the {} rows of a lower triangle, of 1 to {} numbers", unknowns, unknowns));
  }
}

Value<interp::EndCondition> end_condition() {
  return choice<interp::EndCondition>({{"not_a_knot", interp::EndCondition::not_a_knot},
                                       {"natural", interp::EndCondition::natural},
                                       {"parabolic", interp::EndCondition::parabolic},
                                       {"clamped", interp::EndCondition::clamped}});
}

Record<interp::AxisEnds> axis_ends_record() {
  return Record<interp::AxisEnds>("the conditions at both ends of an axis")
      .required("low", "At the smaller end.", &interp::AxisEnds::low, end_condition())
      .required("high", "At the larger end.", &interp::AxisEnds::high, end_condition());
}

Record<interp::TensorEnds> ends_record() {
  return Record<interp::TensorEnds>("the conditions at the edges")
      .required("x", "Along x.", &interp::TensorEnds::x, axis_ends_record())
      .required("y", "Along y.", &interp::TensorEnds::y, axis_ends_record());
}

bool rises(const Numbers& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) {
           return !(a < b);
         }) == values.end();
}

struct NodeValues {
  const char* key;
  const std::vector<Numbers>* rows;
};

/// Checks that nodes increase, and that there are as many values as nodes.
template <class Part>
void check_nodes(const Cursor& at, const Part& part, std::initializer_list<NodeValues> values) {
  if (!at.clean()) return;
  if (!rises(part.x_nodes_mm)) at.child("x_nodes_mm").expect("numbers that rise");
  if (!rises(part.y_nodes_mm)) at.child("y_nodes_mm").expect("numbers that rise");
  const auto shape = [&](const std::vector<Numbers>& rows) {
    return rows.size() == part.x_nodes_mm.size() && all_of(rows, [&](const Numbers& column) {
             return column.size() == part.y_nodes_mm.size();
           });
  };
  const std::string expected = fmt::format("{} lists of {} lengths, one list for each x",
                                           part.x_nodes_mm.size(),
                                           part.y_nodes_mm.size());
  for (const NodeValues& value : values) {
    if (!shape(*value.rows)) at.child(value.key).expect(expected);
  }
}

void check_direct_part(const Cursor& at, DirectPart& part) {
  check_nodes(at, part, {{"left_mm", &part.left_mm}, {"right_mm", &part.right_mm}});
}

void check_lattice_part(const Cursor& at, LatticePart& part) {
  check_nodes(
      at,
      part,
      {{"left_mm", &part.left_mm}, {"right_mm", &part.right_mm}, {"doubt_mm", &part.doubt_mm}});
}

Record<LatticePart> lattice_part_record() {
  return Record<LatticePart>("splines through what the machine leaves at every node")
      .required("x_nodes_mm", "Nodes along x, increasing.", &LatticePart::x_nodes_mm, numbers(2))
      .required("y_nodes_mm", "Nodes along y, increasing.", &LatticePart::y_nodes_mm, numbers(2))
      .required("left_mm",
                "Left chain at every node: one list for each x.",
                &LatticePart::left_mm,
                list(numbers(2), 2))
      .required(
          "right_mm", "Right chain at every node.", &LatticePart::right_mm, list(numbers(2), 2))
      .required("doubt_mm",
                "Uncertainty of the value at each node.",
                &LatticePart::doubt_mm,
                list(list(kNotNegative, 2), 2))
      .required("interpolation_sigma_mm",
                "Error of the splines between nodes, 1 sigma.",
                &LatticePart::interpolation_sigma_mm,
                kNotNegative)
      .check(check_lattice_part);
}

double seven_digits(double value) {
  const std::string digits = fmt::format("{:.7g}", value);
  double rounded = 0.0;
  parse_double(digits.data(), digits.data() + digits.size(), rounded);
  return rounded;
}

Numbers to_numbers(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

Eigen::VectorXd to_vector(const Numbers& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<Numbers> to_lists(const Eigen::MatrixXd& values) {
  std::vector<Numbers> lists;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    lists.push_back(to_numbers(values.row(i).transpose()));
  return lists;
}

Eigen::MatrixXd to_matrix(const std::vector<Numbers>& lists) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(lists.size()),
                         static_cast<Eigen::Index>(lists.front().size()));
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    values.row(i) = to_vector(lists[static_cast<std::size_t>(i)]).transpose();
  }
  return values;
}

}  // namespace

const Record<interp::Rectangle>& rectangle_record() {
  static const auto record =
      Record<interp::Rectangle>("a rectangle in mm")
          .required("x_min", "Left edge.", &interp::Rectangle::x_min, kPlaceMm)
          .required("x_max", "Right edge.", &interp::Rectangle::x_max, kPlaceMm)
          .required("y_min", "Lower edge.", &interp::Rectangle::y_min, kPlaceMm)
          .required("y_max", "Upper edge.", &interp::Rectangle::y_max, kPlaceMm)
          .check([](const Cursor& at, interp::Rectangle& r) {
            if (at.clean() && !(r.width() > 0.0 && r.height() > 0.0)) {
              at.expect("a rectangle whose maxima lie above its minima");
            }
          });
  return record;
}

const Record<ModelPart>& model_part_record() {
  static const auto record = [] {
    std::vector<std::string> words;
    for (auto setting : model::kMachineSettings) words.emplace_back(model::name(setting));
    for (auto setting : model::kSheetSettings) words.emplace_back(model::name(setting));
    return Record<ModelPart>("a surface on a machine")
        .required("machine", "The calibrated machine.", &ModelPart::machine, machine_record())
        .required(
            "sheet", "Placement of the marks' sheet.", &ModelPart::sheet, sheet_placement_record())
        .required("unknown_settings",
                  "The settings that were calibrated, in the order of the covariance.",
                  &ModelPart::unknown_settings,
                  list(one_of(words)))
        .required("residual",
                  "Correction added to the machine's lengths.",
                  &ModelPart::residual,
                  spline_record())
        .required("covariance_factor",
                  "Triangular root of the covariance of settings, scales and coefficients; lower "
                  "triangle, row by row.",
                  &ModelPart::covariance_factor,
                  list(numbers(1)))
        .optional("lattice",
                  "For a full grid of marks: splines through the residuals at every node.",
                  &ModelPart::lattice,
                  lattice_part_record())
        .check(check_model_part);
  }();
  return record;
}

const Record<DirectPart>& direct_part_record() {
  static const auto record =
      Record<DirectPart>("splines through the lengths")
          .required("x_nodes_mm", "Nodes along x, increasing.", &DirectPart::x_nodes_mm, numbers(2))
          .required("y_nodes_mm", "Nodes along y, increasing.", &DirectPart::y_nodes_mm, numbers(2))
          .required("left_mm",
                    "Left chain at every node: one list for each x.",
                    &DirectPart::left_mm,
                    list(numbers(2), 2))
          .required(
              "right_mm", "Right chain at every node.", &DirectPart::right_mm, list(numbers(2), 2))
          .required("ends", "End conditions of the splines.", &DirectPart::ends, ends_record())
          .required("interpolation_sigma_mm",
                    "Error of the splines between nodes, 1 sigma.",
                    &DirectPart::interpolation_sigma_mm,
                    kNotNegative)
          .check(check_direct_part);
  return record;
}

ModelPart part_of(const ModelSurface& surface) {
  ModelPart part;
  part.machine = surface.machine;
  part.sheet = surface.sheet;
  for (auto setting : surface.settings) part.unknown_settings.emplace_back(model::name(setting));
  const interp::BsplineBasis& basis = surface.residual.basis;
  part.residual = {basis.rectangle(),
                   static_cast<int>(basis.columns_x()) - 3,
                   static_cast<int>(basis.columns_y()) - 3,
                   surface.residual.scale.left,
                   surface.residual.scale.right,
                   to_numbers(surface.residual.coefficients.left),
                   to_numbers(surface.residual.coefficients.right)};
  for (Eigen::Index i = 0; i < surface.covariance_factor.rows(); ++i) {
    Numbers row;
    for (Eigen::Index j = 0; j <= i; ++j)
      row.push_back(seven_digits(surface.covariance_factor(i, j)));
    part.covariance_factor.push_back(std::move(row));
  }
  if (surface.lattice) {
    const LatticeResidual& lattice = *surface.lattice;
    part.lattice = LatticePart{lattice.x_nodes_mm,
                               lattice.y_nodes_mm,
                               to_lists(lattice.values_mm.left),
                               to_lists(lattice.values_mm.right),
                               to_lists(lattice.doubt_mm),
                               lattice.interpolation_sigma_mm};
  }
  return part;
}

ModelSurface surface_of(const ModelPart& part) {
  ModelSurface surface{
      part.machine,
      part.sheet,
      {interp::BsplineBasis(
           part.residual.rectangle, part.residual.x_intervals, part.residual.y_intervals),
       {part.residual.scale_left, part.residual.scale_right},
       {to_vector(part.residual.left_mm), to_vector(part.residual.right_mm)}},
      {},
      {},
      {},
      {}};
  for (const std::string& word : part.unknown_settings)
    surface.settings.push_back(*model::setting_from_name(word));
  surface.columns = {static_cast<Eigen::Index>(surface.settings.size()),
                     surface.residual.basis.size()};
  const Eigen::Index unknowns = surface.columns.total();
  surface.covariance_factor = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (Eigen::Index i = 0; i < unknowns; ++i) {
    const Numbers& row = part.covariance_factor[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j <= i; ++j)
      surface.covariance_factor(i, j) = row[static_cast<std::size_t>(j)];
  }
  if (part.lattice) {
    surface.lattice =
        LatticeResidual{part.lattice->x_nodes_mm,
                        part.lattice->y_nodes_mm,
                        {to_matrix(part.lattice->left_mm), to_matrix(part.lattice->right_mm)},
                        to_matrix(part.lattice->doubt_mm),
                        part.lattice->interpolation_sigma_mm};
  }
  return surface;
}

DirectPart part_of(const DirectSurface& surface) {
  return {surface.x_nodes_mm,
          surface.y_nodes_mm,
          to_lists(surface.lengths_mm.left),
          to_lists(surface.lengths_mm.right),
          surface.ends,
          surface.interpolation_sigma_mm};
}

DirectSurface surface_of(const DirectPart& part) {
  return {part.x_nodes_mm,
          part.y_nodes_mm,
          {to_matrix(part.left_mm), to_matrix(part.right_mm)},
          part.ends,
          part.interpolation_sigma_mm};
}

}  // namespace chaintrue::grid::files
