// SPDX-License-Identifier: GPL-3.0-or-later
#include "torture/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/inputs/input_folder.hpp"
#include "tests/inputs/invocations.hpp"
#include "torture/invocations.hpp"

namespace chaintrue::torture {
namespace {

namespace fs = std::filesystem;
using inputs::Option;

constexpr int kMisused = 2;  ///< the command's own exit codes
constexpr int kRefused = 3;

/// Paths without a file, or where none can be made.
const std::vector<std::string> kNoFiles = {"", "..", "nowhere/x", "-", std::string(300, 'x')};

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::string& in,
                              const std::string& out) {
  for (std::string& argument : arguments) {
    if (argument.starts_with("IN")) argument.replace(0, 2, in);
    if (argument == "OUT") argument = out;
  }
  return arguments;
}

std::string output_of(const std::vector<std::string>& arguments) {
  return arguments[0] == "report" ? "out.html" : "out";
}

/// Whether two texts are equal as JSON, except for comments; false if one is not JSON.
bool same_content(const std::string& a, const std::string& b) {
  using Json = nlohmann::json;
  const auto parsed = [](const std::string& text) {
    const auto leave_out_comments = [](int, Json::parse_event_t event, Json& value) {
      return event != Json::parse_event_t::key || value != "comment";
    };
    return Json::parse(text, leave_out_comments, false, true);
  };
  const Json first = parsed(a);
  return !first.is_discarded() && first == parsed(b);
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
  const auto help_of = [this](const std::string& verb) {
    std::istringstream words(verb + " --help");
    return command_.run({std::istream_iterator<std::string>(words), {}}).out;
  };
  for (const std::string& verb : inputs::verbs_in(help_of))
    options_[verb] = inputs::options_in(help_of(verb));
}

void Campaign::write(const std::string& name, const std::string& text) const {
  std::ofstream(at(name), std::ios::binary) << text;
}

void Campaign::prepare(const fs::path& fixtures) {
  for (const auto& [name, from] : copied_files()) fs::copy_file(fixtures / from, at(name));
  const inputs::InputFolder folder;
  for (const std::string& name : folder.names()) write(name, folder.text_of(name));
  if (command_.run({"sweep", "sweep.json", "-o", "whole"}).code != 0)
    throw std::runtime_error("the sweep could not be prepared");
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
    if (wrong.empty() && is_output && ended.code == kRefused && fs::is_regular_file(at(name)))
      wrong = "refused, and yet written: " + name;
    if (wrong.empty() && is_output && fs::is_regular_file(at(name))) {
      if (const std::string found = no_number_in(content_of(at(name))); !found.empty())
        wrong = "a number that is none in the output: " + found;
    }
  }
  if (wrong.empty() && what.must_be_refused && ended.code != kRefused && ended.code != kMisused)
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
  const std::string out = output_of(chosen->arguments);
  write(in, mutate_.damaged(permanent_.at(chosen->seed_file)));
  return {"damaged " + chosen->seed_file, with(chosen->arguments, in, out), {in}, {out}};
}

Campaign::Case Campaign::tampered_file() {
  const Reading reading = mutate_.one_of(readings_of_hashed_files());
  const std::string& original = permanent_.at(reading.seed_file);
  const std::string text = mutate_.with_number(
      original, mutate_.below(2) == 0 ? Mutator::NumberKind::odd : Mutator::NumberKind::near);
  // Another text may be the same number (0 for -0), and a comment may be anything.
  const bool must_be_refused = !same_content(text, original);
  const std::string in = "in_" + reading.seed_file;
  write(in, text);
  const std::string out = output_of(reading.arguments);
  return {"tampered " + reading.seed_file,
          with(reading.arguments, in, out),
          {in},
          {out},
          must_be_refused};
}

std::string Campaign::any_text(const Option& option) {
  std::vector<std::string> good =
      option.choices.empty() ? inputs::values_of(option.name) : option.choices;
  for (std::string& value : good) {
    if (value.starts_with('@')) value.erase(0, 1);
  }
  const std::size_t way = mutate_.below(10);
  if (way < 4 && !good.empty()) return mutate_.one_of(good);
  if (way < 6 && !good.empty()) return mutate_.damaged(mutate_.one_of(good));
  if (way < 8)
    return std::next(permanent_.begin(),
                     static_cast<std::ptrdiff_t>(mutate_.below(permanent_.size())))
        ->first;
  if (way < 9) return mutate_.odd_number();
  return mutate_.one_of(kNoFiles);
}

std::string Campaign::any_output(const Case& what) {
  switch (mutate_.below(4)) {
    case 0:
      return mutate_.one_of(kNoFiles);
    case 1: {  // a file that the command reads
      std::vector<std::string> read;
      for (const std::string& word : what.arguments) {
        if (permanent_.count(word) != 0) read.push_back(word);
      }
      if (!read.empty()) return mutate_.one_of(read);
      return "out";
    }
    case 2:
      return "out";
    default:
      return "out2.html";
  }
}

void Campaign::add(const Option& option, Case& what) {
  const auto stands =
      std::find_if(what.arguments.begin(), what.arguments.end(), [&](const std::string& word) {
        return word == option.name || (!option.short_name.empty() && word == option.short_name);
      });
  if (option.type.empty()) {
    if (stands == what.arguments.end()) what.arguments.push_back(option.name);
    return;
  }
  const auto value = [&] {
    if (inputs::is_output(option.name)) return any_output(what);
    return option.type == "TEXT" ? any_text(option) : mutate_.odd_number();
  };
  if (stands != what.arguments.end() && std::next(stands) != what.arguments.end()) {
    *std::next(stands) = value();
  } else if (option.values == 1) {
    what.arguments.push_back(option.name + "=" + value());
  } else {
    what.arguments.push_back(option.name);
    for (int i = 0; i < option.values; ++i) what.arguments.push_back(value());
  }
}

Campaign::Case Campaign::odd_options() {
  const auto& [verb, options] =
      *std::next(options_.begin(), static_cast<std::ptrdiff_t>(mutate_.below(options_.size())));
  std::vector<std::vector<std::string>> own;
  std::copy_if(calls().begin(),
               calls().end(),
               std::back_inserter(own),
               [&](const auto& arguments) { return verb_of(arguments) == verb; });
  const std::vector<std::string>& call = mutate_.one_of(own);
  Case what{"odd options, " + verb,
            with(call, "", output_of(call)),
            {},
            {"out", "out.html", "out2.html", "nowhere"}};
  for (std::string& word : what.arguments) {
    // A number by itself, or the line of a program.
    const std::size_t digits = word.find_first_of("0123456789", word.find(':') + 1);
    if (word.find_first_not_of("0123456789", digits) == std::string::npos && mutate_.below(2) == 0)
      word.replace(digits, std::string::npos, mutate_.odd_number());
  }
  if (options.empty()) return what;
  for (std::size_t left = 1 + mutate_.below(3); left > 0; --left)
    add(mutate_.one_of(options), what);
  return what;
}

void Campaign::resume_a_damaged_sweep() {
  const Case what{
      "damaged sweep, resumed", {"sweep", "sweep.json", "-o", "out", "--resume"}, {}, {"out"}};
  count(what.kind, command_.run({"sweep", "sweep.json", "-o", "out", "--shard", "1/2"}));
  std::vector<fs::path> parts;
  for (const auto& entry : fs::recursive_directory_iterator(at("out"))) {
    if (entry.is_regular_file()) parts.push_back(entry.path());
  }
  std::sort(parts.begin(), parts.end());
  const fs::path& part = mutate_.one_of(parts);
  std::ofstream(part, std::ios::binary) << mutate_.damaged(content_of(part));
  const Ended ended = command_.run(what.arguments);
  count(what.kind, ended);
  if (const std::string wrong = wrong_with(ended); !wrong.empty()) {
    fail(what, wrong, ended);
  } else if (ended.code == 0 && content_of(at("out") / "results.csv") != sweep_results_) {
    fail(what, "other results than without the damage", ended);
  }
  clean();
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
  // A process that was killed cannot remove its files.
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
  if (kind < 56) return judge(damaged_input());
  if (kind < 66) return judge(tampered_file());
  if (kind < 91) return judge(odd_options());
  if (kind < 96) return kill_while_writing();
  if (kind < 97) return kill_a_sweep();
  if (kind < 98) return resume_a_damaged_sweep();
  return script_in_a_page();
}

}  // namespace chaintrue::torture
