// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A measured session of a machine of tests/lab/generator, by any way of measuring, and the
/// messages on reading its file. The machine differs from its stated values by usual amounts, and
/// every second one has an effect.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "grid/belts/measured_belts.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/observation/measured_holes.hpp"

namespace chaintrue::slips {

enum class Way { commands, lengths, holes, belts };
inline constexpr Way kWays[] = {Way::commands, Way::lengths, Way::holes, Way::belts};
std::string_view word(Way way);

using Session = std::variant<grid::MeasuredGrid, grid::MeasuredHoles, grid::MeasuredBelts>;

/// As a person writes it down: marks and lengths to 0.1 mm, a tape to 0.5 mm. Of commands and
/// lengths the last six of 34 points are second visits.
Session clean_session(Way way, std::uint64_t seed);

struct Reported {
  std::vector<std::string> messages;  ///< problems and warnings, with their places
  bool is_refused = false;
};
/// The session is written to a file and read.
Reported reported_of(const Session& session);

}  // namespace chaintrue::slips
