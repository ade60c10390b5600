// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The public interface of interp: `#include <chaintrue/interp.hpp>`. README.md says which surface
/// suits which data.
#pragma once

#include "interp/bspline_basis.hpp"
#include "interp/checked_field.hpp"
#include "interp/measured_region.hpp"
#include "interp/missing_nodes.hpp"
#include "interp/planner_nodes.hpp"
#include "interp/reml.hpp"
#include "interp/spline_axis.hpp"
#include "interp/spline_pair.hpp"
#include "interp/surface.hpp"
#include "interp/tensor_spline.hpp"
