// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The 40-digit reference tables of fixtures/reference, rounded to the nearest double.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "model/kinematics.hpp"

namespace chaintrue::model {

/// fixtures/reference/<name>.
nlohmann::json reference_table(const std::string& name);
/// A number written as a string of digits.
double number(const nlohmann::json& text);
BedPoint point_of(const nlohmann::json& record);
/// The machine of a table's "params".
EquilibriumParameters parameters_of(const nlohmann::json& params);
Attachment brackets_of(const nlohmann::json& params);

}  // namespace chaintrue::model
