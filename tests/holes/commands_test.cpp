// SPDX-License-Identifier: GPL-3.0-or-later
// A list of holes that is planned, cut and taped; and tapes to the edges of a sheet that lies askew.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <sstream>

#include "grid/files/holes_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tests/cli/command_fixture.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue {
namespace {

using testing_support::content_of;
using testing_support::Outcome;

class HolesCommands : public testing_support::CommandFixture {
 protected:
  const std::string classic_ = CHAINTRUE_FIXTURES "/machines/classic.json";
};

TEST_F(HolesCommands, APlannedListFilledInGoesIntoFitAsItIs) {
  done("plan --machine " + classic_ + " --holes 9 --edges --tape-sigma-mm 0.5 -o list.csv");
  // The owner cuts the holes of the list on a sheet that lies 6 mm to the right, and writes the
  // tape's readings into the third column.
  const std::string list = content_of(folder_ / "list.csv");
  grid::files::MeasuredOptions with_machine;
  with_machine.machine = grid::files::read(grid::files::parse_machine, classic_).machine;
  const auto with_readings = [&list](const std::function<std::string(const std::string&)>& read) {
    std::istringstream lines(list);
    std::string filled;
    bool in_distances = false;
    for (std::string line; std::getline(lines, line);) {
      const std::size_t blank = line.find(",,");
      if (in_distances && blank != std::string::npos)
        line.insert(blank + 1, read(line.substr(blank + 2)));
      in_distances = in_distances || line.starts_with("from,");
      filled += line + "\n";
    }
    return filled;
  };
  const grid::files::ReadHoles planned = grid::files::parse_holes(
      with_readings([](const std::string& as_commanded) { return as_commanded; }), "list.csv",
      with_machine);
  grid::synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.sheet.x_mm = 6.0;
  spec.rounding_mm = 0.5;
  spec.seed = 4;
  const auto made = grid::synthetic::simulate_holes(planned.holes, spec);
  ASSERT_TRUE(made);
  std::size_t reading = 0;
  write("readings.csv", with_readings([&](const std::string&) {
          return fmt::format("{:.1f}", made->set.distances.at(reading++).distance_mm);
        }));
  ASSERT_EQ(reading, made->set.distances.size());
  done("fit readings.csv --machine " + classic_ + " -o map.json");
  done("check map.json readings.csv --machine " + classic_);
  const grid::CompensationMap map = grid::files::read(grid::files::parse_map, folder_ / "map.json");
  // Half a millimetre of tape and of the sheet's size; three times that would be a gross error.
  EXPECT_LT(testing_support::tool_rms_mm(map, made->truth, spec.sheet), 1.5);
}

TEST_F(HolesCommands, SimulateMeasuresToTheEdgesOfASkewedSheet) {
  ASSERT_EQ(run("simulate --machine " + classic_ +
                " --holes 9 --edges --offset sheet_x_mm=20 --tape-sigma-mm 0.01 --hole-sigma-mm 0 "
                "-o holes.json")
                .code,
            0);
  const grid::files::ReadHoles made =
      grid::files::read(grid::files::parse_holes, folder_ / "holes.json");
  int edges = 0;
  for (const grid::HoleDistance& distance : made.holes.distances) {
    if (!distance.edge) continue;
    ++edges;
    const double longer = distance.edge == grid::SheetEdge::right  ? 20.0
                          : distance.edge == grid::SheetEdge::left ? -20.0
                                                                   : 0.0;
    EXPECT_NEAR(distance.distance_mm - commanded_mm(made.holes, distance), longer, 0.05)
        << "five sigmas of the tape";
  }
  EXPECT_GT(edges, 3);
}

}  // namespace
}  // namespace chaintrue
