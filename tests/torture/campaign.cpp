// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/torture/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>

namespace chaintrue::torture {
namespace {

namespace fs = std::filesystem;

/// A verb that reads `IN`; `OUT` is where it writes. The weight is how often it is drawn: the slow
/// ones seldom.
struct Reading {
  const char* seed_file;
  int weight;
  std::vector<std::string> arguments;
};

const std::vector<Reading>& readings() {
  static const std::vector<Reading> all = {
      {"grid.json", 8, {"fit", "IN", "-o", "OUT"}},
      {"grid.json", 1, {"diagnose", "IN", "-o", "OUT"}},
      {"grid.json", 4, {"check", "map.json", "IN"}},
      {"grid.csv", 8, {"fit", "IN", "--machine", "machine.json", "-o", "OUT"}},
      {"grid.csv", 4, {"fit", "IN", "--surface", "direct", "-o", "OUT"}},
      {"machine.json", 6, {"simulate", "--machine", "IN", "--grid", "4x3", "-o", "OUT"}},
      {"machine.json",
       4,
       {"simulate", "--machine", "IN", "--grid", "3x3", "--length-noise-mm", "0"}},
      {"machine.json", 2, {"plan", "--machine", "IN", "--points", "12", "-o", "OUT"}},
      {"machine.json", 2, {"effects", "chain_stretch", "--machine", "IN"}},
      {"machine.json", 6, {"export", "groundcontrol", "IN"}},
      {"machine.json",
       4,
       {"square", "--machine", "IN", "--controller-machine", "machine.json", "--at", "0", "0"}},
      {"holes.json", 5, {"fit", "IN", "-o", "OUT"}},
      {"holes.csv", 5, {"fit", "IN", "--machine", "machine.json", "-o", "OUT"}},
      {"holes.json", 3, {"check", "map.json", "IN"}},
      {"belts.json", 6, {"fit", "IN", "-o", "OUT"}},
      {"maslow4.txt", 6, {"import", "maslow4", "IN", "-o", "OUT"}},
      {"anchors.json", 4, {"export", "maslow4", "IN"}},
      {"settings.ini", 8, {"import", "groundcontrol", "IN", "-o", "OUT"}},
      {"scan.csv", 6, {"import", "optical", "IN", "--machine", "controller.json", "-o", "OUT"}},
      {"points.csv", 8, {"query", "map.json", "--points", "IN"}},
      {"points.csv", 4, {"simulate", "--machine", "machine.json", "--points", "IN"}},
      {"map.json", 8, {"query", "IN", "0", "0", "900", "-400"}},
      {"diagnosis.json", 6, {"report", "IN", "-o", "OUT"}},
      {"diagnosis.json", 4, {"plan", "grid.json", "--after", "IN"}},
      {"sweep.json", 2, {"sweep", "IN", "-o", "OUT", "--shard", "1/4"}},
      {"part.nc", 10, {"gcode", "check", "IN"}},
      {"part.nc", 10, {"gcode", "compensate", "IN", "--map", "map.json", "-o", "OUT"}},
      {"part.nc", 6, {"gcode", "lengths", "IN", "--map", "map.json", "-o", "OUT"}},
      {"part.nc", 4, {"gcode", "verify", "IN", "IN", "--map", "map.json"}},
      {"part.nc", 4, {"gcode", "explain", "IN:3"}},
  };
  return all;
}

/// An option that wants a number, on a verb that takes it.
struct Option {
  const char* name;
  std::vector<std::string> arguments;
};

const std::vector<Option>& options() {
  static const std::vector<std::string> fit = {"fit", "grid.json", "-o", "OUT"};
  static const std::vector<std::string> check = {"check", "map.json", "few.json"};
  static const std::vector<std::string> holes = {"fit", "holes.json", "-o", "OUT"};
  static const std::vector<std::string> simulate = {
      "simulate", "--machine", "machine.json", "--grid", "4x3", "-o", "OUT"};
  static const std::vector<std::string> plan = {"plan", "--machine", "machine.json", "-o", "OUT"};
  static const std::vector<std::string> gcode = {
      "gcode", "compensate", "part.nc", "--map", "map.json", "-o", "OUT"};
  static const std::vector<std::string> lengths = {
      "gcode", "lengths", "part.nc", "--map", "map.json", "-o", "OUT"};
  static const std::vector<std::string> query = {"query", "map.json", "10", "20"};
  static const std::vector<Option> all = {{"--noise-length-mm", fit},
                                          {"--noise-position-mm", fit},
                                          {"--noise-dof", fit},
                                          {"--noise-length-mm", check},
                                          {"--noise-position-mm", check},
                                          {"--noise-dof", check},
                                          {"--tape-sigma-mm", holes},
                                          {"--hook-offset-mm", holes},
                                          {"--hook-sigma-mm", holes},
                                          {"--hole-sigma-mm", holes},
                                          {"--length-noise-mm", simulate},
                                          {"--position-noise-mm", simulate},
                                          {"--jitter-mm", simulate},
                                          {"--repeats", simulate},
                                          {"--bad-points", simulate},
                                          {"--bad-size-mm", simulate},
                                          {"--margin-mm", simulate},
                                          {"--seed", simulate},
                                          {"--points", plan},
                                          {"--margin-mm", plan},
                                          {"--length-noise-mm", plan},
                                          {"--tolerance-mm", gcode},
                                          {"--decimals", gcode},
                                          {"--largest-correction-mm", gcode},
                                          {"--steepest-correction", gcode},
                                          {"--step-budget", gcode},
                                          {"--home", gcode},
                                          {"--every-mm", lengths},
                                          {"--fade-mm", query},
                                          {"--outside", query}};
  return all;
}

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::string& in,
                              const std::string& out) {
  for (std::string& argument : arguments) {
    if (argument.starts_with("IN")) argument.replace(0, 2, in);
    if (argument == "OUT") argument = out;
  }
  return arguments;
}

std::string joined(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += " '" + word + "'";
  return line;
}

}  // namespace

Campaign::Campaign(Command command, fs::path fixtures, fs::path failures, std::uint64_t seed)
    : command_(std::move(command)), failures_(std::move(failures)), seed_(seed), mutate_(seed) {
  prepare(fixtures);
}

void Campaign::write(const std::string& name, const std::string& text) const {
  std::ofstream(at(name), std::ios::binary) << text;
}

void Campaign::prepare(const fs::path& fixtures) {
  const std::pair<const char*, const char*> copies[] = {
      {"grid.json", "grids/seven_by_four.json"},
      {"few.json", "grids/five_new_points.json"},
      {"grid.csv", "good/grid_plain.csv"},
      {"machine.json", "machines/classic.json"},
      {"controller.json", "machines/groundcontrol.json"},
      {"holes.json", "holes/nine_holes.json"},
      {"holes.csv", "good/holes_plain.csv"},
      {"belts.json", "belts/thirty_one_places.json"},
      {"maslow4.txt", "good/maslow4_notes.txt"},
      {"anchors.json", "good/anchors_every_key.json"},
      {"settings.ini", "good/groundcontrol_ring.ini"},
      {"scan.csv", "good/optical_scan.csv"},
      {"part.nc", "gcode/bracket.nc"}};
  for (const auto& [name, from] : copies) fs::copy_file(fixtures / from, at(name));
  write("points.csv", "x_mm,y_mm\n0,0\n100,200\n-900,-400\n");
  std::string sweep = content_of(fixtures / "sweeps/quick.json");
  const std::string place = "../machines/classic.json";
  sweep.replace(sweep.find(place), place.size(), "machine.json");
  write("sweep.json", sweep);
  const std::vector<std::vector<std::string>> makers = {
      {"fit", "grid.json", "-o", "map.json"},
      {"diagnose", "holes.json", "-o", "diagnosis.json"},
      {"gcode", "compensate", "part.nc", "--map", "map.json", "-o", "true.nc"},
      {"sweep", "sweep.json", "-o", "whole"}};
  for (const auto& arguments : makers) {
    const Ended ended = command_.run(arguments);
    if (ended.code != 0)
      throw std::runtime_error("could not be prepared:" + joined(arguments) + "\n" + ended.err);
  }
  sweep_results_ = content_of(at("whole") / "results.csv");
  fs::remove_all(at("whole"));
  for (const auto& entry : fs::directory_iterator(command_.folder()))
    permanent_[entry.path().filename().string()] = content_of(entry.path());
}

std::vector<std::string> Campaign::strays() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(command_.folder())) {
    const std::string name = entry.path().filename().string();
    if (permanent_.find(name) == permanent_.end()) names.push_back(name);
  }
  return names;
}

void Campaign::clean() const {
  for (const std::string& name : strays()) fs::remove_all(at(name));
}

void Campaign::count(const std::string& kind, const Ended& ended) {
  Tally& tally = tallies_[kind];
  ++tally.runs;
  tally.answered += ended.code == 0 || ended.code == 1 ? 1 : 0;
  tally.refused += ended.code >= 2 ? 1 : 0;
  tally.stopped += ended.signal_number != 0 ? 1 : 0;
  tally.slowest_s = std::max(tally.slowest_s, ended.seconds);
}

void Campaign::fail(const Case& what, const std::string& why, const Ended& ended) {
  ++tallies_[what.kind].failures;
  const fs::path kept = failures_ / fmt::format("seed{}_{}", seed_, number_);
  std::error_code ignored;
  fs::create_directories(kept);
  for (const std::string& name : strays())
    fs::copy(
        at(name), kept / name, fs::copy_options::recursive, *std::make_unique<std::error_code>());
  std::ofstream(kept / "command.txt") << "chaintrue" << joined(what.arguments) << "\n"
                                      << why << "\n"
                                      << ended.err;
  fmt::print("FAILED seed {} attack {} ({}): {}\n  chaintrue{}\n",
             seed_,
             number_,
             what.kind,
             why,
             joined(what.arguments));
}

void Campaign::judge(const Case& what) {
  const Ended ended = command_.run(what.arguments);
  count(what.kind, ended);
  std::string wrong = wrong_with(ended);
  for (const auto& [name, content] : permanent_) {
    if (wrong.empty() && content_of(at(name)) != content) wrong = "an input was changed: " + name;
  }
  for (const std::string& name : strays()) {
    const bool is_input =
        std::find(what.inputs.begin(), what.inputs.end(), name) != what.inputs.end();
    const bool is_output =
        std::find(what.outputs.begin(), what.outputs.end(), name) != what.outputs.end();
    if (wrong.empty() && !is_input && !is_output) wrong = "left behind: " + name;
    if (wrong.empty() && is_output && ended.code == 3 && fs::is_regular_file(at(name)))
      wrong = "refused, and yet written: " + name;
    const bool is_page = name.ends_with(".html");
    if (wrong.empty() && is_output && !is_page && fs::is_regular_file(at(name))) {
      if (const std::string found = no_number_in(content_of(at(name))); !found.empty())
        wrong = "a number that is none in the output: " + found;
    }
  }
  if (wrong.empty() && what.must_be_refused && ended.code != 3)
    wrong = fmt::format("taken, exit code {}", ended.code);
  if (!wrong.empty()) fail(what, wrong, ended);
  clean();
}

Campaign::Case Campaign::damaged_input() {
  int total = 0;
  for (const Reading& reading : readings()) total += reading.weight;
  int left = static_cast<int>(mutate_.below(static_cast<std::size_t>(total)));
  const Reading* chosen = &readings().front();
  for (const Reading& reading : readings()) {
    chosen = &reading;
    left -= reading.weight;
    if (left < 0) break;
  }
  const std::string in = std::string("in_") + chosen->seed_file;
  const std::string out = chosen->arguments[0] == "report" ? "out.html" : "out";
  write(in, mutate_.damaged(permanent_.at(chosen->seed_file)));
  return {"damaged " + std::string(chosen->seed_file) + ", " + chosen->arguments[0],
          with(chosen->arguments, in, out),
          {in},
          {out}};
}

Campaign::Case Campaign::tampered_map() {
  const std::vector<std::vector<std::string>> uses = {
      {"query", "IN", "0", "0", "1100", "-500"},
      {"query", "IN", "--inverse", "1600", "1700"},
      {"report", "IN", "-o", "OUT"},
      {"check", "IN", "few.json"},
      {"gcode", "compensate", "part.nc", "--map", "IN", "-o", "OUT"}};
  std::string text = mutate_.with_another_number(permanent_.at("map.json"));
  const bool changed = text != permanent_.at("map.json");
  const bool as_old = mutate_.below(2) == 0;
  if (as_old) {  // as version 1.0, which carries no hash: every check after it must hold
    const std::size_t version = text.find("\"1.1\"");
    if (version != std::string::npos) text.replace(version, 5, "\"1.0\"");
    const std::size_t key = text.rfind(",\n  \"content_hash\"");
    if (key != std::string::npos) text = text.substr(0, key) + "\n}\n";
  }
  write("in_map.json", text);
  const std::string out = "out.html";
  // Another number may be the same number: 0 for -0.
  (void)changed;
  return {as_old ? "tampered map of version 1.0" : "tampered map",
          with(mutate_.one_of(uses), "in_map.json", out),
          {"in_map.json"},
          {out}};
}

Campaign::Case Campaign::odd_option() {
  const Option& option = mutate_.one_of(options());
  std::vector<std::string> arguments = with(option.arguments, "", "out");
  arguments.push_back(std::string(option.name) + "=" + mutate_.odd_number());
  return {"odd option", arguments, {}, {"out"}};
}

void Campaign::kill_while_writing() {
  const std::array<int, 5> signals = {SIGKILL, SIGTERM, SIGINT, SIGHUP, SIGPIPE};
  const int signal_number = mutate_.one_of(signals);
  std::string program = "G21 G90\nG0 X0 Y0\n";
  for (int i = 0; i < 3000; ++i) program += fmt::format("G1 X{} Y{} F500\n", i % 700, i % 300);
  write("in_long.nc", program);
  const Case what{"stopped while writing",
                  {"gcode", "lengths", "in_long.nc", "--map", "map.json", "-o", "out"},
                  {"in_long.nc"},
                  {"out"}};
  const std::string old = "line,kind,x_mm,y_mm,z_mm,left_mm,right_mm,\n";
  write("out", old);
  const auto after = std::chrono::microseconds(mutate_.below(300'000));
  const Ended ended = command_.run(what.arguments, Stop{signal_number, after});
  count(what.kind, ended);
  const std::string now = content_of(at("out"));
  if (ended.signal_number != 0 && now != old && now.size() < 100'000)
    fail(what, "half a file", ended);
  // Nothing can be cleared away by a process that was killed outright.
  if (signal_number != SIGKILL && strays().size() != 2) fail(what, "left behind", ended);
  clean();
}

void Campaign::kill_a_sweep() {
  const Case what{"killed sweep", {"sweep", "sweep.json", "-o", "out", "--resume"}, {}, {"out"}};
  for (int i = 0; i < 2; ++i) {
    const auto after = std::chrono::microseconds(mutate_.below(1'500'000));
    count(what.kind, command_.run(what.arguments, Stop{SIGKILL, after}));
  }
  const Ended ended = command_.run(what.arguments);
  count(what.kind, ended);
  if (ended.code != 0) {
    fail(what, "could not be resumed", ended);
  } else if (content_of(at("out") / "results.csv") != sweep_results_) {
    fail(what, "other results than without the kills", ended);
  }
  clean();
}

void Campaign::script_in_a_page() {
  const std::array<std::string, 6> names = {"</script><script>alert(1)</script>",
                                            "\\\"><img src=x onerror=alert(1)>",
                                            "<!--",
                                            "]]></style>",
                                            "\\u003cscript\\u003ealert(1)",
                                            "${alert(1)}"};
  std::string grid = permanent_.at("grid.json");
  const std::string key = "\"name\": \"";
  const std::size_t begin = grid.find(key) + key.size();
  const std::string& name = mutate_.one_of(names);
  grid.replace(begin, grid.find('"', begin) - begin, name);
  write("in_grid.json", grid);
  Case what{"script in a page", {"fit", "in_grid.json", "-o", "in_map.json"}, {}, {}};
  count(what.kind, command_.run(what.arguments));
  const std::string odd = "in_<b>\xFF\xC3.json";  // no UTF-8, and a tag
  std::error_code error;
  fs::rename(at("in_map.json"), at(odd), error);
  what.arguments = {"report", odd, "-o", "out.html"};
  const Ended ended = command_.run(what.arguments);
  count(what.kind, ended);
  const std::string page = content_of(at("out.html"));
  if (ended.code != 0) {
    fail(what, "no page", ended);
  } else if (page.find("<script>alert") != std::string::npos ||
             page.find("<img src=x") != std::string::npos ||
             page.find("<b>\xFF") != std::string::npos) {
    fail(what, "a name that became part of the page", ended);
  } else if (page.find('\xFF') != std::string::npos) {
    fail(what, "a page that is no UTF-8", ended);
  }
  clean();
}

void Campaign::attack() {
  ++number_;
  const std::size_t kind = mutate_.below(100);
  if (kind < 62) return judge(damaged_input());
  if (kind < 76) return judge(tampered_map());
  if (kind < 92) return judge(odd_option());
  if (kind < 97) return kill_while_writing();
  if (kind < 98) return kill_a_sweep();
  return script_in_a_page();
}

}  // namespace chaintrue::torture
