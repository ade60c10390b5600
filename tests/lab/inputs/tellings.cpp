// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/lab/inputs/tellings.hpp"

#include <string>

#include "tests/lab/inputs/log_server.hpp"

namespace chaintrue::inputs {
namespace {

constexpr const char* kCheckOfCommands =
    "check @map.json @commanded.csv --machine @classic.json --noise-length-mm 0.2 --noise-position-mm 0.3";

const std::string& listening_line() {
  static const std::string line =
      "maslow4 --host 127.0.0.1 --port " + std::to_string(log_server_port()) + " --telnet -o log.txt";
  return line;
}
/// By websocket, to something that is none.
const std::string& websocket_line() {
  static const std::string line =
      "maslow4 --host 127.0.0.1 --port " + std::to_string(log_server_port()) + " -o log.txt";
  return line;
}
const std::string& mute_line() {
  static const std::string line = "maslow4 --host 127.0.0.1 --port " +
                                  std::to_string(mute_server_port()) + " --patience-s 0.4 -o log.txt";
  return line;
}

}  // namespace

const std::vector<Invocation>& calls_with_options() {
  static const std::vector<Invocation> all = [] {
    std::vector<Invocation> calls = invocations();
    calls.push_back({"maslow4", "machine", cli::facts::connected, listening_line().c_str()});
    return calls;
  }();
  return all;
}

std::string then_of(const Invocation& call) {
  if (std::string_view(call.verb) != "fit" || (call.facts & (cli::facts::grid | cli::facts::holes)) == 0)
    return "";
  if ((call.facts & cli::facts::direct) != 0)
    return "query map.json 0 0 700 300 350 -150 1200 600 --json; query map.json 0 0 --frame bed";
  return "query map.json 0 0 700 300 1200 600 -1180 590 --json";
}

namespace {

std::vector<Telling> tellings() {
  using enum Shows;
  std::vector<Telling> all = {
      // A machine that is listened to.
      {"maslow4", "--host", "--host 127.0.0.9", in_words},
      {"maslow4", "--replay", "--replay @notes.txt", in_form},
      {"maslow4", "--port", "--port 1", in_words},
      {"maslow4", "--telnet", "--telnet", in_words, "", websocket_line().c_str()},
      {"maslow4", "--telnet", "--telnet", in_words, "log"},
      {"maslow4", "--output", "-o other.txt", as_file},
      {"maslow4", "--patience-s", "--patience-s 0.2", in_words, "", mute_line().c_str()},
      {"maslow4", "--patience-s", "--patience-s 0.2", in_words, "log"},
      {"maslow4", "--most-s", "--most-s 0.1", in_words, "", mute_line().c_str()},
      {"maslow4", "--most-s", "--most-s 0.1", in_words, "log"},
      {"maslow4", "--reconnect", "--reconnect 1", in_words},
      {"maslow4", "--drive", "--drive", in_words},
      {"maslow4", "--settings", "--settings @flat.yaml", in_form},
      {"maslow4", "--lengths", "--lengths belt", in_form},
      {"maslow4", "--orientation", "--orientation flat", in_form},
      // Files of measurements.
      {"fit", "--machine", "--machine @other.json"},
      {"fit", "--machine", "--machine @other.json", in_numbers, "direct",
       "fit @commanded_lattice.csv --machine @classic.json --surface direct -o map.json"},
      {"fit", "--noise-length-mm", "--noise-length-mm 3"},
      {"fit", "--noise-position-mm", "--noise-position-mm 4"},
      {"fit", "--noise-dof", "--noise-dof 3"},
      {"fit", "--inches", "--inches"},
      {"fit", "--inches", "--inches", in_numbers, "csv",
       "fit @grid_in_inches.csv --machine @classic.json -o map.json"},
      {"fit", "--tape-sigma-mm", "--tape-sigma-mm 4"},
      {"fit", "--hook-offset-mm", "--hook-offset-mm 3"},
      {"fit", "--hook-sigma-mm", "--hook-sigma-mm 6"},
      {"fit", "--hole-sigma-mm", "--hole-sigma-mm 4"},
      {"fit", "--with", "--with @holes.json"},
      {"fit", "--with", "--with @few.json", in_numbers, "mix"},
      {"fit", "--with", "--with @holes2.json", in_numbers, "holes"},
      {"fit", "--with", "--with @belt_holes.json", in_numbers, "belts"},
      {"fit", "--with", "--with @belts.json", in_numbers, "belt_holes"},
      {"fit", "--with", "--with @belt_holes.json --with @belt_holes.json", in_numbers,
       "belts_and_holes"},
      {"fit", "--output", "--output again.json", as_file},
      {"fit", "--surface", "--surface direct"},
      {"fit", "--surface", "--surface residual --machine @classic.json", in_numbers, "direct"},
      {"fit", "--ends", "--ends natural"},
      {"fit", "--outside", "--outside refuse"},
      {"fit", "--outside", "--outside refuse", in_numbers, "holes",
       "fit @narrow_holes.json -o map.json"},
      {"fit", "--outside", "--outside refuse", in_numbers, "mix",
       "fit @placed.json --with @holes.json -o map.json"},
      {"fit", "--outside", "--outside refuse", in_numbers, "causes",
       "fit @placed.json --causes -o map.json"},
      {"fit", "--fade-mm", "--fade-mm 500"},
      {"fit", "--causes", "--causes", in_words},
      {"fit", "--causes", "--causes", in_numbers, "grid"},
      {"fit", "--causes", "--causes --accept-class", in_numbers, "causes",
       "fit @worn_both.json -o map.json"},
      {"fit", "--plain", "--plain --causes", in_words},
      {"fit", "--plain", "--plain", in_words, "causes"},
      {"fit", "--accept-class", "--accept-class"},
      {"fit", "--wish-mm", "--wish-mm 0.2", in_words},
      {"fit", "--effects", "--effects @own.json", in_numbers, "causes",
       "fit @worn.json --causes -o map.json"},
      {"fit", "--effects", "--effects @own.json"},
      {"fit", "--without", "--without 3"},
      {"fit", "--verbose", "--verbose", in_words},
      {"fit", "--json", "--json", in_form},
      {"diagnose", "--machine", "--machine @other.json"},
      {"diagnose", "--noise-length-mm", "--noise-length-mm 3"},
      {"diagnose", "--noise-position-mm", "--noise-position-mm 4"},
      {"diagnose", "--noise-dof", "--noise-dof 3"},
      {"diagnose", "--inches", "--inches"},
      {"diagnose", "--inches", "--inches", in_numbers, "csv",
       "diagnose @grid_in_inches.csv --machine @classic.json -o d.json"},
      {"diagnose", "--tape-sigma-mm", "--tape-sigma-mm 4"},
      {"diagnose", "--hook-offset-mm", "--hook-offset-mm 3"},
      {"diagnose", "--hook-sigma-mm", "--hook-sigma-mm 6"},
      {"diagnose", "--hole-sigma-mm", "--hole-sigma-mm 4"},
      {"diagnose", "--effects", "--effects @own.json"},
      {"diagnose", "--with", "--with @holes.json"},
      {"diagnose", "--with", "--with @few.json", in_numbers, "mix"},
      {"diagnose", "--with", "--with @holes2.json", in_numbers, "holes"},
      {"diagnose", "--output", "--output again.json", as_file},
      {"diagnose", "--report", "--report page.html", as_file},
      {"diagnose", "--extended-machine", "--extended-machine machine.json", as_file},
      {"diagnose", "--corrected-grid", "--corrected-grid corrected.json", as_file},
      // A machine that does not know its wave.
      {"diagnose", "--law", "--law law.json", as_file, "grid",
       "diagnose @wave.json --machine @classic.json -o d.json"},
      {"diagnose", "--law", "--law law.json", as_file, "csv",
       "diagnose @wave.json --machine @classic.json -o d.json"},
      {"diagnose", "--law", "--law law.json", as_file, "holes",
       "diagnose @wave_holes.json --machine @classic.json -o d.json"},
      {"diagnose", "--law", "--law law.json", as_file, "mix",
       "diagnose @wave.json --with @wave_holes.json --machine @classic.json -o d.json"},
      {"diagnose", "--law", "--law law.json", as_file},
      {"diagnose", "--held-out", "--held-out @lattice.json"},
      {"diagnose", "--before", "--before @diagnosis.json"},
      {"diagnose", "--before", "--before @belts_before.json", in_numbers, "belts"},
      {"diagnose", "--assume-order", "--assume-order rows"},
      {"diagnose", "--accept-class", "--accept-class", in_form, "grid", "diagnose @worn_both.json -o d.json"},
      {"diagnose", "--accept-class", "--accept-class", in_form, "csv",
       "diagnose @worn_both.json --machine @classic.json -o d.json"},
      {"diagnose", "--accept-class", "--accept-class", in_form, "holes",
       "diagnose @worn_holes.json -o d.json"},
      {"diagnose", "--accept-class", "--accept-class", in_form, "mix",
       "diagnose @worn_both.json --with @worn_holes.json -o d.json"},
      {"diagnose", "--accept-class", "--accept-class"},
      {"diagnose", "--without", "--without 3"},
      {"diagnose", "--seed", "--seed 7"},
      {"diagnose", "--json", "--json", in_form},
      {"check", "--machine", "--machine @other.json", in_numbers, "grid", kCheckOfCommands},
      {"check", "--machine", "--machine @other.json", in_numbers, "csv", kCheckOfCommands},
      {"check", "--machine", "--machine @other.json", in_numbers, "mix", kCheckOfCommands},
      {"check", "--machine", "--machine @other.json"},
      {"check", "--noise-length-mm", "--noise-length-mm 3"},
      {"check", "--noise-position-mm", "--noise-position-mm 4"},
      {"check", "--settings", "--settings @stated.json"},
      {"check", "--settings", "--settings @stated.json", in_numbers, "grid", kCheckOfCommands},
      {"check", "--settings", "--settings @stated.json", in_numbers, "csv", kCheckOfCommands},
      {"check", "--noise-dof", "--noise-dof 3"},
      {"check", "--inches", "--inches"},
      {"check", "--inches", "--inches", in_numbers, "csv",
       "check @map.json @few_in_inches.csv"},
      {"check", "--tape-sigma-mm", "--tape-sigma-mm 4"},
      {"check", "--hook-offset-mm", "--hook-offset-mm 3"},
      {"check", "--hook-sigma-mm", "--hook-sigma-mm 6"},
      {"check", "--hole-sigma-mm", "--hole-sigma-mm 4"},
      {"check", "--with", "--with @holes.json"},
      {"check", "--with", "--with @few.json --with @holes2.json", in_numbers, "mix"},
      {"check", "--with", "--with @holes2.json", in_numbers, "holes"},
      {"check", "--json", "--json", in_form},
      {"check", "--output", "--output answer.txt", as_file},
      {"plan", "--machine", "--machine @other.json", in_numbers},
      {"plan", "--second-visits", "--second-visits 3", in_form},
      {"plan", "--machine", "--machine @classic.json", in_words, "after_grid",
       "plan @commanded.csv --after @commanded_diagnosis.json"},
      {"plan", "--machine", "--machine @classic.json", in_words, "after_holes",
       "plan @commanded.csv --with @holes.json --after @mixed_diagnosis.json"},
      {"plan", "--after", "--after @diagnosis.json", in_words},
      {"plan", "--with", "--with @holes.json", in_words},
      {"plan", "--with", "--with @grid.json", in_words, "after_holes"},
      {"plan", "--points", "--points 16"},
      {"plan", "--points", "--points 6", in_numbers, "check"},
      {"plan", "--check", "--check @map2.json"},
      {"plan", "--margin-mm", "--margin-mm 250"},
      {"plan", "--holes", "--holes 8"},
      {"plan", "--distances", "--distances 11"},
      {"plan", "--edges", "--edges"},
      {"plan", "--tape-sigma-mm", "--tape-sigma-mm 4", in_words},
      {"plan", "--hole-sigma-mm", "--hole-sigma-mm 4", in_words},
      {"plan", "--tape-length-mm", "--tape-length-mm 1200"},
      {"plan", "--length-noise-mm", "--length-noise-mm 3", in_words},
      {"plan", "--position-noise-mm", "--position-noise-mm 3", in_words},
      {"plan", "--measure", "--measure places", in_form},
      {"plan", "--measure", "--measure lengths", in_form, "program"},
      {"plan", "--output", "--output list.csv", as_file},
      {"plan", "--json", "--json", in_form},
      {"plan", "--page", "--page page.html", as_file},
      {"plan", "--gcode", "--gcode drill.nc", as_file},
      {"plan", "--depth-mm", "--depth-mm 5"},
      {"plan", "--clearance-mm", "--clearance-mm 9"},
      {"plan", "--svg", "--svg plan.svg", as_file},
      {"passes", "--machine", "--machine @other.json"},
      {"passes", "--passes", "--passes 1"},
      {"passes", "--holes", "--holes 7"},
      {"passes", "--tape-sigma-mm", "--tape-sigma-mm 2"},
      {"passes", "--hole-sigma-mm", "--hole-sigma-mm 2"},
      {"passes", "--worthwhile-mm", "--worthwhile-mm 50", in_form},
      {"passes", "--seed", "--seed 9"},
      {"passes", "--json", "--json", in_form},
      {"passes", "--output", "--output map.json", as_file},
      // What is made.
      {"simulate", "--machine", "--machine @other.json"},
      {"simulate", "--belts", "--belts @belts.json"},
      {"simulate", "--pulls", "--pulls 1,1.6"},
      {"simulate", "--grid", "--grid 5x3"},
      {"simulate", "--random", "--random 8"},
      {"simulate", "--marks", "--marks @few_marks.csv"},
      {"simulate", "--points", "--points @few_marks.csv"},
      {"simulate", "--holes", "--holes 7"},
      {"simulate", "--spacing", "--spacing chebyshev"},
      {"simulate", "--margin-mm", "--margin-mm 280"},
      {"simulate", "--without-corners", "--without-corners"},
      {"simulate", "--region", "--region left"},
      {"simulate", "--order", "--order serpentine_columns"},
      {"simulate", "--repeats", "--repeats 2"},
      {"simulate", "--jitter-mm", "--jitter-mm 9"},
      {"simulate", "--length-noise-mm", "--length-noise-mm 2"},
      {"simulate", "--position-noise-mm", "--position-noise-mm 2"},
      {"simulate", "--heavy-tails", "--heavy-tails"},
      {"simulate", "--length-rounding-mm", "--length-rounding-mm 5"},
      {"simulate", "--position-rounding-mm", "--position-rounding-mm 5"},
      {"simulate", "--stated-length-noise-mm", "--stated-length-noise-mm 2"},
      {"simulate", "--stated-position-noise-mm", "--stated-position-noise-mm 2"},
      {"simulate", "--stated-dof", "--stated-dof 4"},
      {"simulate", "--bad-points", "--bad-points 2"},
      {"simulate", "--bad-size-mm", "--bad-size-mm 33 --bad-points 1"},
      {"simulate", "--distances", "--distances 12"},
      {"simulate", "--edges", "--edges"},
      {"simulate", "--tape-sigma-mm", "--tape-sigma-mm 2"},
      {"simulate", "--hole-sigma-mm", "--hole-sigma-mm 2"},
      {"simulate", "--hook-offset-mm", "--hook-offset-mm 20"},
      {"simulate", "--tape-rounding-mm", "--tape-rounding-mm 5"},
      {"simulate", "--effects",
       "--effects @own.json --effect own_chain_pitch_error:left:elongation=0.0008"},
      {"simulate", "--effect", "--effect chain_pitch_error:left:elongation=0.002"},
      {"simulate", "--effect", "--effect belt_stretch:-:elongation=0.004", in_numbers, "belts"},
      {"simulate", "--offset", "--offset motor_left_x_mm=6"},
      {"simulate", "--offset", "--offset tl_x_mm=9", in_numbers, "belts"},
      {"simulate", "--draw-settings", "--draw-settings"},
      {"simulate", "--sheet-shift-mm", "--sheet-shift-mm 20"},
      {"simulate", "--sheet-rotation-mrad", "--sheet-rotation-mrad 9"},
      {"simulate", "--model", "--model straight"},
      {"simulate", "--seed", "--seed 8"},
      {"simulate", "--name", "--name another", in_form},
      {"simulate", "--output", "--output made.json", as_file},
      {"simulate", "--answer", "--answer answer.json", as_file},
      // Maps, anchors, diagnoses, machines.
      {"query", "--points", "--points @marks.csv"},
      {"query", "--inverse", "--inverse 2200 2300"},
      {"query", "--frame", "--frame bed"},
      {"query", "--output", "--output lengths.csv", as_file},
      {"query", "--outside", "--outside refuse"},
      {"query", "--fade-mm", "--fade-mm 700"},
      {"query", "--json", "--json", in_form},
      {"report", "--output", "--output other.html", as_file},
      {"report", "--certificate", "--certificate", in_form},
      {"report", "--date", "--date 2026-11-22", in_form},
      {"export groundcontrol", "--output", "--output settings.txt", as_file},
      {"export groundcontrol", "--map-after", "--map-after after.json", as_file},
      {"export maslow4", "--output", "--output settings.txt", as_file},
      {"export plotter", "--output", "--output settings.txt", as_file},
      {"export linuxcnc", "--output", "--output other.c", as_file},
      {"export klipper", "--output", "--output other.py", as_file},
      {"export fluidnc", "--output", "--output settings.txt", as_file},
      {"export grblhal", "--output", "--output settings.txt", as_file},
      {"square", "--map", "--map @map2.json"},
      {"square", "--machine", "--machine @other.json"},
      {"square", "--controller-machine", "--controller-machine @other.json"},
      {"square", "--controller-machine", "--controller-machine @moved_plotter.json", in_numbers, "plotter"},
      {"square", "--controller-machine", "--controller-machine @moved_plotter.json", in_numbers,
       "plotter_program"},
      {"square", "--machine", "--machine @other.json", in_words, "plotter"},
      {"square", "--size-mm", "--size-mm 300"},
      {"square", "--at", "--at 400 -200"},
      {"square", "--below", "--below --at 0 100"},
      {"square", "--json", "--json", in_form},
      {"square", "--output", "--output square.svg", as_file},
      {"square", "--gcode", "--gcode square2.nc", as_file},
      {"square", "--depth-mm", "--depth-mm 7"},
      // Programs. @simple.nc has a line that may be left out.
      {"gcode", "--home", "--home 20,-30"},
      {"gcode", "--block-delete", "--block-delete"},
      {"gcode", "--tools-have-no-diameter", "--tools-have-no-diameter", in_numbers, "", "@offset.nc"},
      {"gcode", "--step-budget", "--step-budget 2", in_numbers, "", "@loop.nc"},
      {"gcode", "--map", "--map @map2.json"},
      {"gcode", "--frame", "--frame bed"},
      {"gcode", "--machine", "--machine @other.json"},
      {"gcode", "--machine", "--machine @moved_belts.json", in_numbers, "anchors"},
      {"gcode", "--machine", "--machine @moved_plotter.json", in_numbers, "plotter"},
      {"gcode", "--settings", "--settings @stated.json"},
      {"gcode", "--controller", "--controller fluidnc_wallplotter"},
      {"gcode", "--controller", "--controller ideal", in_words, "anchors"},
      {"gcode", "--controller", "--controller ideal", in_words, "plotter"},
      {"gcode check", "--controller", "--controller maslow_classic", in_words, "none"},
      {"gcode", "--tolerance-mm", "--tolerance-mm 0.0005"},
      {"gcode", "--decimals", "--decimals 5"},
      {"gcode verify", "--decimals", "--decimals 2", in_numbers, "map",
       "gcode verify @tiny.nc @short_true.nc --map @map.json --tolerance-mm 0.02"},
      {"gcode verify", "--decimals", "--decimals 2", in_numbers, "anchors",
       "gcode verify @tiny.nc @short_belts_true.nc --map @anchors.json --tolerance-mm 0.02"},
      {"gcode verify", "--decimals", "--decimals 2", in_numbers, "plotter",
       "gcode verify @tiny.nc @short_plotter_true.nc --map @wide_plotter.json --tolerance-mm 0.02"},
      {"gcode", "--largest-correction-mm", "--largest-correction-mm 0.002"},
      {"gcode", "--steepest-correction", "--steepest-correction 0.000002"},
      {"gcode verify", "--steepest-correction", "--steepest-correction 0.005", in_numbers, "map",
       "gcode verify @simple.nc @slow_true.nc --map @map.json"},
      {"gcode verify", "--steepest-correction", "--steepest-correction 0.005", in_numbers, "anchors",
       "gcode verify @simple.nc @slow_belts_true.nc --map @anchors.json"},
      {"gcode verify", "--steepest-correction", "--steepest-correction 0.005", in_numbers, "plotter",
       "gcode verify @simple.nc @slow_plotter_true.nc --map @wide_plotter.json"},
      {"gcode", "--keep-rapids-whole", "--keep-rapids-whole"},
      {"gcode check", "--keep-rapids-whole", "--keep-rapids-whole", in_numbers, "plotter",
       "gcode check @across.nc --map @wide_plotter.json --tolerance-mm 0.01"},
      {"gcode verify", "--keep-rapids-whole", "--keep-rapids-whole", in_numbers, "plotter",
       "gcode verify @rapid.nc @rapid_plotter_true.nc --map @wide_plotter.json --tolerance-mm 0.01"},
      {"gcode check", "--keep-rapids-whole", "--keep-rapids-whole", in_numbers, "map",
       "gcode check @rapid.nc --map @map.json --tolerance-mm 0.01"},
      {"gcode check", "--keep-rapids-whole", "--keep-rapids-whole", in_numbers, "anchors",
       "gcode check @rapid.nc --map @anchors.json --tolerance-mm 0.01"},
      {"gcode verify", "--keep-rapids-whole", "--keep-rapids-whole", in_numbers, "map",
       "gcode verify @rapid.nc @rapid_true.nc --map @map.json --tolerance-mm 0.01"},
      {"gcode verify", "--keep-rapids-whole", "--keep-rapids-whole", in_numbers, "anchors",
       "gcode verify @rapid.nc @rapid_belts_true.nc --map @anchors.json --tolerance-mm 0.01"},
      {"gcode", "--home-is-zero", "--home-is-zero", in_numbers, "", "@home.nc"},
      {"gcode", "--json", "--json", in_form},
      {"gcode check", "--machine", "--machine @small.json", in_numbers, "none"},
      {"gcode check", "--decimals", "--decimals 2 --tolerance-mm 0.005"},
      {"gcode", "--every-mm", "--every-mm 400"},
      {"gcode", "--output", "--output other.txt", as_file},
      {"gcode", "--report", "--report page.html", as_file},
      {"gcode", "--no-verify", "--no-verify", in_words}};
  return all;
}

}  // namespace

const Telling* telling_of(const std::string& verb, const std::string& option, const std::string& use) {
  static const std::vector<Telling> all = tellings();
  const Telling* general = nullptr;
  for (const Telling& one : all) {
    if (one.option != option) continue;
    const bool is_verb = one.verb == verb;
    const bool is_group = std::string(one.verb) == "gcode" && verb.starts_with("gcode ");
    if (!is_verb && !is_group) continue;
    if (one.where == use) return &one;
    if (*one.where == '\0' && (general == nullptr || is_verb)) general = &one;
  }
  return general;
}

}  // namespace chaintrue::inputs
