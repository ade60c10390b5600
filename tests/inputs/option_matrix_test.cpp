// SPDX-License-Identifier: GPL-3.0-or-later
// Every option of a verb affects every kind of input that the verb accepts, so that the numbers of
// the answer change, or is rejected with the message of the table (tools/cli/option_rules.def). The
// options are those of --help: a new one without a line in the table, or without a distinguishable
// value here, fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/in_threads.hpp"
#include "tests/inputs/workshop.hpp"
#include "tools/cli/option_rules.hpp"

namespace chaintrue {
namespace {

using cli::Facts;
using inputs::Ran;
using inputs::Workshop;
using testing::HasSubstr;
namespace facts = cli::facts;

/// A verb on one kind of input. `then` reads the numbers from the output, if the output itself
/// repeats the input.
struct Use {
  const char* name;
  const char* verb;
  Facts facts;
  const char* line;
  const char* then = "";
};

constexpr const char* kAskMap = "query map.json 0 0 700 300 1200 600 -1180 590 --json";

const std::vector<Use>& uses() {
  static const std::vector<Use> all = {
      {"grid", "fit", facts::grid | facts::one_grid | facts::residual, "fit @placed.json -o map.json", kAskMap},
      {"csv", "fit", facts::grid | facts::one_grid | facts::residual,
       "fit @grid.csv --machine @classic.json -o map.json", kAskMap},
      {"causes", "fit", facts::grid | facts::one_grid | facts::residual | facts::causes,
       "fit @worn_both.json --causes -o map.json", kAskMap},
      {"direct", "fit", facts::grid | facts::one_grid | facts::direct,
       "fit @lattice.csv --surface direct -o map.json", "query map.json 0 0 700 300 350 -150 1200 600 --json; query map.json 0 0 --frame bed"},
      {"fade", "fit", facts::grid | facts::one_grid | facts::residual | facts::fade,
       "fit @placed.json --outside fade -o map.json", kAskMap},
      {"holes", "fit", facts::holes | facts::residual, "fit @holes.json -o map.json", kAskMap},
      {"mix", "fit", facts::grid | facts::holes | facts::residual,
       "fit @grid.json --with @holes.json -o map.json", kAskMap},
      {"belts", "fit", facts::belts | facts::residual, "fit @belts.json -o anchors.json"},
      {"belts_and_holes", "fit", facts::belts | facts::belt_holes | facts::residual,
       "fit @belts.json --with @belt_holes.json -o anchors.json"},
      {"belt_holes", "fit", facts::belt_holes | facts::residual,
       "fit @belt_holes.json -o anchors.json"},
      {"grid", "diagnose", facts::grid | facts::one_grid, "diagnose @worn.json -o d.json"},
      {"csv", "diagnose", facts::grid | facts::one_grid,
       "diagnose @grid.csv --machine @classic.json -o d.json"},
      {"holes", "diagnose", facts::holes, "diagnose @holes.json -o d.json"},
      {"mix", "diagnose", facts::grid | facts::holes,
       "diagnose @grid.json --with @holes.json -o d.json"},
      {"belts", "diagnose", facts::belts, "diagnose @belts.json -o d.json"},
      {"grid", "check", facts::map | facts::grid, "check @map.json @few.json"},
      {"csv", "check", facts::map | facts::grid, "check @map.json @few.csv"},
      {"holes", "check", facts::map | facts::holes, "check @map.json @holes.json"},
      {"mix", "check", facts::map | facts::grid | facts::holes,
       "check @map.json @few.json --with @holes.json"},
      {"belts", "check", facts::anchors, "check @anchors.json @few_belts.json"},
      {"marks", "plan", facts::lattice, "plan --machine @classic.json --points 12"},
      {"program", "plan", facts::lattice | facts::program | facts::drilled,
       "plan --machine @classic.json --points 12 --measure places --gcode marks.nc"},
      {"holes", "plan", facts::tape, "plan --machine @classic.json --holes 6"},
      {"check", "plan", facts::check, "plan --check @map.json"},
      {"after_grid", "plan", facts::follow_up | facts::grid,
       "plan @worn.json --after @worn_diagnosis.json"},
      {"after_holes", "plan", facts::follow_up | facts::holes,
       "plan @holes.json --after @holes_diagnosis.json"},
      {"after_belts", "plan", facts::follow_up | facts::belts,
       "plan @belts.json --after @belts_diagnosis.json"},
      {"measured", "passes", facts::measured, "passes @holes.json @holes2.json"},
      {"simulated", "passes", facts::simulated, "passes --machine @classic.json --passes 2"},
      {"grid", "simulate", facts::lattice,
       "simulate --machine @classic.json --grid 4x3 --length-noise-mm 0.2 --position-noise-mm 0.3"},
      {"random", "simulate", facts::scattered,
       "simulate --machine @classic.json --random 9 --length-noise-mm 0.2 --position-noise-mm 0.3"},
      {"marks", "simulate", facts::marks,
       "simulate --machine @classic.json --marks @marks.csv --length-noise-mm 0.2 "
       "--position-noise-mm 0.3"},
      {"places", "simulate", facts::places, "simulate --machine @classic.json --points @marks.csv"},
      {"holes", "simulate", facts::tape, "simulate --machine @classic.json --holes 6"},
      {"belts", "simulate", facts::belts,
       "simulate --belts @anchors.json --grid 4x3 --length-noise-mm 0.5"},
      {"map", "query", facts::map, "query @map.json 0 0 900 400 1200 600"},
      {"fade", "query", facts::map | facts::fade, "query @map.json 0 0 1200 600 --outside fade"},
      {"anchors", "query", facts::anchors, "query @anchors.json 0 0 400 300"},
      {"map", "report", facts::map, "report @map.json -o page.html"},
      {"diagnosis", "report", facts::diagnosis, "report @diagnosis.json -o page.html"},
      {"anchors", "report", facts::anchors, "report @anchors.json -o page.html"},
      {"machine", "export groundcontrol", facts::machine, "export groundcontrol @stated.json"},
      {"map", "export groundcontrol", facts::map, "export groundcontrol @map.json"},
      {"diagnosis", "export groundcontrol", facts::diagnosis,
       "export groundcontrol @diagnosis.json"},
      {"anchors", "export maslow4", facts::anchors, "export maslow4 @anchors.json"},
      {"diagnosis", "export maslow4", facts::diagnosis, "export maslow4 @belts_diagnosis.json"},
      {"map", "square", facts::map, "square --map @map.json"},
      {"program", "square", facts::map | facts::program, "square --map @map.json --gcode square.nc"},
      {"machines", "square", facts::machine,
       "square --machine @classic.json --controller-machine @stated.json"},
      {"none", "gcode check", facts::no_map, "gcode check @simple.nc"},
      {"map", "gcode check", facts::map, "gcode check @simple.nc --map @map.json"},
      {"anchors", "gcode check", facts::anchors, "gcode check @simple.nc --map @anchors.json"},
      {"map", "gcode lengths", facts::map, "gcode lengths @simple.nc --map @map.json"},
      {"anchors", "gcode lengths", facts::anchors, "gcode lengths @simple.nc --map @anchors.json"},
      {"map", "gcode compensate", facts::map,
       "gcode compensate @simple.nc --map @map.json -o true.nc"},
      {"anchors", "gcode compensate", facts::anchors,
       "gcode compensate @simple.nc --map @anchors.json -o true.nc"},
      {"map", "gcode verify", facts::map, "gcode verify @simple.nc @true.nc --map @map.json"},
      {"anchors", "gcode verify", facts::anchors,
       "gcode verify @simple.nc @belts_true.nc --map @anchors.json"},
      {"none", "gcode explain", facts::no_map, "gcode explain @simple.nc:6"},
      {"map", "gcode explain", facts::map, "gcode explain @simple.nc:6 --map @map.json"},
      {"anchors", "gcode explain", facts::anchors, "gcode explain @simple.nc:6 --map @anchors.json"}};
  return all;
}

/// How the effect of an option is detected.
enum class Shows {
  in_numbers,  ///< of the answer
  in_form,     ///< other bytes, the numbers may be the same
  as_file,     ///< a file more
  in_words,    ///< messages on standard error, or the exit code
};

/// An option with a distinguishable value and its prerequisites. `where` is a use's name, or empty
/// for all.
struct Telling {
  const char* verb;
  const char* option;
  const char* words;
  Shows shows = Shows::in_numbers;
  const char* where = "";
  /// Instead of simple.nc and of the files made from it.
  const char* program = "";
};

std::vector<Telling> tellings();

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

std::vector<Telling> tellings() {
  using enum Shows;
  std::vector<Telling> all = {
      // Files of measurements.
      {"fit", "--machine", "--machine @other.json"},
      {"fit", "--noise-length-mm", "--noise-length-mm 3"},
      {"fit", "--noise-position-mm", "--noise-position-mm 4"},
      {"fit", "--noise-dof", "--noise-dof 3"},
      {"fit", "--tape-sigma-mm", "--tape-sigma-mm 4"},
      {"fit", "--hook-offset-mm", "--hook-offset-mm 3"},
      {"fit", "--hook-sigma-mm", "--hook-sigma-mm 3"},
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
      {"fit", "--fade-mm", "--fade-mm 500"},
      {"fit", "--causes", "--causes", in_words},
      {"fit", "--causes", "--causes", in_numbers, "grid"},
      {"fit", "--accept-class", "--accept-class"},
      {"fit", "--verbose", "--verbose", in_words},
      {"fit", "--json", "--json", in_form},
      {"diagnose", "--machine", "--machine @other.json"},
      {"diagnose", "--noise-length-mm", "--noise-length-mm 3"},
      {"diagnose", "--noise-position-mm", "--noise-position-mm 4"},
      {"diagnose", "--noise-dof", "--noise-dof 3"},
      {"diagnose", "--tape-sigma-mm", "--tape-sigma-mm 4"},
      {"diagnose", "--hook-offset-mm", "--hook-offset-mm 3"},
      {"diagnose", "--hook-sigma-mm", "--hook-sigma-mm 3"},
      {"diagnose", "--hole-sigma-mm", "--hole-sigma-mm 4"},
      {"diagnose", "--with", "--with @holes.json"},
      {"diagnose", "--with", "--with @few.json", in_numbers, "mix"},
      {"diagnose", "--with", "--with @holes2.json", in_numbers, "holes"},
      {"diagnose", "--output", "--output again.json", as_file},
      {"diagnose", "--report", "--report page.html", as_file},
      {"diagnose", "--extended-machine", "--extended-machine machine.json", as_file},
      {"diagnose", "--corrected-grid", "--corrected-grid corrected.json", as_file},
      {"diagnose", "--held-out", "--held-out @lattice.json"},
      {"diagnose", "--before", "--before @diagnosis.json"},
      {"diagnose", "--before", "--before @belts_before.json", in_numbers, "belts"},
      {"diagnose", "--assume-order", "--assume-order rows"},
      {"diagnose", "--accept-class", "--accept-class"},
      {"diagnose", "--seed", "--seed 7"},
      {"diagnose", "--json", "--json", in_form},
      {"check", "--machine", "--machine @other.json"},
      {"check", "--noise-length-mm", "--noise-length-mm 3"},
      {"check", "--noise-position-mm", "--noise-position-mm 4"},
      {"check", "--settings", "--settings @stated.json"},
      {"check", "--noise-dof", "--noise-dof 3"},
      {"check", "--tape-sigma-mm", "--tape-sigma-mm 4"},
      {"check", "--hook-offset-mm", "--hook-offset-mm 3"},
      {"check", "--hook-sigma-mm", "--hook-sigma-mm 3"},
      {"check", "--hole-sigma-mm", "--hole-sigma-mm 4"},
      {"check", "--with", "--with @holes.json"},
      {"check", "--with", "--with @few.json --with @holes2.json", in_numbers, "mix"},
      {"check", "--with", "--with @holes2.json", in_numbers, "holes"},
      {"check", "--json", "--json", in_form},
      {"check", "--output", "--output answer.txt", as_file},
      {"plan", "--machine", "--machine @other.json", in_numbers},
      {"plan", "--second-visits", "--second-visits 3", in_form},
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
      // Simulation and planning.
      {"simulate", "--machine", "--machine @other.json"},
      {"simulate", "--belts", "--belts @belts.json"},
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
      {"square", "--map", "--map @map2.json"},
      {"square", "--machine", "--machine @other.json"},
      {"square", "--controller-machine", "--controller-machine @other.json"},
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
      {"gcode", "--settings", "--settings @stated.json"},
      {"gcode", "--controller", "--controller fluidnc_wallplotter"},
      {"gcode", "--controller", "--controller ideal", in_words, "anchors"},
      {"gcode", "--tolerance-mm", "--tolerance-mm 0.0005"},
      {"gcode", "--decimals", "--decimals 5"},
      {"gcode", "--largest-correction-mm", "--largest-correction-mm 0.002"},
      {"gcode", "--steepest-correction", "--steepest-correction 0.000002"},
      {"gcode", "--keep-rapids-whole", "--keep-rapids-whole"},
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

/// Cells where the option has no effect with the files of the workshop, and why.
struct NotShown {
  const char* verb;
  const char* option;
  const char* where;  ///< empty: everywhere
  const char* why;
};
constexpr NotShown kNotShown[] = {
    {"diagnose", "--accept-class", "", "needs points that cannot tell a long chain from a long tape"},
    {"fit", "--causes", "causes", "stands in the line already"},
    {"fit", "--machine", "direct", "only places that were commanded go by the machine"},
    {"fit", "--outside", "direct", "a direct surface ends where its points do"},
    {"fit", "--outside", "mix", "the points of this mix reach to the edges of the sheet"},
    {"plan", "--measure", "program", "a program that drills is for places"},
    {"gcode check", "--controller", "none", "only what another firmware reads otherwise changes"},
    {"plan", "--machine", "after_grid", "only a CSV of commanded places asks for the machine"},
    {"plan", "--machine", "after_holes", "only a CSV asks for the machine"},
    {"check", "--machine", "grid", "only places that were commanded go by the machine"},
    {"check", "--machine", "csv", "only places that were commanded go by the machine"},
    {"check", "--machine", "mix", "only places that were commanded go by the machine"},
    {"check", "--settings", "grid", "only places that were commanded go by the settings"},
    {"check", "--settings", "csv", "only places that were commanded go by the settings"},
    {"check", "--noise-dof", "", "a check takes the noise as known"},
    {"gcode check", "--keep-rapids-whole", "", "no rapid of these programs bends beyond the tolerance"},
    {"gcode verify", "--keep-rapids-whole", "", "no rapid of these programs bends beyond the tolerance"},
    {"gcode verify", "--decimals", "", "only moves as short as the last digits may be missing"},
    {"gcode verify", "--steepest-correction", "", "only a feed that is off by a hundredth is refused"},
};

bool is_not_shown(const Use& use, const std::string& option) {
  return std::any_of(std::begin(kNotShown), std::end(kNotShown), [&](const NotShown& cell) {
    return std::string(cell.verb) == use.verb && cell.option == option &&
           (*cell.where == '\0' || std::string(cell.where) == use.name);
  });
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

/// The use with the program of the tested value.
std::string line_with(const Use& use, const Telling& telling) {
  std::string line = use.line;
  if (*telling.program == '\0') return line;
  for (const char* own : {"@simple.nc", "@true.nc", "@belts_true.nc"})
    line = replaced(line, own, telling.program);
  return line;
}

/// The line without an option and its value, so that it can be given again.
std::string without(const std::string& line, const std::string& option) {
  const bool is_output = option == "--output";
  std::string result = std::regex_replace(line, std::regex(" " + option + "( [^- ][^ ]*)?"), "");
  return is_output ? std::regex_replace(result, std::regex(" -o [^ ]+"), "") : result;
}

/// Long options that --help shows.
std::vector<std::string> options_of(const Workshop& workshop, const std::string& verb) {
  std::vector<std::string> options;
  std::istringstream help(workshop.run(verb + " --help").out);
  static const std::regex option(R"(^\s+(?:-\w,)?(--[a-z0-9-]+).*)");
  std::smatch parts;
  for (std::string line; std::getline(help, line) && !line.starts_with("Example");) {
    if (std::regex_match(line, parts, option) && !parts[1].str().starts_with("--help"))
      options.push_back(parts[1]);
  }
  return options;
}

/// The fault of a cell; empty if there is none.
std::string fault_of(const Workshop& workshop, const Use& use, const Ran& base, const std::string& option) {
  const Telling* telling = telling_of(use.verb, option, use.name);
  if (telling == nullptr) return "has no telling value in this test";
  const std::string line = without(line_with(use, *telling), option) + " " + telling->words;
  const cli::OptionRule* rule = cli::refusal_of(use.verb, option, use.facts);
  if (rule != nullptr) {
    const Ran ran = workshop.run(line);
    if (ran.code != 2 && ran.code != 3)
      return "should be refused, ended with " + std::to_string(ran.code) + ": " + line;
    if (ran.err.find(option) == std::string::npos) return "is not named by the refusal: " + ran.err;
    if (ran.code == 3 && ran.err.find(rule->otherwise) == std::string::npos)
      return "is refused by another sentence: " + ran.err;
    if (!ran.files.empty() || !ran.out.empty()) return "was refused, and something written";
    return "";
  }
  const std::string then = *use.then == '\0' || telling->shows == Shows::as_file ||
                                   telling->shows == Shows::in_words
                               ? ""
                               : std::string("; ") + use.then;
  const Ran ran = workshop.run(line + then);
  if (ran.code == 2 || ran.code == 3) {
    // A message that gives the reason, from the file's content.
    if (ran.err.empty()) return "is refused without a sentence";
  }
  static const std::vector<std::string> kEchoes = {
      "content_hash", "name", "tape", "hole_sigma_mm", "noise_dof", "seed", "tolerance_mm", "machine",
      "extended_machine"};
  switch (telling->shows) {
    case Shows::in_numbers: {
      std::vector<std::string> echoes = kEchoes;
      if (std::string(use.verb) != "simulate") echoes.emplace_back("noise");
      Ran before = *telling->program == '\0' ? base : workshop.run(line_with(use, *telling));
      Ran after = ran;
      if (*use.then != '\0') {
        before.files.clear();
        after.files.clear();
      }
      // Problems of a program are reported on standard error.
      const bool says_more =
          std::string_view(use.verb).starts_with("gcode") && before.err != after.err;
      return numbers_of(before, echoes) == numbers_of(after, echoes) && !says_more &&
                     !is_not_shown(use, option)
                 ? "changes no number: " + line
                 : "";
    }
    case Shows::in_form:
      return base.out == ran.out && base.files == ran.files && !is_not_shown(use, option)
                 ? "changes nothing: " + line
                 : "";
    case Shows::as_file:
      return std::none_of(ran.files.begin(),
                          ran.files.end(),
                          [&](const auto& file) {
                            return !base.files.contains(file.first) && !file.second.empty();
                          })
                 ? "writes no file: " + line + "\n" + ran.err
                 : "";
    case Shows::in_words:
      return base.err == ran.err && base.code == ran.code ? "says nothing: " + line : "";
  }
  return "";
}

class OptionMatrix : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    workshop_ = new Workshop;
    workshop_->write("few_marks.csv", "x_mm,y_mm\n-800,-300\n10,-280\n820,290\n30,20\n");
    (void)workshop_->run("simulate --machine @classic.json --grid 5x4 --length-noise-mm 0.2 "
                         "--position-noise-mm 0.3 --seed 9 -o @lattice.json");
    (void)workshop_->run("simulate --belts @anchors.json --grid 5x5 --length-noise-mm 1 --seed 9 -o "
                         "@belts2.json; diagnose @belts2.json -o @belts_before.json");
  }
  static void TearDownTestSuite() {
    delete workshop_;
    workshop_ = nullptr;
  }
  static Workshop* workshop_;
};
Workshop* OptionMatrix::workshop_ = nullptr;

class EveryOption : public OptionMatrix, public testing::WithParamInterface<std::string> {};

TEST_P(EveryOption, ActsOrIsRefused) {
  const std::string verb = GetParam();
  const std::vector<std::string> options = options_of(*workshop_, verb);
  ASSERT_FALSE(options.empty());
  std::set<std::string> named;
  for (const cli::OptionRule& rule : cli::kOptionRules) {
    if (rule.verb == verb) named.insert(std::string(rule.option));
  }
  EXPECT_EQ(named, std::set<std::string>(options.begin(), options.end()))
      << "option_rules.def and --help differ";
  for (const Use& use : uses()) {
    if (use.verb != verb) continue;
    const std::string then = *use.then == '\0' ? "" : std::string("; ") + use.then;
    const Ran base = workshop_->run(use.line + then);
    const Ran plain = then.empty() ? base : workshop_->run(use.line);
    EXPECT_TRUE(base.code == 0 || base.code == 1 || base.code == 4) << use.line << "\n" << base.err;
    for (const std::string& option : options) {
      if (option == "--force") continue;  // below
      const Telling* telling = telling_of(use.verb, option, use.name);
      const bool by_itself = telling != nullptr && (telling->shows == Shows::as_file ||
                                                    telling->shows == Shows::in_words);
      const std::string fault = fault_of(*workshop_, use, by_itself ? plain : base, option);
      EXPECT_EQ(fault, "") << verb << " of " << use.name << ": " << option;
    }
  }
}

std::vector<std::string> verbs() {
  std::vector<std::string> all;
  for (const Use& use : uses()) {
    if (std::find(all.begin(), all.end(), use.verb) == all.end()) all.emplace_back(use.verb);
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(OfEveryVerb, EveryOption, testing::ValuesIn(verbs()), [](const auto& verb) {
  std::string name = verb.param;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST_F(OptionMatrix, ForceReplacesAFileThatIsSomebodyElses) {
  std::set<std::string> seen;
  for (const Use& use : uses()) {
    if (!seen.insert(use.verb).second) continue;
    if (cli::refusal_of(use.verb, "--force", use.facts) != nullptr) continue;
    const std::vector<std::string> options = options_of(*workshop_, use.verb);
    if (std::find(options.begin(), options.end(), "--force") == options.end()) continue;
    workshop_->write("taken.txt", "mine\n");
    const std::string line = without(use.line, "--output") + " -o @taken.txt";
    EXPECT_EQ(workshop_->run(line).code, 3) << line;
    EXPECT_EQ(workshop_->text_of("taken.txt"), "mine\n");
    EXPECT_NE(workshop_->run(line + " --force").code, 3) << line;
    EXPECT_NE(workshop_->text_of("taken.txt"), "mine\n") << line;
  }
}

}  // namespace
}  // namespace chaintrue
