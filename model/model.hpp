// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The public interface of model: `#include <chaintrue/model.hpp>`. Machines on two chains and on
/// four belts, their kinematics, their controllers, the catalogue of effects, readings with
/// effects.
#pragma once

#include "model/belts/belt_controller.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "model/belts/belt_machine.hpp"
#include "model/belts/belt_mechanism.hpp"
#include "model/calibration/setting.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/catenary.hpp"
#include "model/chains/chain_changes.hpp"
#include "model/controllers/controller.hpp"
#include "model/coordinates.hpp"
#include "model/effects/catalogue.hpp"
#include "model/effects/declared_effect.hpp"
#include "model/effects/effect.hpp"
#include "model/failure.hpp"
#include "model/kinematics.hpp"
#include "model/machine.hpp"
#include "model/mechanism.hpp"
#include "model/reading_model.hpp"
#include "model/square.hpp"
