// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Everything but motion.
#include "tests/gcode_witness/support/program_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace chaintrue::witness {
namespace {

constexpr double kInchMm = 25.4;

std::string lower(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

}  // namespace

ProgramWriter::Plane ProgramWriter::axes() const {
  if (plane_ == 18) return {2, 0, 1};
  if (plane_ == 19) return {1, 2, 0};
  return {0, 1, 2};
}

void ProgramWriter::line(std::vector<std::string> words) {
  if (words.empty()) return;
  // Words may be in any order.
  if (random_.one_in(4))
    std::swap(
        words.front(),
        words[static_cast<std::size_t>(random_.whole(0, static_cast<int>(words.size()) - 1))]);
  std::string result = random_.one_in(12) ? fmt::format("N{} ", random_.whole(1, 99999)) : "";
  if (random_.one_in(40)) result = "/" + result;
  const bool blanks = !random_.one_in(6);
  for (const std::string& word : words) {
    if (!result.empty() && blanks) result += ' ';
    result += word;
    if (options_.scope == Scope::language && random_.one_in(60)) result += " (here)";
  }
  if (random_.one_in(30)) result += " ; so";
  plain(random_.one_in(8) ? lower(result) : result);
}

double ProgramWriter::rounded(double mm, int places) const {
  const double unit = inches_ ? kInchMm : 1.0;
  const double scale = std::pow(10.0, inches_ ? places + 1 : places);
  return std::round(mm / unit * scale) / scale * unit;
}

std::string ProgramWriter::written(double value, int places) {
  std::string text = fmt::format("{:.{}f}", value == 0.0 ? 0.0 : value, places);
  const std::size_t point = text.find('.');
  if (point != std::string::npos && random_.one_in(2)) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.') && random_.one_in(2)) text.pop_back();
  }
  if (text.starts_with("0.") && text.size() > 2 && random_.one_in(3)) text.erase(0, 1);
  if (text.starts_with("-0.") && text.size() > 3 && random_.one_in(3)) text.erase(1, 1);
  if (text.front() != '-' && random_.one_in(30)) text = "+" + text;
  if (text.front() != '-' && text.front() != '+' && random_.one_in(30)) text = "0" + text;
  return text;
}

std::string ProgramWriter::expression(double value, int places) {
  places = std::max(places, 1);  // as many as the part has
  const double part = random_.decimal(-20.0, 20.0, 1);
  const std::string whole = fmt::format("{:.{}f}", value, places);
  const std::string rest = fmt::format("{:.{}f}", value - part, places);
  switch (random_.whole(0, 7)) {
    case 0:
      return fmt::format("[{} + {}]", rest, part);
    case 1:
      return fmt::format("[{:.{}f} - [{}]]", value + part, places, part);
    case 2:
      return fmt::format("[{:.{}f} * 2]", value / 2.0, places + 1);
    case 3:
      return fmt::format("[[{}] * COS[0]]", whole);
    case 4:
      return fmt::format(
          "[{} + 0 * {}]", whole,
          random_.any({"SIN[33]", "SQRT[2]", "EXP[1]", "LN[3]", "ATAN[1]/[-2]", "FUP[1.2]"}));
    case 5:
      return fmt::format("[{} + [3 {} 3] - {}]", whole,
                         random_.any({"EQ", "GE", "LE", "AND", "OR"}), 1);
    case 6:
      return value < 0.0 ? fmt::format("-ABS[{}]", whole) : fmt::format("ABS[-{}]", whole);
    default:
      return fmt::format("[{} + 7 MOD 7 - 2**3 + 8 / 1]", whole);
  }
}

std::string ProgramWriter::number(char letter, double value, int places) {
  if (random_.one_in(14)) return fmt::format("{}{}", letter, expression(value, places));
  return fmt::format("{}{}", letter, written(value, places));
}

std::string ProgramWriter::length(char letter, double mm, int places) {
  return inches_ ? number(letter, mm / kInchMm, places + 1) : number(letter, mm, places);
}

std::string ProgramWriter::axis(std::size_t index, double to_mm, double& reached_mm, int places) {
  const double base = incremental_ ? place_[index] : 0.0;
  const double value = rounded(to_mm - base, places);
  reached_mm = base + value;
  return length("XYZ"[index], value, places);
}

std::vector<std::string> ProgramWriter::motion(const std::string& code) {
  const bool known = motion_ == code && !random_.one_in(4);
  motion_ = code;
  if (known) return {};
  return {random_.one_in(6) ? fmt::format("G0{}", code.substr(1)) : code};
}

void ProgramWriter::add_feed(std::vector<std::string>& words, double length_mm) {
  if (inverse_time_) {
    // Minutes for a move at some speed: LinuxCNC's own lower limit of the speed is far below.
    words.push_back(number('F', random_.between(300.0, 3000.0) / std::max(length_mm, 1.0), 2));
  } else if (random_.one_in(6)) {
    words.push_back(length('F', random_.decimal(100.0, 3000.0, 1), 1));
  }
}

std::array<double, 3> ProgramWriter::somewhere() {
  return {random_.between(-options_.half_width_mm, options_.half_width_mm),
          random_.between(-options_.half_height_mm, options_.half_height_mm),
          random_.between(-8.0, 8.0)};
}

void ProgramWriter::beginning() {
  const bool inches = random_.one_in(5);
  line({inches ? "G20" : "G21", "G90", random_.any({"G98", "G99"})});
  inches_ = inches;
  feed();
  go_somewhere();
}

std::string ProgramWriter::finish() {
  switch (random_.whole(0, 3)) {
    case 0:
      plain("M2");
      break;
    case 1:
      plain("M30");
      break;
    default:
      break;  // LinuxCNC gets an M2 after every program
  }
  return text_;
}

void ProgramWriter::go_somewhere() {
  const auto to = somewhere();
  std::vector<std::string> words = {"G90", "G0"};
  incremental_ = false;
  motion_ = "G0";
  for (std::size_t i = 0; i < 3; ++i) words.push_back(axis(i, to[i], place_[i]));
  line(std::move(words));
}

void ProgramWriter::plane() {
  plane_ = random_.one_in(2) ? 17 : random_.whole(17, 19);
  line({fmt::format("G{}", plane_)});
}

void ProgramWriter::units() {
  const bool inches = !inches_;
  line({inches ? "G20" : "G21"});
  inches_ = inches;
}

void ProgramWriter::distance_mode() {
  incremental_ = !incremental_;
  line({incremental_ ? "G91" : "G90"});
}

void ProgramWriter::centre_mode() {
  absolute_centres_ = !absolute_centres_;
  line({absolute_centres_ ? "G90.1" : "G91.1"});
}

void ProgramWriter::inverse_time() {
  if (!inverse_time_) {
    line({"G93"});
    inverse_time_ = true;
    return;
  }
  std::vector<std::string> words = {"G94"};
  inverse_time_ = false;
  words.push_back(length('F', random_.decimal(100.0, 2000.0, 1), 1));
  line(std::move(words));
}

void ProgramWriter::feed() {
  if (!inverse_time_) line({length('F', random_.decimal(50.0, 4000.0, 2), 2)});
}

void ProgramWriter::spindle() {
  spindle_on_ = !random_.one_in(3);
  std::vector<std::string> words;
  if (random_.one_in(2)) words.push_back(number('S', random_.decimal(0.0, 24000.0, 2), 2));
  words.push_back(spindle_on_ ? random_.any({"M3", "M4", "M03"}) : "M5");
  line(std::move(words));
}

void ProgramWriter::coolant() { line({random_.any({"M7", "M8", "M9", "M08"})}); }

void ProgramWriter::tool() {
  std::vector<std::string> words;
  if (!random_.one_in(3)) words.push_back(fmt::format("T{}", random_.whole(1, 20)));
  if (!words.empty() && random_.one_in(2)) {
    words.push_back("M6");
    spindle_on_ = false;  // the spindle stops for a tool change
  }
  if (random_.one_in(4)) words.push_back(random_.any({"G43 H1", "G49", "G40"}));
  const bool changes = words.size() > 1 && words[1] == "M6";
  if (changes) go_somewhere();  // LinuxCNC's Python module loses its position after an arc
  line(std::move(words));
  if (changes) go_somewhere();
}

void ProgramWriter::dwell() {
  line({"G4", number('P', random_.decimal(0.0, 2.0, random_.whole(0, 6)), 6)});
}

void ProgramWriter::remark() {
  plain(random_.any(
      {"(a remark)", "; a remark", "(msg, look here)", "", "(one) (two)", "   ", "(debug, #1)"}));
}

void ProgramWriter::path_control() {
  line({random_.any({"G61", "G64", "G64 P0.1", "G64 P0.05 Q0.1", "G61.1", "G97", "G40 G49"})});
}

void ProgramWriter::assignment() {
  const int index = random_.whole(1, 20);
  const double value = random_.decimal(-50.0, 50.0, 2);
  line(
      {fmt::format("#{}={}", index, random_.one_in(2) ? expression(value, 2) : written(value, 2))});
  if (random_.one_in(2)) return;
  if (options_.scope == Scope::language && random_.one_in(2)) {
    const std::string name = random_.any({"<depth>", "<_Width>", "<a b>"});
    plain(fmt::format("#{}=[#{} / 2 + #{}]", name, index, random_.whole(1, 30)));
    plain(fmt::format("G90 G1 Y#{}{}", name, inverse_time_ ? " F60" : ""));
  } else {
    plain(fmt::format("G90 G1 X#{}{}", index, inverse_time_ ? " F60" : ""));
  }
  incremental_ = false;
  go_somewhere();
}

/// G10 L2 and L20, G54 to G59.3.
void ProgramWriter::work_offset() {
  static constexpr const char* kSystems[] = {"G54", "G55",   "G56",   "G57",  "G58",
                                             "G59", "G59.1", "G59.2", "G59.3"};
  const int system = random_.whole(1, 9);
  const bool from_here = options_.scope == Scope::language && random_.one_in(3) && !probed_;
  std::vector<std::string> words = {"G10", from_here ? "L20" : "L2",
                                    fmt::format("P{}", random_.one_in(4) ? 0 : system)};
  for (const char letter : {'X', 'Y', 'Z'}) {
    if (random_.one_in(3)) continue;
    words.push_back(
        length(letter, letter == 'Z' ? random_.between(-2.0, 2.0) : random_.between(-40.0, 40.0)));
  }
  if (!from_here && random_.one_in(3))
    words.push_back(number('R', random_.decimal(-40.0, 40.0, 1), 1));
  if (!random_.one_in(4)) line(std::move(words));
  if (!random_.one_in(3)) line({kSystems[system - 1]});
  go_somewhere();
}

/// G92 and, beyond NIST's language, G52.
void ProgramWriter::axis_offset() {
  if (random_.one_in(3)) {
    line({random_.any({"G92.1", "G92.2", "G92.3"})});
  } else {
    std::vector<std::string> words = {
        options_.scope == Scope::language && random_.one_in(3) ? "G52" : "G92"};
    // From a nearby position, so that the offset is small.
    const bool here = words.front() == "G92";
    for (std::size_t i = 0; i < 2; ++i) {
      words.push_back(length("XYZ"[i], (here ? place_[i] : 0.0) + random_.between(-20.0, 20.0)));
      if (random_.one_in(3)) break;
    }
    line(std::move(words));
  }
  go_somewhere();
}

void ProgramWriter::home() {
  const std::string which = random_.any({"G28", "G30"});
  if (!random_.one_in(3)) line({which + ".1"});
  straight();
  std::vector<std::string> words = {which};
  for (std::size_t i = 0; i < 3; ++i) {
    double ignored = 0.0;
    if (random_.one_in(3)) words.push_back(axis(i, somewhere()[i], ignored));
  }
  line(std::move(words));
  go_somewhere();
}

void ProgramWriter::override_or_output() {
  plain(random_.any({"M48", "M49", "M50 P1", "M51 P0", "M52 P1", "M53 P0", "M62 P1", "M63 P0",
                     "M64 P2", "M65 P2", "M67 E0 Q1.5", "M68 E1 Q0", "M0", "M1", "M60"}));
  if (!random_.one_in(8)) return;
  plain("M61 Q3");
  go_somewhere();
}

std::string ProgramWriter::label() {
  const int number = labels_++;
  return random_.one_in(3) ? fmt::format("o<part {}>", number) : fmt::format("o{}", number);
}

void ProgramWriter::condition() {
  const std::string o = label();
  const std::string feed = inverse_time_ ? " F30" : "";
  plain(fmt::format("{} if [#{} {} {}]", o, random_.whole(1, 20),
                    random_.any({"GT", "LT", "EQ", "NE", "GE", "LE"}), random_.whole(-20, 20)));
  plain("G90 G1 X5" + feed);
  if (random_.one_in(2)) plain(fmt::format("{} elseif [#{} AND 1]", o, random_.whole(1, 20)));
  plain("G1 Y7" + feed);
  if (random_.one_in(2)) plain(o + " else");
  plain("G1 Z-1" + feed);
  plain(o + " endif");
  go_somewhere();
}

void ProgramWriter::loop() {
  const std::string o = label();
  const std::string feed = inverse_time_ ? " F30" : "";
  const int times = random_.whole(0, 4);
  switch (random_.whole(0, 2)) {
    case 0:
      plain(fmt::format("{} repeat [{}]", o, times));
      plain(
          fmt::format("G91 G1 X{} Y[{} / 2]{}", random_.whole(-5, 5), random_.whole(-5, 5), feed));
      plain(o + " endrepeat");
      break;
    case 1:
      plain("#30=0");
      plain(fmt::format("{} while [#30 LT {}]", o, times));
      plain("#30=[#30 + 1]");
      if (random_.one_in(2))
        plain(fmt::format("{0} if [#30 EQ 2]\n{1} {2}\n{0} endif", label(), o,
                          random_.any({"break", "continue"})));
      plain("G90 G1 X[#30 * 3]" + feed);
      plain(o + " endwhile");
      break;
    default:
      plain("#31=0");
      plain(o + " do");
      plain("G90 G1 Y#31" + feed);
      plain("#31=[#31 + 1.5]");
      plain(fmt::format("{} while [#31 LE {}]", o, times));
  }
  go_somewhere();
}

void ProgramWriter::subroutine() {
  const std::string o = label();
  const std::string feed = inverse_time_ ? " F30" : "";
  plain(o + " sub");
  plain("G90 G1 X#1 Y[#2 + #3]" + feed);
  if (random_.one_in(2)) plain(fmt::format("{} return [#1 * 2]", o));
  plain(o + " endsub");
  const int calls = random_.whole(0, 3);
  for (int i = 0; i < calls; ++i) {
    std::string call = o + " call";
    for (int k = random_.whole(0, 3); k > 0; --k)
      call += fmt::format(" [{}]", random_.whole(-30, 30));
    plain(call);
    if (random_.one_in(2)) plain("G1 Z[#<_value> / 20]" + feed);
  }
  go_somewhere();
}

}  // namespace chaintrue::witness
