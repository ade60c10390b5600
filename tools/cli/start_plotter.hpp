// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The files of start for a V-plotter: the page to draw, the sheet of what to measure on it, and
/// the drawing file to fill in.
#pragma once

#include <string>

#include "grid/files/plotter_settings.hpp"
#include "tools/cli/input_file.hpp"

namespace chaintrue::cli {

/// A chaintrue_plotter, or settings that only a V-plotter has.
bool is_of_a_plotter(const InputFile& file);

/// A chaintrue_plotter, or the settings of a V-plotter's controller. \throws InputError with
/// every problem.
files::ReadPlotter load_plotter(const InputFile& file);

/// Next to the plotter's file if `folder` is empty. A measured plotter is assumed to have the
/// numbers of export plotter typed in.
int start_plotter(Verb verb, const InputFile& file, std::string folder);

}  // namespace chaintrue::cli
