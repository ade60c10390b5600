// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/model/reference_tables.hpp"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace chaintrue::model {

nlohmann::json reference_table(const std::string& name) {
  std::ifstream file(std::string(CHAINTRUE_FIXTURES) + "/reference/" + name);
  if (!file) throw std::runtime_error("no reference table " + name);
  return nlohmann::json::parse(file);
}

double number(const nlohmann::json& text) {
  const auto& s = text.get_ref<const std::string&>();
  char* end = nullptr;
  const double value = std::strtod(s.c_str(), &end);
  if (s.empty() || end != s.c_str() + s.size()) throw std::runtime_error("no number: " + s);
  return value;
}

BedPoint point_of(const nlohmann::json& record) {
  return {number(record["x"]), number(record["y"])};
}

EquilibriumParameters parameters_of(const nlohmann::json& params) {
  Machine machine;
  machine.bed = {number(params["bedW"]), number(params["bedH"])};
  const double x = 0.5 * number(params["D"]);
  const double y = 0.5 * machine.bed.height_mm + number(params["motorOffsetY"]);
  machine.motors = {{-x, y}, {x, y}};
  machine.sprocket.teeth = static_cast<int>(number(params["teeth"]));
  machine.sprocket.pitch_mm = number(params["pitch"]);
  machine.feed = params["sg"].get<int>() > 0 ? Feed::over_top : Feed::off_bottom;
  machine.attachment = Ring{number(params["rho"])};
  machine.sled.mass_kg = number(params["mass"]);
  machine.chain.mass_kg_per_m = 1000.0 * number(params["lam"]);  // the tables count kg/mm
  machine.chain.compliance_per_n = number(params["compliance"]);
  machine.frame.tilt_from_vertical_deg = number(params["tilt_deg"]);
  return equilibrium_parameters(machine);
}

Attachment brackets_of(const nlohmann::json& params) {
  return Brackets{number(params["quad_l"]), number(params["quad_s"]), number(params["quad_cg"])};
}

}  // namespace chaintrue::model
