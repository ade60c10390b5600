// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/gcode/correction_failure.hpp"

#include <fmt/format.h>

#include "model/chains/chain_mechanism.hpp"

namespace chaintrue::gcode {
namespace {

CorrectionFailure::Reason reason_of(const grid::MapFailure& failure) {
  switch (failure.reason) {
    case grid::MapFailure::outside_map:
      return CorrectionFailure::outside_map;
    case grid::MapFailure::unreachable:
      return CorrectionFailure::unreachable;
    case grid::MapFailure::not_converged:
      break;
  }
  return CorrectionFailure::not_converged;
}

}  // namespace

CorrectionFailure::CorrectionFailure(Reason why, model::PoseFailure from)
    : reason(why), cause(model::mechanism_failure(from)) {}

CorrectionFailure::CorrectionFailure(const grid::MapFailure& failure)
    : reason(reason_of(failure)), cause(failure.cause) {}

std::string explain(const CorrectionFailure& failure) {
  const std::string cause = failure.cause ? fmt::format(": {}", failure.cause->sentence) : "";
  switch (failure.reason) {
    case CorrectionFailure::outside_map:
      return "lies outside the map";
    case CorrectionFailure::unreachable:
      return "cannot be reached by the machine" + cause;
    case CorrectionFailure::not_converged:
      return "has no answer in the map: the iteration did not settle";
    case CorrectionFailure::controller:
      break;
  }
  return "cannot be reached by the controller's own kinematics" + cause;
}

}  // namespace chaintrue::gcode
