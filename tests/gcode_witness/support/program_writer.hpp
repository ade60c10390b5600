// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Writes one random program, statement by statement, and tracks its position.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "tests/gcode_witness/support/program_generator.hpp"
#include "tests/gcode_witness/support/random.hpp"

namespace chaintrue::witness {

class ProgramWriter {
 public:
  ProgramWriter(Random& random, const GeneratorOptions& options)
      : random_(random), options_(options) {}

  void beginning();
  /// The program's end and its text.
  std::string finish();

  // program_writer_motion.cpp
  void straight();
  void arc_by_centre();
  void arc_by_radius();
  void whole_circle();
  void cycle();
  void machine_move();
  void polar();
  void probe();

  // program_writer.cpp
  void plane();
  void units();
  void distance_mode();
  void centre_mode();
  void inverse_time();
  void feed();
  void spindle();
  void coolant();
  void tool();
  void dwell();
  void remark();
  void path_control();
  void work_offset();
  void axis_offset();
  void home();
  void assignment();
  void override_or_output();
  void condition();
  void loop();
  void subroutine();

 private:
  /// Indices of the plane's axes, first x second = normal.
  struct Plane {
    std::size_t first, second, normal;
  };
  Plane axes() const;

  /// A line: words in any order with the same meaning, with or without blanks, N and comments.
  void line(std::vector<std::string> words);
  /// A line that is written unchanged.
  void plain(const std::string& text) { text_ += text + "\n"; }
  /// `X12.5` of a length in mm, in the units in force.
  std::string length(char letter, double mm, int places = 3);
  std::string number(char letter, double value, int places = 3);
  std::string written(double value, int places);
  std::string expression(double value, int places);
  /// The value in mm as rounded by length().
  double rounded(double mm, int places = 3) const;
  /// The axis word for a move to a position, and the position actually reached.
  std::string axis(std::size_t index, double to_mm, double& reached_mm, int places = 3);
  /// The G word; empty if the mode is in force already.
  std::vector<std::string> motion(const std::string& code);
  /// F if inverse time needs it.
  void add_feed(std::vector<std::string>& words, double length_mm);
  std::array<double, 3> somewhere();
  void arc_to(double centre_first, double centre_second, double sweep, bool whole, int turns);
  /// Moves to a known position, in G90.
  void go_somewhere();
  std::string label();

  Random& random_;
  GeneratorOptions options_;
  std::string text_;
  std::array<double, 3> place_{};  ///< in the program's frame, mm
  int plane_ = 17;
  bool inches_ = false;
  bool incremental_ = false;
  bool absolute_centres_ = false;
  bool inverse_time_ = false;
  bool spindle_on_ = false;
  std::string motion_;
  int labels_ = 100;
  bool probed_ = false;
};

}  // namespace chaintrue::witness
