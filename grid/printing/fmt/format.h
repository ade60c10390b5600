// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Precedes fmt's own header on the include path of every library that prints, so that all printing
/// uses grid/printing.hpp.
#pragma once
#pragma GCC system_header
#include_next <fmt/format.h>

#include "grid/printing.hpp"
