// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The modal interpreter: converts blocks to moves in the machine frame.
///
/// RS274/NGC as LinuxCNC 2.9 executes it: within a block in a fixed order, not from left to right
/// (comments, feed mode, F, S, T, M6, spindle, coolant, dwell, plane, units, tool length,
/// coordinate system, distance mode, retract mode, offsets, motion, stop). docs/gcode.md lists the
/// differences from LinuxCNC and their reasons.
///
/// Not thread safe; one interpreter runs one program. Program (program.hpp) drives it.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <set>
#include <vector>

#include "tools/gcode/block.hpp"
#include "tools/gcode/events.hpp"
#include "tools/gcode/value_reader.hpp"

namespace chaintrue::gcode {

/// Properties of a file that the user states because the file does not.
struct Dialect {
  /// Added to X and Y of the program's places, which makes them places of the sheet.
  std::array<double, 2> home_mm{};
  /// Lines that begin with a slash are skipped, as with the controller's block delete switch on.
  bool skip_deletable_blocks = false;
  /// The tool table has zeros, so G41 and G42 have no effect. Otherwise they are rejected.
  bool tools_have_no_diameter = false;
  /// A line with one of a plotter's own codes (plotter_codes.hpp) is passed on; otherwise it is rejected.
  bool passes_plotter_codes = false;
  /// G28 and G30 go to the machine's zero, which is the program's.
  bool home_is_zero = false;
  /// Where a plotter's controller is after G28, X and Y in the program's frame.
  std::optional<std::array<double, 2>> plotter_home_mm;
  /// Limit on lines read again in loops and subroutines plus moves of canned cycles; beyond it the
  /// program is rejected as endless.
  std::uint64_t step_budget = 10'000'000;
};

/// X, Y, Z in mm, A, B, C in degrees.
using Axes = std::array<double, 6>;

/// Rotation of a coordinate system about Z: cosine and sine.
using Turn = std::complex<double>;

class Interpreter {
 public:
  /// Keeps references to the block passed to each execute() and to the sink.
  Interpreter(const Dialect& dialect, const Block& block, Sink& sink);
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  void execute(const std::vector<CommentText>& comments);

  Parameters& parameters() { return parameters_; }
  const Dialect& dialect() const { return dialect_; }
  /// A code and its words, unchanged.
  void pass(Code code, std::string_view words = {}) const;
  /// A plotter's own code, or M0 with a text, which is passed on unchanged.
  void pass_line(const std::vector<CommentText>& comments, Code code, std::string_view words);
  /// Notes on the program as a whole, at its end.
  void note_whole(std::size_t last_line);
  /// Counts one step against the budget.
  void step(Place place);
  /// The nesting of subroutines, for #<_call_level>.
  void set_call_level(std::size_t level) { call_level_ = level; }

  /// For `explain`: the modal state in words, one line for each item.
  std::vector<std::string> describe() const;

 private:
  struct Modes {
    int motion = g::no_motion;  ///< tenths, as in the tables of codes
    int plane = g::plane_xy;
    int system = 1;  ///< 1 is G54, 9 is G59.3
    bool inches = false;
    bool incremental = false;
    bool absolute_centres = false;
    bool retract_to_r = false;
    FeedMode feed_mode = FeedMode::per_minute;
    double feed = 0.0;  ///< mm/min, or 1/min for the block at hand
    double spindle_rpm = 0.0;
    int spindle = 0;  ///< 3, 4 or 0
    long tool = 0;
    long selected_tool = 0;
  };
  /// machine = origin + rotation (program + offset)
  struct Frame {
    Axes origin{};
    Axes offset{};
    double rotation_deg = 0.0;
    Turn turn = 1.0;
  };
  struct Sticky {
    int plane = g::plane_xy;
    double start = 0.0;  ///< height at the start of the row of cycles
    double r = 0.0;      ///< as written, in mm
    double depth = 0.0;
    double p = 0.0;
    double q = 0.0;
  };
  struct Cycle;

  // interpreter.cpp: the order of execution.
  void comments(const std::vector<CommentText>& texts);
  int motion_to_be() const;
  void set_feed(int motion);
  void set_modes();
  void assign();
  /// Remarks of one name are made once a program.
  /// At the block.
  void note(std::string_view name, std::string sentence,
            std::optional<ProblemName> problem = {}) const;
  void note_once(std::string_view name, std::string sentence,
                 std::optional<ProblemName> problem = {});
  void note_deletable();
  void check_assignments() const;
  std::string written_out(std::string_view text) const;

  // interpreter_words.cpp: which code a block's words belong to, and words that are passed through.
  void check_words(int motion) const;
  void pass_words();
  void dwell();
  void tool_length();
  /// With the words of the block that belong to it, lengths in mm of a unit.
  void pass_with_words(const KnownCode& code, double unit = 1.0) const;

  // interpreter_offsets.cpp: coordinate systems, G10, G28, G30, G52, G92.
  void select_system(int system);
  Axes stored(int first) const;
  void store(int first, const Axes& axes);
  void once();
  void set_system();
  void set_offset();
  void cancel_offset(bool forget);
  void go_home(int first_parameter);
  void store_home(int first_parameter);
  void needs_known_z() const;
  void refresh_frame();
  Axes to_machine(const Axes& program) const;
  Axes to_program(const Axes& machine) const;

  // interpreter_motion.cpp
  void move(int motion);
  Axes target() const;
  /// In mm, or degrees.
  double axis_value(std::size_t axis) const;
  void machine_height(int motion);
  void pass_height(std::string text, Code code);
  void check_start(int motion);
  void check_height(const Axes& machine) const;
  void polar(Axes& program) const;
  void run(Move move, const Axes& machine);
  void straight(MoveKind kind, const Axes& machine);
  void probe();
  double length(char letter) const { return block_.value(letter) * mm_per_unit(); }
  double mm_per_unit() const { return modes_.inches ? 25.4 : 1.0; }
  Point on_sheet(const Axes& machine) const;
  Move basic_move(MoveKind kind, const Axes& to) const;

  // interpreter_arcs.cpp
  void arc(bool clockwise);

  // interpreter_cycles.cpp
  void cycle(int motion);

  // interpreter_state.cpp
  std::string system_name() const;
  /// In the program's units.
  Axes position() const;
  /// Value of a predefined name (#<_x> ..).
  std::optional<double> state(std::string_view name) const;

  Dialect dialect_;
  const Block& block_;
  Sink& sink_;
  Parameters parameters_;
  Modes modes_;
  Frame frame_;
  Sticky sticky_;
  Axes machine_{};  ///< the machine's position
  std::uint64_t steps_ = 0;
  std::size_t call_level_ = 0;
  std::set<int> known_homes_;  ///< by their first parameter
  std::set<std::string_view> noted_;
  bool units_stated_ = false;
  bool placed_[2] = {false, false};  ///< the program has stated X, Y
  bool moves_ = false;
  bool z_unknown_ = false;     ///< after probing, and after a height in the machine's own frame
  bool z_is_machine_ = false;  ///< the latter
  std::size_t arcs_ = 0;       ///< but whole circles
  std::size_t long_arcs_ = 0;
  std::size_t first_long_arc_ = 0;
};

}  // namespace chaintrue::gcode
