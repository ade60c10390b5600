// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The program that cuts a test square: metric, absolute, clockwise from its lower left corner, in
/// one pass. Same square, same bytes.
#pragma once

#include <string>

#include "model/square.hpp"

namespace chaintrue::cli {

[[nodiscard]] std::string square_program(const model::SquareTask& task, double depth_mm);

}  // namespace chaintrue::cli
