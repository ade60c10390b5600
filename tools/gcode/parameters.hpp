// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parameters of a program: numbered ones (#1 .. #5602), named ones (#<name> local to a
/// subroutine, #<_name> global), and those that give the interpreter's state.
///
/// Lengths in #5161-#5390 are in mm for every unit of the program, as in LinuxCNC on a metric
/// machine.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::gcode {

/// Indices with a meaning. Coordinate system p (1 .. 9) has its X origin at kFirstSystem + 20 (p -
/// 1), then Y, Z, A, B, C, U, V, W, and its rotation in degrees at index X + 9.
namespace parameter {
inline constexpr int kProbe = 5061;
inline constexpr int kHome = 5161;
inline constexpr int kSecondHome = 5181;
inline constexpr int kOffsetOn = 5210;
inline constexpr int kOffset = 5211;
inline constexpr int kSystem = 5220;
inline constexpr int kFirstSystem = 5221;
inline constexpr int kPosition = 5420;
inline constexpr int kCount = 5603;
}  // namespace parameter

class Parameters {
 public:
  /// Return the values that depend on the interpreter's state: of a number (5420 ..) or a
  /// predefined name.
  using StateByNumber = std::function<std::optional<double>(int)>;
  using StateByName = std::function<std::optional<double>(std::string_view)>;

  Parameters();
  void follow(StateByNumber by_number, StateByName by_name);

  /// \param index 1 .. kCount - 1.
  [[nodiscard]] double get(int index) const;
  void set(int index, double value);
  [[nodiscard]] bool writable(int index) const;
  [[nodiscard]] static bool exists(int index) { return index > 0 && index < parameter::kCount; }
  /// The stored value, in mm if it is a length; without the interpreter's state.
  [[nodiscard]] double stored(int index) const { return values_[static_cast<std::size_t>(index)]; }

  [[nodiscard]] std::optional<double> get(std::string_view name) const;
  /// False if the name is predefined and read-only.
  [[nodiscard]] bool set(std::string_view name, double value);

  /// Enters a subroutine: its #1 .. #30 are the arguments, and its local names start empty.
  void enter(const std::vector<double>& arguments);
  void leave();

 private:
  using Names = std::map<std::string, double, std::less<>>;
  static constexpr std::size_t kArguments = 30;
  struct Frame {
    std::array<double, kArguments> saved{};
    Names names;
  };

  std::vector<double> values_;
  Names global_;
  std::vector<Frame> frames_;
  StateByNumber state_by_number_;
  StateByName state_by_name_;
};

}  // namespace chaintrue::gcode
