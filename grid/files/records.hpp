// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The tables that several formats hold, and the schema of each format, made by the file that reads it.
/// Private to grid/files; format_pages.hpp is the public interface of the schemas. The tables of belts
/// are in belts_record.hpp, those of a diagnosis in diagnosis_record.hpp.
#pragma once

#include <string_view>
#include <vector>

#include "grid/files/json_reader.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/plotter/found_plotter.hpp"
#include "model/effects/declared_effect.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

Json machine_schema(), grid_schema(), holes_schema(), belts_schema(), drawing_schema(),
    map_schema(), anchors_schema(), diagnosis_schema(), effect_schema(), plotter_schema(),
    sweep_schema();

/// Includes the checks of model::problems_of; warns of uncertainties that are assumed.
const Record<Machine>& machine_record();
/// An effect with its side and parameters; whether it exists is checked by the catalogue.
Record<AppliedEffect> record_of(Of<AppliedEffect>);
/// By GroundControl's own names.
Record<model::ControllerSettings> controller_settings_record();

/// A machine's "declared_effects": each is read, checked and declared.
Value<std::vector<const Effect*>> declared_value();
/// Whether a machine's declared effects are finite on its bed and 0 at null.
void check_declared_on_bed(const Cursor& at, const Machine& machine);
/// The effect of this name that the document's own machine declares, for a record that is read
/// before or without that machine; null if there is none.
const Effect* declared_in_document(const Cursor& at, std::string_view id);

/// `readings` of the machine itself in a file of points or of holes.
Record<ExtraReading> reading_record();
/// "motor_spacing_mm", ...
Value<ReadingOf> reading_name();

/// A V-plotter with its controller's settings. Includes the checks of model::problems_of, and what the
/// firmware needs of the machine.
Record<SetPlotter> set_plotter_record();

Record<interp::Rectangle> record_of(Of<interp::Rectangle>);
/// A setting of a map: stated and calibrated.
Record<SettingResult> setting_record();
/// The keys on_machine and direct of a map, which has one of them.
void add_surface(Record<MapContents>& record);

}  // namespace chaintrue::grid::files
