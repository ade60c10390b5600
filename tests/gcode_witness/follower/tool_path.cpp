// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/follower/tool_path.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::follower {
namespace {

/// The curvature of the tool's path is 1e-5 per mm at most: over 4 mm that is 2e-5 mm.
constexpr double kSampleMm = 4.0;

Place along(const Place& a, const Place& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

/// The position for chain lengths; empty if there is none.
std::optional<Place> tool(const Workshop& workshop, model::ChainLengths lengths, double z_mm) {
  const auto place = workshop.machine->tool(lengths);
  if (!place) return std::nullopt;
  return Place{place->x_mm, place->y_mm, z_mm};
}

/// Appends the tool's positions after the beginning of one command.
bool follow(const Workshop& workshop, const Place& from, const Place& to,
            std::vector<Place>& path) {
  const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
  const double piece_mm = workshop.chain_linear_piece_mm;
  const int pieces = piece_mm > 0.0 ? std::max(1, static_cast<int>(length / piece_mm)) : 1;
  const int samples = std::max(1, static_cast<int>(std::ceil(length / pieces / kSampleMm)));
  for (int i = 0; i < pieces; ++i) {
    const Place a = along(from, to, static_cast<double>(i) / pieces);
    const Place b = along(from, to, static_cast<double>(i + 1) / pieces);
    const auto first = workshop.controller->lengths({a[0], a[1]});
    const auto last = workshop.controller->lengths({b[0], b[1]});
    if (!first || !last) return false;
    for (int k = 1; k <= samples; ++k) {
      const double t = static_cast<double>(k) / samples;
      const Place place = along(a, b, t);
      model::ChainLengths lengths{first->left_mm + t * (last->left_mm - first->left_mm),
                                  first->right_mm + t * (last->right_mm - first->right_mm)};
      if (piece_mm == 0.0) {
        const auto here = workshop.controller->lengths({place[0], place[1]});
        if (!here) return false;
        lengths = *here;
      }
      const auto reached = tool(workshop, lengths, place[2]);
      if (!reached) return false;
      path.push_back(*reached);
    }
  }
  return true;
}

}  // namespace

std::optional<std::vector<Place>> tool_path(const Workshop& workshop,
                                            const std::vector<Place>& commands) {
  std::vector<Place> path;
  std::optional<Place> before;
  for (Place command : commands) {
    if (workshop.single_precision) {
      for (double& value : command) value = static_cast<double>(static_cast<float>(value));
    }
    if (!before) {
      const auto lengths = workshop.controller->lengths({command[0], command[1]});
      const auto start = lengths ? tool(workshop, *lengths, command[2]) : std::nullopt;
      if (!start) return std::nullopt;
      path.push_back(*start);
    } else if (!follow(workshop, *before, command, path)) {
      return std::nullopt;
    }
    before = command;
  }
  return path;
}

}  // namespace chaintrue::follower
