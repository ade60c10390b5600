// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/gcode/correction_failure.hpp"

namespace chaintrue::gcode {
namespace {

CorrectionReason reason_of(grid::MapReason reason) {
  switch (reason) {
    case grid::MapReason::outside_map:
      return CorrectionReason::outside_map;
    case grid::MapReason::unreachable:
      return CorrectionReason::unreachable;
    case grid::MapReason::not_converged:
      break;
  }
  return CorrectionReason::not_converged;
}

}  // namespace

CorrectionFailure correction_failure(const grid::MapFailure& failure) {
  return CorrectionFailure(reason_of(failure.reason)).because_of(failure.cause);
}

CorrectionFailure out_of_controllers_reach(const model::PoseFailure& why) {
  return CorrectionFailure(CorrectionReason::controller).because_of(model::sentence_of(why.reason));
}

std::string_view sentence_of(CorrectionReason reason) {
  switch (reason) {
    case CorrectionReason::outside_map:
      return "lies outside the map";
    case CorrectionReason::unreachable:
      return "cannot be reached by the machine";
    case CorrectionReason::not_converged:
      return "has no answer in the map: the iteration did not settle";
    case CorrectionReason::controller:
      break;
  }
  return "cannot be reached by the controller's own kinematics";
}

}  // namespace chaintrue::gcode
