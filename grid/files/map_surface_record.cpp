// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/records.hpp"
#include "interp/eigen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "grid/containers.hpp"
#include "grid/files/names.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {

RECORD_OF(interp::Rectangle, "a rectangle in mm")
REQUIRED(x_min, "Left edge.", kPlaceMm)
REQUIRED(x_max, "Right edge.", kPlaceMm)
REQUIRED(y_min, "Lower edge.", kPlaceMm)
REQUIRED(y_max, "Upper edge.", kPlaceMm).check([](const Cursor& at, interp::Rectangle& r) {
  if (at.clean() && !(r.width() > 0.0 && r.height() > 0.0)) {
    at.expect("a rectangle whose maxima exceed its minima");
  }
}) END_RECORD;

namespace {

using Numbers = std::vector<double>;

struct SplinePart {
  interp::Rectangle rectangle;
  int x_intervals = 0;
  int y_intervals = 0;
  PerSide<double> scale;
  PerSide<VectorXd> coefficients_mm;
};

/// A ModelSurface as its file has it: the basis by its intervals, and the triangle alone of the
/// covariance.
struct ModelPart {
  Machine machine;
  SheetPlacement sheet;
  std::vector<Setting> settings;
  SplinePart residual;
  std::vector<Numbers> covariance_factor;
  std::optional<LatticeResidual> lattice;
};

auto sheet_placement_record() {
  RECORD(SheetPlacement, "a sheet's placement")
  FIELD(place, "x of the marks' origin on the bed.", "y of the marks' origin on the bed, up.",
        kPlaceMm)
  REQUIRED(rotation_rad, "Rotation of the marks, counter-clockwise.", {"rad", -7.0, 7.0});
}

RECORD_OF(SplinePart, "a residual surface")
NAMED(required, "rectangle_mm", rectangle, "Where the splines are defined.")
REQUIRED(x_intervals, "Equal intervals along x.", integer(1, 1000))
REQUIRED(y_intervals, "Equal intervals along y.", integer(1, 1000))
NESTED(required, "scale_left", scale, left, "Correction of the left chain per mm of length.",
       {"", -0.1, 0.1})
NESTED(required, "scale_right", scale, right, "Correction of the right chain per mm of length.",
       {"", -0.1, 0.1})
NESTED(required, "coefficients_left_mm", coefficients_mm, left,
       "Coefficients of cubic B-splines for the left chain, y varying fastest: "
       "(x_intervals + 3) (y_intervals + 3) values.",
       vector_of_numbers())
NESTED(required, "coefficients_right_mm", coefficients_mm, right,
       "Coefficients for the right chain, in the same order.", vector_of_numbers())
    .check([](const Cursor& at, SplinePart& part) {
      if (!at.clean()) return;
      const Index size = (part.x_intervals + 3) * (part.y_intervals + 3);
      const std::string expected = fmt::format("{} coefficients, as the intervals require", size);
      const auto& [left, right] = part.coefficients_mm;
      if (left.size() != size) at.child("coefficients_left_mm").expect(expected);
      if (right.size() != size) at.child("coefficients_right_mm").expect(expected);
    }) END_RECORD;

void check_model_part(const Cursor& at, ModelPart& part) {
  if (!at.clean()) return;
  const std::size_t unknowns =
      part.settings.size() + 2 + as_size(part.residual.coefficients_mm.left.size()) * 2;
  bool triangle = part.covariance_factor.size() == unknowns;
  for (std::size_t i = 0; triangle && i < unknowns; ++i)
    triangle = part.covariance_factor[i].size() == i + 1;
  if (!triangle) {
    at.child("covariance_factor")
        .expect(
            fmt::format("the {} rows of a lower triangle, of 1 to {} numbers", unknowns, unknowns));
  }
}

RECORD_OF(interp::AxisEnds, "the conditions at both ends of an axis")
REQUIRED(low, "At the smaller end.", in_order<interp::EndCondition>(kEndConditions))
REQUIRED(high, "At the larger end.", in_order<interp::EndCondition>(kEndConditions))
END_RECORD;

RECORD_OF(interp::TensorEnds, "the conditions at the edges")
REQUIRED(x, "Along x.")
REQUIRED(y, "Along y.")
END_RECORD;

bool rises(const Numbers& values) {
  return std::adjacent_find(values.begin(), values.end(),
                            [](double a, double b) { return !(a < b); }) == values.end();
}

struct NodeValues {
  const char* key;
  const MatrixXd* values;
};

/// Checks that nodes increase, and that there are as many values as nodes.
template <class Surface>
void check_nodes(const Cursor& at, const Surface& surface,
                 std::initializer_list<NodeValues> values) {
  if (!at.clean()) return;
  if (!rises(surface.x_nodes_mm)) at.child("x_nodes_mm").expect("increasing numbers");
  if (!rises(surface.y_nodes_mm)) at.child("y_nodes_mm").expect("increasing numbers");
  const std::size_t columns = surface.x_nodes_mm.size();
  const std::size_t rows = surface.y_nodes_mm.size();
  for (const NodeValues& own : values) {
    if (as_size(own.values->rows()) != columns || as_size(own.values->cols()) != rows)
      at.child(own.key).expect(
          fmt::format("{} lists of {} lengths, one list for each x", columns, rows));
  }
}

/// The nodes, and the chains at each of them.
template <class Surface>
void node_keys(Record<Surface>& record, PerSide<MatrixXd> Surface::*chains) {
  const auto values = matrix_of_numbers(kAnyNumber, 2);
  record
      .required("x_nodes_mm", "Nodes along x, increasing.", &Surface::x_nodes_mm,
                list(kAnyNumber, 2))
      .required("y_nodes_mm", "Nodes along y, increasing.", &Surface::y_nodes_mm,
                list(kAnyNumber, 2))
      .required("left_mm", "Left chain at every node: one list for each x.",
                path(chains, &PerSide<MatrixXd>::left), values)
      .required("right_mm", "Right chain at every node.", path(chains, &PerSide<MatrixXd>::right),
                values);
}

constexpr const char* kBetweenNodes = "Error of the splines between nodes, 1 sigma.";

RECORD_OF(LatticeResidual, "splines through the residuals at every node")
ALSO(node_keys, &LatticeResidual::values_mm)
REQUIRED(doubt_mm, "Uncertainty of the value at each node.", matrix_of_numbers(kNotNegative, 2))
REQUIRED(interpolation_sigma_mm, kBetweenNodes, kNotNegative)
    .check([](const Cursor& at, LatticeResidual& own) {
      check_nodes(at, own,
                  {{"left_mm", &own.values_mm.left},
                   {"right_mm", &own.values_mm.right},
                   {"doubt_mm", &own.doubt_mm}});
    }) END_RECORD;

double seven_digits(double value) { return number_of(fmt::format("{:.7g}", value)).value(); }

auto model_part_record() {
  RECORD(ModelPart, "a surface on a machine")
  REQUIRED(machine, "The calibrated machine.", machine_record())
  REQUIRED(sheet, "Placement of the marks' sheet.", sheet_placement_record())
  NAMED(required, "unknown_settings", settings,
        "The settings that were calibrated, in the order of the covariance.", list(setting_word()))
  REQUIRED(residual, "Correction added to the machine's lengths.")
  REQUIRED(covariance_factor,
           "Triangular root of the covariance of settings, scales and coefficients; lower "
           "triangle, row by row.",
           list(list(kAnyNumber, 1)))
  OPTIONAL(lattice, "For a full grid of marks: splines through the residuals at every node.")
      .check(check_model_part);
}

auto direct_surface_record() {
  RECORD(DirectSurface, "splines through the lengths")
  ALSO(node_keys, &DirectSurface::lengths_mm)
  REQUIRED(ends, "End conditions of the splines.")
  REQUIRED(interpolation_sigma_mm, kBetweenNodes, kNotNegative)
      .check([](const Cursor& at, DirectSurface& own) {
        check_nodes(at, own,
                    {{"left_mm", &own.lengths_mm.left}, {"right_mm", &own.lengths_mm.right}});
      });
}

ModelPart part_of(const ModelSurface& surface) {
  const auto& [basis, scale, coefficients] = surface.residual;
  ModelPart part{surface.machine,
                 surface.sheet,
                 surface.settings,
                 {basis.rectangle(), as_int(basis.columns_x()) - 3, as_int(basis.columns_y()) - 3,
                  scale, coefficients},
                 {},
                 surface.lattice};
  for (Index i = 0; i < surface.covariance_factor.rows(); ++i) {
    Numbers& row = part.covariance_factor.emplace_back();
    for (Index j = 0; j <= i; ++j) row.push_back(seven_digits(surface.covariance_factor(i, j)));
  }
  return part;
}

ModelSurface surface_of(const ModelPart& part) {
  const SplinePart& own = part.residual;
  const interp::BsplineBasis basis(own.rectangle, own.x_intervals, own.y_intervals);
  const FitColumns columns{as_index(part.settings.size()), basis.size()};
  ModelSurface surface{
      part.machine, part.sheet,    {basis, own.scale, own.coefficients_mm},
      columns,      part.settings, MatrixXd::Zero(columns.total(), columns.total()),
      part.lattice};
  for (const auto i : each_index(part.covariance_factor)) {
    const Numbers& row = part.covariance_factor[i];
    surface.covariance_factor.row(as_index(i)).head(as_index(row.size())) =
        Eigen::Map<const RowVectorXd>(row.data(), as_index(row.size()));
  }
  return surface;
}

/// Null if the map has the other kind of surface.
template <class Surface>
const Surface* surface_in(const MapContents& map) {
  return std::get_if<Surface>(&map.surface);
}

}  // namespace

void add_surface(Record<MapContents>& record) {
  record
      .computed(
          "on_machine", "A calibrated machine with residual surfaces; or direct.", false,
          object(model_part_record()),
          [](MapContents& map, const ModelPart& part) { map.surface = surface_of(part); },
          [](const MapContents& map) {
            const auto* own = surface_in<ModelSurface>(map);
            return own != nullptr ? std::optional(part_of(*own)) : std::nullopt;
          })
      .computed("direct", "Splines through the lengths, without a machine; or on_machine.", false,
                object(direct_surface_record()), &MapContents::surface, [](const MapContents& map) {
                  const auto* own = surface_in<DirectSurface>(map);
                  return own != nullptr ? std::optional(*own) : std::nullopt;
                });
}

}  // namespace chaintrue::grid::files
