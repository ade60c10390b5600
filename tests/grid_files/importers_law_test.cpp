// SPDX-License-Identifier: GPL-3.0-or-later
// Every importer honours or names every number: known files, fixtures and public reports' kinds, with each
// number changed in turn.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <regex>
#include <sstream>

#include "grid/files/belts_file.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/plotter_file.hpp"
#include "grid/files/plotter_settings.hpp"
#include "grid/files/whole_file.hpp"
#include "model/effects/effect.hpp"

namespace chaintrue::grid::files {
namespace {

const std::filesystem::path kFixtures = CHAINTRUE_FIXTURES;
const std::filesystem::path kReports = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "reports";

/// The result of reading a text, and its messages.
struct Answer {
  std::string written;
  std::string said;
  bool is_refused = false;
};

using Importer = std::function<Answer(const std::string& text)>;

std::string sentences_of(const std::vector<Warning>& warnings) {
  std::string said;
  for (const Warning& warning : warnings) said += warning.place + " " + warning.sentence + "\n";
  return said;
}

/// Refusals become answers.
Importer importer(std::function<Answer(const std::string&)> read) {
  return [read = std::move(read)](const std::string& text) {
    try {
      return read(text);
    } catch (const InputError& error) {
      return Answer{"", error.what(), true};
    }
  };
}

Importer machine_importer(ReadMachine (*parse)(const std::string&, const std::string&)) {
  return importer([parse](const std::string& text) {
    const ReadMachine read = parse(text, "any");
    return Answer{write_machine(read.machine), sentences_of(read.warnings)};
  });
}

ReadMachine parse_ini(const std::string& text, const std::string& file) {
  return parse_groundcontrol(text, file);
}

const Importer kGroundcontrol = machine_importer(parse_ini);
const Importer kWebcontrol = machine_importer(parse_webcontrol);
const Importer kFluidnc = machine_importer(parse_fluidnc);
const Importer kPlotter = importer([](const std::string& text) {
  const ReadPlotter read = parse_plotter_settings(text, "any");
  return Answer{write_plotter(read.plotter), sentences_of(read.warnings)};
});

Answer of_maslow4(const std::string& log, const std::string& settings) {
  Maslow4Options options;
  options.settings_file = "any";
  if (!settings.empty()) options.settings = settings;
  const Maslow4Import read = parse_maslow4(log, "any", options);
  std::string said = sentences_of(read.warnings);
  for (const std::string& sentence : read.assumed) said += sentence + "\n";
  for (const LoggedRun& run : read.runs) said += fmt::format("run from line {}\n", run.line);
  return {write_belts(read.belts), said + read.stopped.value_or("")};
}

const std::string& good_log() {
  static const std::string log = read_whole_file(kFixtures / "good" / "maslow4_log.txt");
  return log;
}

const Importer kMaslow4Log = importer([](const std::string& text) { return of_maslow4(text, ""); });
const Importer kMaslow4Settings =
    importer([](const std::string& text) { return of_maslow4(good_log(), text); });

struct KnownFile {
  std::string name;
  std::string text;
  const Importer* importer = nullptr;
};

constexpr const char* kWebcontrolText = R"({
  "Maslow Settings": [
    {"key": "bedWidth", "value": "2438.4"},
    {"key": "bedHeight", "value": "1219.2"},
    {"key": "motorSpacingX", "value": "2978.4"},
    {"key": "motorOffsetY", "value": "463"}
  ],
  "Advanced Settings": [
    {"key": "kinematicsType", "value": "Triangular"},
    {"key": "rotationRadius", "value": "139.1"},
    {"key": "chainOverSprocket", "value": "Top"},
    {"key": "chainPitch", "value": 6.35},
    {"key": "gearTeeth", "value": "10"},
    {"key": "encoderSteps", "value": "8113.73"},
    {"key": "chainLength", "value": "3360"},
    {"key": "topBeamTilt", "value": "0.1"},
    {"key": "maxFeedrate", "value": "800"}
  ],
  "Camera Settings": [{"key": "videoSize", "value": "640"}]
})";

constexpr const char* kFluidncText = R"(board: 6 Pack
kinematics:
  WallPlotter:
    left_anchor_x: -1489.2
    left_anchor_y: 1072.6
    right_anchor_x: 1489.2
    right_anchor_y: 1072.6
    segment_length: 10
axes:
  x:
    steps_per_mm: 80
    max_travel_mm: 2438.4
  y:
    steps_per_mm: 80
    max_travel_mm: 1219.2
    motor0:
      pulloff_mm: 4
)";

std::vector<KnownFile> known_files() {
  std::vector<KnownFile> files = {{"webcontrol.json", kWebcontrolText, &kWebcontrol},
                                  {"fluidnc.yaml", kFluidncText, &kFluidnc}};
  const auto add = [&](const std::filesystem::path& path, const Importer& own) {
    if (std::filesystem::exists(path))
      files.push_back({path.filename().string(), read_whole_file(path), &own});
  };
  add(kFixtures / "machines" / "maslow.yaml", kMaslow4Settings);
  add(kFixtures / "good" / "maslow4_log.txt", kMaslow4Log);
  for (const char* name : {"groundcontrol_ring.ini", "groundcontrol_brackets.ini"})
    add(kFixtures / "good" / name, kGroundcontrol);
  for (const char* name :
       {"configuration.h", "fluidnc.yaml", "marlin_log.txt", "mural.txt", "polargraph.properties"})
    add(kFixtures / "good" / fmt::format("plottersettings_{}", name), kPlotter);
  for (const char* name :
       {"11_encodersteps.ini", "12_groundcontrol_2016.ini", "13_quadrilateral.ini"})
    add(kReports / name, kGroundcontrol);
  for (const char* name : {"03_marlin_home.h", "07_marlin_reach.h"}) add(kReports / name, kPlotter);
  add(kReports / "16_old_layout.yaml", kMaslow4Settings);
  add(kReports / "16_old_layout.log", kMaslow4Log);
  return files;
}

struct FoundNumber {
  std::size_t at = 0, length = 0;
  std::string line;
  /// Its section, or its YAML path: "axes/y/motor0/".
  std::string folder;
};

std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Follows the folders line by line.
class Folders {
 public:
  std::string at(const std::string& line) {
    static const std::regex section(R"re(^\[(.*)\]$|^\s*"(.* Settings)": \[.*)re");
    static const std::regex yaml_key(R"(^( *)(\w+):)");
    std::smatch match;
    if (std::regex_match(line, match, section)) {
      section_ = in_lower_case(match[1].matched ? match[1] : match[2]) + "/";
    } else if (std::regex_search(line, match, yaml_key)) {
      const auto indent = static_cast<std::size_t>(match.length(1));
      while (!keys_.empty() && keys_.back().first >= indent) keys_.pop_back();
      std::string folder;
      for (const auto& [depth, key] : keys_) folder += key + "/";
      keys_.emplace_back(indent, in_lower_case(match[2]));
      return folder;
    }
    return section_;
  }

 private:
  std::string section_;
  std::vector<std::pair<std::size_t, std::string>> keys_;
};

/// Redundant lines of a log: which waypoint is next, and where all are.
bool is_said_again(const std::string& line) {
  return line.find("Measured waypoint") != std::string::npos ||
         line.find("Waypoints [") != std::string::npos ||
         line.find("perAnchor") != std::string::npos;
}

/// For lines that are no comments; not those within words.
std::vector<FoundNumber> numbers_of(const std::string& text) {
  static const std::regex number(R"((^|[^\w.])([-+]?\d+(\.\d+)?)(?![\w.]))");
  std::vector<FoundNumber> found;
  std::istringstream lines(text);
  std::size_t begin = 0;
  Folders folders;
  for (std::string line; std::getline(lines, line); begin += line.size() + 1) {
    const std::string code = line.substr(0, line.find("//"));
    const std::string folder = folders.at(code);
    const std::size_t first = code.find_first_not_of(" \t");
    if (first == std::string::npos || code[first] == ';' || code.compare(first, 2, "# ") == 0 ||
        is_said_again(code))
      continue;
    for (std::sregex_iterator it(code.begin(), code.end(), number), end; it != end; ++it) {
      found.push_back({begin + static_cast<std::size_t>(it->position(2)),
                       static_cast<std::size_t>(it->length(2)), line, folder});
    }
  }
  return found;
}

/// "Waypoint 7": the number is a name.
bool is_label(const std::string& text, const FoundNumber& number) {
  constexpr std::string_view kBefore = "Waypoint ";
  return text.substr(0, number.at).ends_with(kBefore);
}

/// Ignored settings are listed by key, or by a folder that contains them; lines of a log that hold
/// neither a reading nor a place are named together.
bool is_named(const std::string& said, const FoundNumber& number) {
  const bool may_count = number.line.find("CLBM") != std::string::npos ||
                         number.line.find("coordinates:") != std::string::npos;
  if (said.find("others like it") != std::string::npos && !may_count) return true;
  const std::size_t passed = said.find("ignored, because");
  const std::string names = in_lower_case(passed == std::string::npos ? "" : said.substr(passed));
  for (std::size_t end = number.folder.find('/'); end != std::string::npos;
       end = number.folder.find('/', end + 1)) {
    if (names.find("all of " + number.folder.substr(0, end)) != std::string::npos) return true;
  }
  static const std::regex word(R"([A-Za-z_][\w.]*)");
  for (std::sregex_iterator it(number.line.begin(), number.line.end(), word), end; it != end;
       ++it) {
    const std::string name = in_lower_case(it->str());
    if (name != "key" && name != "value" && names.find(name) != std::string::npos) return true;
  }
  return false;
}

std::string with_another_digit(std::string digits) {
  char& last = digits.back();
  last = last == '9' ? '8' : static_cast<char>(last + 1);
  return digits;
}

TEST(Importers, HonourOrNameEveryNumber) {
  std::size_t tried = 0;
  for (const KnownFile& file : known_files()) {
    const Answer plain = (*file.importer)(file.text);
    EXPECT_FALSE(plain.is_refused) << file.name << ": " << plain.said;
    for (const FoundNumber& number : numbers_of(file.text)) {
      if (is_label(file.text, number)) continue;
      const std::string digits = file.text.substr(number.at, number.length);
      // A little larger, and, for numbers that only bound others, far too small and far too large.
      const bool is_whole = digits.find('.') == std::string::npos;
      const bool is_honoured = [&] {
        for (const std::string& other : {is_whole ? with_another_digit(digits) : digits + "1",
                                         std::string("0.01"), "9" + digits}) {
          std::string text = file.text;
          text.replace(number.at, number.length, other);
          const Answer changed = (*file.importer)(text);
          if (changed.is_refused || changed.written != plain.written ||
              changed.said != plain.said || is_named(changed.said, number))
            return true;
        }
        return false;
      }();
      ++tried;
      EXPECT_TRUE(is_honoured) << file.name << ": nothing changes with " << digits << " in "
                               << number.line << ", and nothing says why:\n"
                               << plain.said;
    }
  }
  EXPECT_GT(tried, 200U);
}

/// For any input an importer returns numbers, or refuses with the file's name.
TEST(Importers, AnswerOrRefuseEveryFile) {
  std::size_t answered = 0, refused = 0;
  static const std::regex no_number(R"(\b(nan|inf)\b)", std::regex::icase);
  for (const auto& folder :
       {kFixtures, kReports, kReports.parent_path() / "gcode", kReports.parent_path() / "maslow4",
        kReports.parent_path() / "repro"}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      constexpr std::uintmax_t kLargest =
          40'000;  // bytes: larger ones are maps, programs and their moves
      if (!entry.is_regular_file() || entry.file_size() > kLargest) continue;
      const std::string text = read_whole_file(entry.path());
      for (const Importer* importer :
           {&kGroundcontrol, &kWebcontrol, &kFluidnc, &kPlotter, &kMaslow4Log, &kMaslow4Settings}) {
        const Answer answer = (*importer)(text);
        (answer.is_refused ? refused : answered) += 1;
        EXPECT_EQ(answer.written.empty(), answer.is_refused) << entry.path();
        EXPECT_TRUE(!answer.is_refused || answer.said.find("any") != std::string::npos)
            << entry.path() << ": " << answer.said;
        EXPECT_FALSE(std::regex_search(answer.written, no_number)) << entry.path();
      }
    }
  }
  EXPECT_GT(answered, 20U);
  EXPECT_GT(refused, 500U);
}

}  // namespace
}  // namespace chaintrue::grid::files
