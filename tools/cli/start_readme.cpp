// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/start_readme.hpp"

#include <fmt/format.h>

namespace chaintrue::cli {
namespace {

constexpr std::string_view kKeys[][2] = {
    {"bed", "the sheet that the machine can cut, in mm; zero is its middle, x right, y up"},
    {"motors", "where the motors' axes are, from that zero; to a few mm is enough"},
    {"sprocket", "teeth on a motor, and the chain's pitch: 10 and 6.35 mm on every Maslow"},
    {"feed", "over_top where the chains leave over the sprockets' tops, else off_bottom"},
    {"attachment",
     "{\"kind\": \"ring\", \"radius_mm\": from the bit to a chain's end}, or {\"kind\": "
     "\"brackets\", \"spacing_mm\", \"height_mm\", \"cg_below_bit_mm\"}"},
    {"chain", "its mass and its stretch per newton; keep the defaults if unknown"},
    {"sled", "the sled's weight with its router, in kg; a bathroom scale is accurate enough"},
    {"frame", "how far the frame leans back, in degrees"},
    {"uncertainty", "uncertainty of the motors, the chains' zeros and the ring, 1 sigma"},
    {"controller",
     "the firmware's settings: {\"kind\": \"maslow_classic\", \"settings\": {GroundControl's own "
     "names: motorspacingx, motoroffsety, rotationradius, chainsagcorrection, ...}}"},
};

}  // namespace

std::vector<std::string> template_comments() {
  std::vector<std::string> comments = {
      "A classic Maslow. Enter your machine's numbers; every key is explained here."};
  for (const auto& [key, meaning] : kKeys) comments.push_back(fmt::format("{}: {}", key, meaning));
  return comments;
}

std::string template_readme(const std::string& machine_path) {
  std::string text = "machine.json describes a classic Maslow. Enter your numbers:\n\n";
  for (const auto& [key, meaning] : kKeys) text += fmt::format("  {:<13}{}\n", key, meaning);
  return text + fmt::format(
                    "\nThen make the sheets to print:\n\n    chaintrue start {}\n\nIf "
                    "GroundControl, WebControl or FluidNC runs the machine, chaintrue reads its "
                    "settings file instead:\n\n    chaintrue start groundcontrol.ini\n",
                    machine_path);
}

std::string start_readme(const Machine& machine, const StartWays& ways) {
  const bool settings = machine.controller.settings.motor_spacing_mm.has_value();
  return fmt::format(
      R"({0}: what lies here, and what to do with it.

  machine.json   the machine as its settings describe it
  marks.html     28 marks on a page to print, four of them twice, with lines to write on
  marks.csv      the list that the readings are typed into
  marks.nc       a program that drives to the marks and drills them
  holes.html, holes.csv, holes.nc
                 the same with nine holes and a tape

1. Choose a way to measure.

   Marks, for whoever has an evening and a square: the tool is sent to 28 marks, and x and y of
   each are measured from the sheet's middle lines. Four of them come a second time, a little to
   the side: they cost ten minutes and show whether the machine changed meanwhile (a chain that
   jumped a tooth, a zero that moved). To half a millimetre each, the tool will then be known to
   about {1:.1f} mm over the bed.
   Holes, for whoever has an hour and a tape: nine holes and twenty distances, about {2:.1f} mm,
   for the best placement of the sheet.
   Chain lengths, for whoever can read them off the machine: chaintrue plan --machine machine.json
   --measure lengths -o lengths.csv. It is the way that tells causes apart best.

2. Print marks.html (or holes.html), run marks.nc, measure, and type what you read into marks.csv
   with an editor or a spreadsheet. What you leave empty is left out.

3. Make the map:

       chaintrue fit marks.csv --machine machine.json -o map.json

4. Cut with it: rewrite each program,

       chaintrue gcode compensate part.nc --map map.json -o part.true.nc
{3}
5. See why the machine errs:

       chaintrue diagnose marks.csv --machine machine.json --noise-length-mm 0.1 --noise-position-mm 0.5 -o diagnosis.json --report diagnosis.html
)",
      machine.name.empty() ? "Your machine" : machine.name,
      ways.marks_mm,
      ways.holes_mm,
      settings ? R"(
   or type better numbers in once:

       chaintrue export groundcontrol map.json --map-after map.after.json

   From then on map.after.json is the map that is right, to check the machine with and, where you
   want what no number can mend, to rewrite programs with.
)"
               : "");
}

}  // namespace chaintrue::cli
