// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parts of chaintrue fit: maps of two chains, anchors of four belts, settings of a V-plotter.
#pragma once

#include <optional>
#include <string>

#include "tools/cli/input_file.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

struct FitCommand {
  GridInput input;
  TapeOptions tape;
  /// Further files of the same machine.
  Words with;
  std::string output;
  std::string surface = "residual";
  std::string ends = "not_a_knot";
  OutsideOption outside;
  /// On the machine as stated, without a search for causes.
  bool plain = false;
  bool accept_class = false;
  /// The error of the tool that the owner wishes for.
  std::optional<double> wish_mm;
  std::string without;  ///< points of belts, from 1
  bool verbose = false;
  bool json = false;

  Detail detail() const { return verbose ? Detail::verbose : Detail::always; }
};

/// Writes the result to its file, `json` to standard output where it is asked for, and the document
/// to standard error.
void write_fitted(const FitCommand& command, const std::string& text, const std::string& json,
                  const Document& document);

/// `files` are a chaintrue_belts file, holes that a four-belt machine cut, or both. These return
/// the exit code.
int fit_the_belts(Verb verb, const FitCommand& command, const InputFiles& files);
/// \throws InputError for a drawing with a mistake, which is reported; nothing is written then.
int fit_the_drawing(Verb verb, const FitCommand& command, const InputFile& file);

}  // namespace chaintrue::cli
