// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue effects --atlas: a page with the drawings of each cause, for two chains, four belts or
/// a V-plotter.
#pragma once

#include <string>
#include <vector>

namespace chaintrue::cli {

/// Only for one cause if `cause` is not empty. `declared` are files of the owner's effects, for two
/// chains only. \throws InputError with every problem.
int write_atlas(const std::string& machine,
                const std::string& cause,
                const std::vector<std::string>& declared,
                const std::string& output);

}  // namespace chaintrue::cli
