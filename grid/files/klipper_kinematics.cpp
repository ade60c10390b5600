// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/klipper_kinematics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace chaintrue::grid::files {
namespace {

// The text (Python) of a kinematics module of Klipper around its table. Private to grid/files.

/// Before the table.
constexpr std::string_view kModuleHead =
    R"py(# Kinematics for Klipper, written by chaintrue export klipper: {name}
#
# Chain lengths over the sheet. Put this file into klippy/kinematics, and say in printer.cfg
#
#   [printer]
#   kinematics: {module}
#   home_x: 0            # where the tool is when Klipper starts, and where G28 takes it to be
#   home_y: 0
#
# with a [stepper_left] and a [stepper_right]: step_pin, dir_pin, enable_pin, microsteps,
# rotation_distance (the chain's mm in a turn); and, of a machine that has one, a [stepper_z].
# X and Y are those of the sheet, in mm.
import math
import stepper

COLUMNS, ROWS = {columns}, {rows}
FIRST_X, FIRST_Y = {x:.6f}, {y:.6f}
STEP_X, STEP_Y = {step_x:.9f}, {step_y:.9f}
LEFT_ANCHOR = ({left_x:.4f}, {left_y:.4f})
RIGHT_ANCHOR = ({right_x:.4f}, {right_y:.4f})
# what straight distances from there are longer by than the chains, all over
LEFT_LONGER, RIGHT_LONGER = {left_longer:.4f}, {right_longer:.4f}
LONGEST_PIECE = {piece:.1f}

# [row from below][column from the left][left, right]
TABLE = (
)py";

constexpr std::string_view kModuleTail = R"py()

class OutsideMap(Exception):
    pass

def weights(t):
    return (0.5 * t * (-1. + t * (2. - t)),
            1. + 0.5 * t * t * (-5. + 3. * t),
            0.5 * t * (1. + t * (4. - 3. * t)),
            0.5 * t * t * (t - 1.))

def beyond(a, b, c):
    return tuple(3. * a[i] - 3. * b[i] + c[i] for i in (0, 1))

def node_in_row(row, column):
    if column < 0:
        return beyond(row[0], row[1], row[2])
    if column >= COLUMNS:
        return beyond(row[-1], row[-2], row[-3])
    return row[column]

def node(row, column):
    if row < 0:
        return beyond(*[node_in_row(TABLE[i], column) for i in (0, 1, 2)])
    if row >= ROWS:
        return beyond(*[node_in_row(TABLE[i], column) for i in (-1, -2, -3)])
    return node_in_row(TABLE[row], column)

# The lengths of both chains with the tool at x, y.
def lengths_at(x, y):
    u, v = (x - FIRST_X) / STEP_X, (y - FIRST_Y) / STEP_Y
    edge = 1e-9
    if not (-edge <= u <= COLUMNS - 1 + edge and -edge <= v <= ROWS - 1 + edge):
        raise OutsideMap()
    column = min(max(int(u), 0), COLUMNS - 2)
    row = min(max(int(v), 0), ROWS - 2)
    along_x, along_y = weights(u - column), weights(v - row)
    left = right = 0.
    for k in range(4):
        for i in range(4):
            there = node(row + k - 1, column + i - 1)
            share = along_y[k] * along_x[i]
            left += share * there[0]
            right += share * there[1]
    return left, right

# Where straight lines of these lengths from the anchors meet, below them.
def straight_place(left, right):
    dx, dy = RIGHT_ANCHOR[0] - LEFT_ANCHOR[0], RIGHT_ANCHOR[1] - LEFT_ANCHOR[1]
    apart = math.hypot(dx, dy)
    along = (left * left - right * right + apart * apart) / (2. * apart)
    square = left * left - along * along
    if square <= 0.:
        raise OutsideMap()
    below = math.sqrt(square)
    return (LEFT_ANCHOR[0] + (along * dx + below * dy) / apart,
            LEFT_ANCHOR[1] + (along * dy - below * dx) / apart)

# Where the steppers are to believe the tool to be when it is at x, y, z: a stepper counts its straight
# distance from the anchor, z included.
def commanded(x, y, z):
    left, right = lengths_at(x, y)
    left, right = left + LEFT_LONGER, right + RIGHT_LONGER
    return straight_place(math.sqrt(left * left - z * z), math.sqrt(right * right - z * z))

def counted(x, y, z):
    return [math.sqrt((x - a[0]) ** 2 + (y - a[1]) ** 2 + z * z) - longer
            for a, longer in ((LEFT_ANCHOR, LEFT_LONGER), (RIGHT_ANCHOR, RIGHT_LONGER))]

# Where the tool is for lengths, found from x, y on.
def tool_at(lengths, x, y):
    h = 0.01
    right_edge, upper_edge = FIRST_X + STEP_X * (COLUMNS - 1), FIRST_Y + STEP_Y * (ROWS - 1)
    x, y = min(max(x, FIRST_X), right_edge), min(max(y, FIRST_Y), upper_edge)
    for step in range(60):
        here = lengths_at(x, y)
        dl, dr = lengths[0] - here[0], lengths[1] - here[1]
        if max(abs(dl), abs(dr)) < 1e-8:
            return x, y
        side_x = h if x + h <= right_edge else -h
        side_y = h if y + h <= upper_edge else -h
        along, up = lengths_at(x + side_x, y), lengths_at(x, y + side_y)
        a, b = (along[0] - here[0]) / side_x, (up[0] - here[0]) / side_y
        c, d = (along[1] - here[1]) / side_x, (up[1] - here[1]) / side_y
        det = a * d - b * c
        if not det:
            break
        x = min(max(x + (d * dl - b * dr) / det, FIRST_X), right_edge)
        y = min(max(y + (a * dr - c * dl) / det, FIRST_Y), upper_edge)
    raise OutsideMap()

class ChaintrueKinematics:
    def __init__(self, toolhead, config):
        self.printer = config.get_printer()
        self.toolhead = toolhead
        self.steppers = []
        for name, anchor in (('stepper_left', LEFT_ANCHOR), ('stepper_right', RIGHT_ANCHOR)):
            s = stepper.PrinterStepper(config.getsection(name))
            s.setup_itersolve('winch_stepper_alloc', anchor[0], anchor[1], 0.)
            self.steppers.append(s)
        if config.has_section('stepper_z'):
            s = stepper.PrinterStepper(config.getsection('stepper_z'))
            s.setup_itersolve('cartesian_stepper_alloc', b'z')
            self.steppers.append(s)
        for s in self.steppers:
            s.set_trapq(toolhead.get_trapq())
            if hasattr(toolhead, 'register_step_generator'):
                toolhead.register_step_generator(s.generate_steps)
        self.home_x = config.getfloat('home_x', 0.)
        self.home_y = config.getfloat('home_y', 0.)
        try:
            self.home_place = commanded(self.home_x, self.home_y, 0.)
        except OutsideMap:
            raise config.error("home_x %.3f, home_y %.3f lie outside the map"
                               % (self.home_x, self.home_y))
        self.last = None
        self.next_transform = None
        self.axes_min = toolhead.Coord(FIRST_X, FIRST_Y, -1000., e=0.)
        self.axes_max = toolhead.Coord(FIRST_X + STEP_X * (COLUMNS - 1),
                                       FIRST_Y + STEP_Y * (ROWS - 1), 1000., e=0.)
        self.set_position([self.home_place[0], self.home_place[1], 0.], ())
        self.printer.register_event_handler('klippy:connect', self.handle_connect)
    def handle_connect(self):
        gcode_move = self.printer.lookup_object('gcode_move')
        self.next_transform = gcode_move.set_move_transform(self, force=True)
        if self.next_transform is None:
            self.next_transform = self.toolhead
        position = list(self.next_transform.get_position())
        position[0], position[1] = self.home_place
        self.toolhead.set_position(position)
    # Moves, in coordinates of the sheet
    def get_position(self):
        there = list(self.next_transform.get_position())
        if self.last is not None and self.last[1] == there[:3]:
            return list(self.last[0]) + there[3:]
        try:
            x, y = tool_at(counted(*there[:3]), there[0], there[1])
        except OutsideMap:
            raise self.printer.command_error("The tool is outside the map: home it first (G28)")
        return [x, y] + there[2:]
    def move(self, newpos, speed):
        start = self.get_position()
        length = math.hypot(newpos[0] - start[0], newpos[1] - start[1])
        pieces = max(1, int(math.ceil(length / LONGEST_PIECE - 1e-9)))
        places = []
        for i in range(1, pieces + 1):
            share = float(i) / pieces
            place = [s + share * (n - s) for s, n in zip(start, newpos)] if i < pieces else list(newpos)
            try:
                x, y = commanded(*place[:3])
            except OutsideMap:
                raise self.printer.command_error(
                    "Move to X%.3f Y%.3f: X%.3f Y%.3f lies outside the map"
                    % (newpos[0], newpos[1], place[0], place[1]))
            places.append((place, [x, y] + place[2:]))
        for place, there in places:
            self.next_transform.move(there, speed)
            self.last = (tuple(place[:3]), list(there[:3]))
    # What Klipper asks of kinematics
    def get_steppers(self):
        return list(self.steppers)
    def calc_position(self, stepper_positions):
        z = stepper_positions.get('stepper_z', 0.)
        left, right = stepper_positions['stepper_left'], stepper_positions['stepper_right']
        x, y = straight_place(math.sqrt(left * left - z * z), math.sqrt(right * right - z * z))
        return [x, y, z]
    def set_position(self, newpos, homing_axes):
        for s in self.steppers:
            s.set_position(newpos)
    def clear_homing_state(self, clear_axes):
        pass
    def home(self, homing_state):
        homing_state.set_axes([0, 1, 2])
        homing_state.set_homed_position([self.home_place[0], self.home_place[1], 0.])
    def check_move(self, move):
        pass
    def get_status(self, eventtime):
        return {'homed_axes': 'xyz', 'axis_minimum': self.axes_min, 'axis_maximum': self.axes_max}

def load_kinematics(toolhead, config):
    return ChaintrueKinematics(toolhead, config)
)py";

/// Same table, same bytes.
std::string klipper_source(const LengthTable& table, const StraightChains& straight,
                           double piece_mm, const std::string& name) {
  return with_table(
             kModuleHead, table, "chaintrue", name, fmt::arg("left_x", straight.anchors.left.x_mm),
             fmt::arg("left_y", straight.anchors.left.y_mm),
             fmt::arg("right_x", straight.anchors.right.x_mm),
             fmt::arg("right_y", straight.anchors.right.y_mm),
             fmt::arg("left_longer", straight.longer_mm.left_mm),
             fmt::arg("right_longer", straight.longer_mm.right_mm), fmt::arg("piece", piece_mm)) +
         table.nodes_as_text("(", ")") + std::string(kModuleTail);
}

/// Where straight lines of these lengths from the anchors meet, below them.
std::optional<BedPoint> straight_place(const StraightChains& straight, ChainLengths lengths) {
  const PerSide<BedPoint>& anchors = straight.anchors;
  for (const Side side : kSides) lengths[side] += straight.longer_mm[side];
  const double dx = anchors.right.x_mm - anchors.left.x_mm;
  const double dy = anchors.right.y_mm - anchors.left.y_mm;
  const double apart = std::hypot(dx, dy);
  const double along =
      (lengths.left_mm * lengths.left_mm - lengths.right_mm * lengths.right_mm + apart * apart) /
      (2.0 * apart);
  const double square = (lengths.left_mm - along) * (lengths.left_mm + along);
  if (!(square > 0.0)) return std::nullopt;
  const double below = std::sqrt(square);
  return BedPoint{anchors.left.x_mm + (along * dx + below * dy) / apart,
                  anchors.left.y_mm + (along * dy - below * dx) / apart};
}

/// The largest second derivative of the straight place by x or y, in 1/mm, from the table's nodes.
std::optional<double> largest_bend(const LengthTable& table, const StraightChains& straight) {
  const auto place = [&](int row, int column) {
    return straight_place(straight, {table.node(row, column, 0), table.node(row, column, 1)});
  };
  double largest = 0.0;
  for (const int row : each_below(table.rows)) {
    for (const int column : each_below(table.columns)) {
      const auto here = place(row, column);
      if (!here) return std::nullopt;
      const auto bend = [&](const std::optional<BedPoint>& a, const std::optional<BedPoint>& b,
                            double step_mm) {
        if (!a || !b) return 0.0;
        return std::hypot(a->x_mm - 2.0 * here->x_mm + b->x_mm,
                          a->y_mm - 2.0 * here->y_mm + b->y_mm) /
               (step_mm * step_mm);
      };
      if (column > 0 && column + 1 < table.columns)
        largest =
            std::max(largest, bend(place(row, column - 1), place(row, column + 1), table.step_x()));
      if (row > 0 && row + 1 < table.rows)
        largest =
            std::max(largest, bend(place(row - 1, column), place(row + 1, column), table.step_y()));
    }
  }
  return largest;
}

/// A straight piece of the length s bows by s^2 / 8 of the bend, which may be twice what nodes show.
double piece_for(double bend_per_mm) {
  constexpr double kShortestMm = 1.0, kLongestMm = 20.0, kSafety = 2.0;
  const double longest = std::sqrt(8.0 * kTableErrorMm / std::max(kSafety * bend_per_mm, 1e-12));
  return std::clamp(std::floor(10.0 * longest) / 10.0, kShortestMm, kLongestMm);
}

}  // namespace

tl::expected<KlipperKinematics, MapFailure> klipper_kinematics(const LengthMap& map,
                                                               const StraightChains& straight,
                                                               const std::string& name) {
  const auto table = length_table(map);
  if (!table) return failed(table);
  const auto bend = largest_bend(*table, straight);
  if (!bend) return tl::unexpected(MapReason::unreachable);
  const double piece_mm = piece_for(*bend);
  return KlipperKinematics{{*table, klipper_source(*table, straight, piece_mm, name)}, piece_mm};
}

}  // namespace chaintrue::grid::files
