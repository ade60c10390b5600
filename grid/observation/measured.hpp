// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All measurements of one machine: any mix of grids and sets of holes, file by file. Points and
/// distances are numbered through in the order of the files of their kind.
///
/// \code
///   Measured measured(grid);            // or a set of holes
///   measured.add(holes);
///   const auto answer = diagnosis::diagnose(measured);
/// \endcode
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "grid/observation/measured_grid.hpp"
#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid {

struct MeasuredFile {
  std::string name;  ///< in messages
  std::variant<MeasuredGrid, MeasuredHoles> measured;

  const MeasuredGrid* grid() const { return std::get_if<MeasuredGrid>(&measured); }
  const MeasuredHoles* holes() const { return std::get_if<MeasuredHoles>(&measured); }
  /// The machine that the file states, if any.
  const std::optional<Machine>& machine() const {
    return std::visit(
        [](const auto& own) -> const auto& { return own.machine; }, measured);
  }
};

class Measured {
 public:
  Measured() = default;
  Measured(MeasuredGrid grid) { add(std::move(grid)); }  // NOLINT: a grid is a measurement
  Measured(MeasuredHoles set) { add(std::move(set)); }   // NOLINT: and so are holes
  Measured(std::initializer_list<MeasuredFile> files) : files_(files) {}

  /// Without a given name they keep their own in messages.
  template <class Readings>
  void add(Readings own) {
    std::string name = own.name;
    files_.push_back({std::move(name), std::move(own)});
  }

  void add(MeasuredFile file) { files_.push_back(std::move(file)); }

  const std::vector<MeasuredFile>& files() const { return files_; }
  /// Those of one kind, in their order.
  std::vector<const MeasuredGrid*> grids() const { return of_kind<MeasuredGrid>(); }
  std::vector<const MeasuredHoles*> holes() const { return of_kind<MeasuredHoles>(); }
  /// Null if there is none.
  MeasuredGrid* first_grid() {
    for (MeasuredFile& file : files_) {
      if (auto* own = std::get_if<MeasuredGrid>(&file.measured)) return own;
    }
    return nullptr;
  }

  /// The name in the first file; empty if there is none.
  std::string name() const {
    if (files_.empty()) return {};
    return std::visit([](const auto& own) { return own.name; }, files_.front().measured);
  }

  /// The machine that the first file states.
  std::optional<Machine> machine() const {
    return files_.empty() ? std::nullopt : files_.front().machine();
  }

 private:
  template <class Kind>
  std::vector<const Kind*> of_kind() const {
    std::vector<const Kind*> result;
    for (const MeasuredFile& file : files_) {
      if (const auto* own = std::get_if<Kind>(&file.measured)) result.push_back(own);
    }
    return result;
  }

  std::vector<MeasuredFile> files_;
};

/// Whether two files hold the same readings at the same marks to the last digit: a copy, since two
/// sessions always differ by tenths of a millimetre.
bool same_readings(const MeasuredFile& one, const MeasuredFile& other);

/// The first setting that differs between two machines, in terms of the second file; empty if all
/// agree.
std::string difference_of_settings(const Machine& first, const Machine& other);

}  // namespace chaintrue::grid
