// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/linuxcnc_kinematics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace chaintrue::grid::files {
namespace {

using Lengths = std::array<double, 2>;

/// The beginning of the source, before its table.
constexpr std::string_view kHead = R"(/* Kinematics for LinuxCNC, written by chaintrue export linuxcnc: {name}
 *
 * Chain lengths over the sheet. Joints 0 and 1 are the lengths of the left and the right chain, joint 2 is
 * z, in mm; x and y are those of the sheet. Build and install it with
 *
 *   halcompile --install {module}.c
 *
 * and say in the machine's INI file [KINS] KINEMATICS = {module}, JOINTS = 3.
 */
#include "rtapi.h"
#include "rtapi_app.h"
#include "hal.h"
#include "kinematics.h"

enum {{ COLUMNS = {columns}, ROWS = {rows} }};
static const double first_x = {x:.6f}, first_y = {y:.6f};
static const double step_x = {step_x:.9f}, step_y = {step_y:.9f};

/* [row from below][column from the left][left, right] */
static const double table[ROWS][COLUMNS][2] = {{
)";

constexpr std::string_view kTail = R"(};

static double node_in_row(int row, int column, int side)
{
    if (column < 0)
        return 3.0 * table[row][0][side] - 3.0 * table[row][1][side] + table[row][2][side];
    if (column >= COLUMNS)
        return 3.0 * table[row][COLUMNS - 1][side] - 3.0 * table[row][COLUMNS - 2][side]
            + table[row][COLUMNS - 3][side];
    return table[row][column][side];
}

static double node(int row, int column, int side)
{
    if (row < 0)
        return 3.0 * node_in_row(0, column, side) - 3.0 * node_in_row(1, column, side)
            + node_in_row(2, column, side);
    if (row >= ROWS)
        return 3.0 * node_in_row(ROWS - 1, column, side) - 3.0 * node_in_row(ROWS - 2, column, side)
            + node_in_row(ROWS - 3, column, side);
    return node_in_row(row, column, side);
}

static double between(const double p[4], double t)
{
    return p[1] + 0.5 * t * (p[2] - p[0]
        + t * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]
            + t * (3.0 * (p[1] - p[2]) + p[3] - p[0])));
}

/* Returns -1 outside the table. */
static int lengths_at(double x, double y, double lengths[2])
{
    const double u = (x - first_x) / step_x, v = (y - first_y) / step_y;
    const double edge = 1e-9;
    int column, row, side, i, k;
    if (!(u >= -edge && u <= COLUMNS - 1 + edge && v >= -edge && v <= ROWS - 1 + edge))
        return -1;
    column = u > 0.0 ? (int)u : 0;
    row = v > 0.0 ? (int)v : 0;
    if (column > COLUMNS - 2)
        column = COLUMNS - 2;
    if (row > ROWS - 2)
        row = ROWS - 2;
    for (side = 0; side < 2; ++side) {
        double along_y[4];
        for (k = 0; k < 4; ++k) {
            double along_x[4];
            for (i = 0; i < 4; ++i)
                along_x[i] = node(row + k - 1, column + i - 1, side);
            along_y[k] = between(along_x, u - column);
        }
        lengths[side] = between(along_y, v - row);
    }
    return 0;
}

int kinematicsInverse(const EmcPose *world, double *joints,
                      const KINEMATICS_INVERSE_FLAGS *iflags, KINEMATICS_FORWARD_FLAGS *fflags)
{
    (void)iflags;
    (void)fflags;
    joints[2] = world->tran.z;
    return lengths_at(world->tran.x, world->tran.y, joints);
}

int kinematicsForward(const double *joints, EmcPose *world,
                      const KINEMATICS_FORWARD_FLAGS *fflags, KINEMATICS_INVERSE_FLAGS *iflags)
{
    double x = world->tran.x, y = world->tran.y, here[2];
    const double h = 0.01, enough = 1e-7;
    int step;
    (void)fflags;
    (void)iflags;
    if (lengths_at(x, y, here) != 0) {
        x = first_x + 0.5 * step_x * (COLUMNS - 1);
        y = first_y + 0.5 * step_y * (ROWS - 1);
    }
    for (step = 0; step < 40; ++step) {
        double right[2], up[2], a, b, c, d, det, dl, dr, side_x, side_y;
        if (lengths_at(x, y, here) != 0)
            return -1;
        dl = joints[0] - here[0];
        dr = joints[1] - here[1];
        if (dl < enough && dl > -enough && dr < enough && dr > -enough) {
            world->tran.x = x;
            world->tran.y = y;
            world->tran.z = joints[2];
            world->a = world->b = world->c = world->u = world->v = world->w = 0.0;
            return 0;
        }
        side_x = x + h <= first_x + step_x * (COLUMNS - 1) ? h : -h;
        side_y = y + h <= first_y + step_y * (ROWS - 1) ? h : -h;
        if (lengths_at(x + side_x, y, right) != 0 || lengths_at(x, y + side_y, up) != 0)
            return -1;
        a = (right[0] - here[0]) / side_x;
        b = (up[0] - here[0]) / side_y;
        c = (right[1] - here[1]) / side_x;
        d = (up[1] - here[1]) / side_y;
        det = a * d - b * c;
        if (det == 0.0)
            return -1;
        x += (d * dl - b * dr) / det;
        y += (a * dr - c * dl) / det;
    }
    return -1;
}

KINEMATICS_TYPE kinematicsType(void) { return KINEMATICS_BOTH; }

KINS_NOT_SWITCHABLE
EXPORT_SYMBOL(kinematicsType);
EXPORT_SYMBOL(kinematicsForward);
EXPORT_SYMBOL(kinematicsInverse);
MODULE_LICENSE("GPL");

static int component;

int rtapi_app_main(void)
{
    component = hal_init("chaintrue_kins");
    if (component < 0)
        return component;
    hal_ready(component);
    return 0;
}

void rtapi_app_exit(void) { hal_exit(component); }
)";

/// Lengths at the nodes of a lattice.
struct Table {
  interp::Rectangle area;
  int columns = 0;
  int rows = 0;
  std::vector<Lengths> nodes;  ///< row by row from below

  [[nodiscard]] double step_x() const { return (area.x_max - area.x_min) / (columns - 1); }
  [[nodiscard]] double step_y() const { return (area.y_max - area.y_min) / (rows - 1); }
  [[nodiscard]] double x(double column) const { return area.x_min + column * step_x(); }
  [[nodiscard]] double y(double row) const { return area.y_min + row * step_y(); }

  /// With one more beyond every edge (Keys, eq. 25).
  [[nodiscard]] double node(int row, int column, std::size_t side) const {
    const auto beyond = [](double a, double b, double c) { return 3.0 * a - 3.0 * b + c; };
    if (column < 0) return beyond(node(row, 0, side), node(row, 1, side), node(row, 2, side));
    if (column >= columns) {
      return beyond(node(row, columns - 1, side),
                    node(row, columns - 2, side),
                    node(row, columns - 3, side));
    }
    if (row < 0) return beyond(node(0, column, side), node(1, column, side), node(2, column, side));
    if (row >= rows) {
      return beyond(
          node(rows - 1, column, side), node(rows - 2, column, side), node(rows - 3, column, side));
    }
    return nodes[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)][side];
  }
};

/// Keys, eq. 4.
double between(const std::array<double, 4>& p, double t) {
  return p[1] + 0.5 * t *
                    (p[2] - p[0] + t * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3] +
                                        t * (3.0 * (p[1] - p[2]) + p[3] - p[0])));
}

double interpolated(const Table& table, double column, double row, std::size_t side) {
  const int i = std::min(static_cast<int>(column), table.columns - 2);
  const int k = std::min(static_cast<int>(row), table.rows - 2);
  std::array<double, 4> along_y{};
  for (int up = 0; up < 4; ++up) {
    std::array<double, 4> along_x{};
    for (int right = 0; right < 4; ++right)
      along_x[static_cast<std::size_t>(right)] = table.node(k + up - 1, i + right - 1, side);
    along_y[static_cast<std::size_t>(up)] = between(along_x, column - i);
  }
  return between(along_y, row - k);
}

tl::expected<Table, MapFailure> tabulated(const LengthMap& map, double spacing_mm) {
  constexpr int kFewest = 4;  // what a cubic goes through
  Table table{map.domain()};
  const auto count = [&](double extent) {
    return std::max(kFewest, 1 + static_cast<int>(std::ceil(extent / spacing_mm - 1e-9)));
  };
  table.columns = count(table.area.x_max - table.area.x_min);
  table.rows = count(table.area.y_max - table.area.y_min);
  for (int row = 0; row < table.rows; ++row) {
    for (int column = 0; column < table.columns; ++column) {
      const auto lengths = map.lengths({table.x(column), table.y(row)});
      if (!lengths) return tl::unexpected(lengths.error());
      table.nodes.push_back({lengths->left_mm, lengths->right_mm});
    }
  }
  return table;
}

tl::expected<double, MapFailure> largest_error(const LengthMap& map, const Table& table) {
  double largest = 0.0;
  for (int row = 0; row + 1 < table.rows; ++row) {
    for (int column = 0; column + 1 < table.columns; ++column) {
      for (const auto& [right, up] : {std::pair{0.5, 0.5}, std::pair{0.5, 0.0}, std::pair{0.0, 0.5}}) {
        const auto lengths = map.lengths({table.x(column + right), table.y(row + up)});
        if (!lengths) return tl::unexpected(lengths.error());
        largest = std::max(
            {largest,
             std::abs(interpolated(table, column + right, row + up, 0) - lengths->left_mm),
             std::abs(interpolated(table, column + right, row + up, 1) - lengths->right_mm)});
      }
    }
  }
  return largest;
}

std::string source_of(const Table& table, const std::string& name) {
  std::string plain = name;
  // A name must not end the comment that it is in.
  std::replace(plain.begin(), plain.end(), '*', ' ');
  for (char& c : plain) c = static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  std::string text = fmt::format(fmt::runtime(kHead),
                                 fmt::arg("name", plain),
                                 fmt::arg("module", "chaintrue_kins"),
                                 fmt::arg("columns", table.columns),
                                 fmt::arg("rows", table.rows),
                                 fmt::arg("x", table.area.x_min),
                                 fmt::arg("y", table.area.y_min),
                                 fmt::arg("step_x", table.step_x()),
                                 fmt::arg("step_y", table.step_y()));
  for (int row = 0; row < table.rows; ++row) {
    text += "    {";
    for (int column = 0; column < table.columns; ++column) {
      text += fmt::format("{}{{{:.5f}, {:.5f}}}",
                          column == 0 ? "" : column % 4 == 0 ? ",\n     " : ", ",
                          table.node(row, column, 0),
                          table.node(row, column, 1));
    }
    text += "},\n";
  }
  return text + std::string(kTail);
}

}  // namespace

tl::expected<LinuxcncKinematics, MapFailure> linuxcnc_kinematics(const LengthMap& map,
                                                                 const std::string& name) {
  // A map bends least over the bed, and some centimetres next to a bump of its surface.
  constexpr double kWidestMm = 80.0, kNarrowestMm = 5.0;
  for (double spacing_mm = kWidestMm;; spacing_mm *= 0.5) {
    const auto table = tabulated(map, spacing_mm);
    if (!table) return tl::unexpected(table.error());
    const auto error = largest_error(map, *table);
    if (!error) return tl::unexpected(error.error());
    if (*error > kTableErrorMm && spacing_mm > kNarrowestMm) continue;
    return LinuxcncKinematics{source_of(*table, name),
                              table->columns,
                              table->rows,
                              std::max(table->step_x(), table->step_y()),
                              *error};
  }
}

}  // namespace chaintrue::grid::files
