// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/linuxcnc_kinematics.hpp"

#include <algorithm>
#include <string_view>

namespace chaintrue::grid::files {
namespace {

// The text (C) of a kinematics module of LinuxCNC around its table. Private to grid/files.

/// Before the table.
constexpr std::string_view kHead =
    R"(/* Kinematics for LinuxCNC, written by chaintrue export linuxcnc: {name}
 *
 * Chain lengths over the sheet. Joints 0 and 1 are the lengths of the left and the right chain, joint 2 is
 * z, in mm; x and y are those of the sheet. Build and install it with
 *
 *   halcompile --install {module}.c
 *
 * and say in the machine's INI file [KINS] KINEMATICS = {module} and JOINTS = 3, [TRAJ] LINEAR_UNITS = mm: all
 * lengths are millimetres. For LinuxCNC 2.9 and later.
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

/* The nearest value of the table. */
static double into(double value, double first, double extent)
{
    if (value < first)
        return first;
    return value > first + extent ? first + extent : value;
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
    for (step = 0; step < 60; ++step) {
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
        x = into(x + (d * dl - b * dr) / det, first_x, step_x * (COLUMNS - 1));
        y = into(y + (a * dr - c * dl) / det, first_y, step_y * (ROWS - 1));
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
    component = hal_init("%MODULE%");
    if (component < 0)
        return component;
    hal_ready(component);
    return 0;
}

void rtapi_app_exit(void) { hal_exit(component); }
)";

/// Same table, same bytes.
std::string linuxcnc_source(const LengthTable& table, const LinuxcncNames& names) {
  std::string map = names.map;
  // It must not end the comment that it is in.
  std::replace(map.begin(), map.end(), '*', ' ');
  std::string tail(kTail);
  constexpr std::string_view kModule = "%MODULE%";
  tail.replace(tail.find(kModule), kModule.size(), names.module);
  return with_table(kHead, table, names.module, std::move(map)) + table.nodes_as_text("{", "}") +
         tail;
}

}  // namespace

tl::expected<TableModule, MapFailure> linuxcnc_kinematics(const LengthMap& map,
                                                          const LinuxcncNames& names) {
  const auto table = length_table(map);
  if (!table) return failed(table);
  return TableModule{*table, linuxcnc_source(*table, names)};
}

}  // namespace chaintrue::grid::files
