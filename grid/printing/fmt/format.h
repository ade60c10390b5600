// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stands before fmt's own header on the include path of every room that prints, so that whoever
/// prints there does it through the gate of grid/printing.hpp, without having to remember it.
#pragma once
#pragma GCC system_header
#include_next <fmt/format.h>

#include "grid/printing.hpp"
