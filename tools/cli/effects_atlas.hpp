// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue effects --atlas: the page of what each cause draws, of two chains, four belts or a
/// V-plotter.
#pragma once

#include <string>
#include <vector>

namespace chaintrue::cli {

/// Of one cause alone where `cause` is not empty. `declared` are files of the owner's effects, of two chains
/// alone. \throws files::InputError with every problem.
int write_atlas(const std::string& machine,
                const std::string& cause,
                const std::vector<std::string>& declared,
                const std::string& output);

}  // namespace chaintrue::cli
