// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Drawings (SVG) of what a machine does with its errors: what an effect moves, every cause on one
/// page, and a square as cut. Same picture, same bytes.
#pragma once

#include <string>
#include <vector>

#include "grid/synthetic/effect_picture.hpp"
#include "model/machine.hpp"
#include "model/square.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// Arrows over the bed before and after calibration, and the two squares as cut, both with their
/// scale printed.
std::string draw_effect(const Machine& machine, const synthetic::EffectPicture& picture);

/// `3`, `0.17`, `6e-06`: three digits, without trailing zeros.
std::string short_number(double value);

/// chaintrue square: the commanded outline, the cut one with its errors magnified, and the numbers
/// that a ruler would show.
std::string draw_square(const model::CutSquare& square, const SquareTask& task);

/// chaintrue effects --atlas: writes a page with the drawings of each cause, for two chains, four
/// belts or a V-plotter; only for one cause if `cause` is not empty. `declared` are files of the
/// owner's effects, for two chains only. \throws InputError with every problem.
int write_atlas(const std::string& machine, const std::string& cause,
                const std::vector<std::string>& declared, const std::string& output);

}  // namespace chaintrue::cli
