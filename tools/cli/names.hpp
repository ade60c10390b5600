// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Names of the libraries that the command uses without their namespace.
#pragma once

#include <string>
#include <vector>

#include "grid/containers.hpp"
#include "grid/files/input_error.hpp"

namespace chaintrue::grid {
struct BeltsError;
struct BeltsFit;
struct Check;
class CompensationMap;
struct ErrorSummary;
struct Hole;
struct HolesPlan;
struct HolesPlanRequest;
struct HolesWithBelts;
struct KnownPlotter;
struct MapContents;
struct MapPoint;
class Measured;
struct MeasuredBelts;
struct MeasuredFile;
struct MeasuredGrid;
struct MeasuredHoles;
enum class ProblemKind;
struct Provenance;
struct SourceFile;
struct StatedNoise;
struct WorkStep;
}  // namespace chaintrue::grid

namespace chaintrue::grid::diagnosis {
struct Diagnosis;
struct NextMeasurement;
}  // namespace chaintrue::grid::diagnosis

namespace chaintrue::grid::files {
enum class FileKind;
struct FittedAnchors;
class PendingFile;
struct ReadBelts;
struct TapeOptions;
}  // namespace chaintrue::grid::files

namespace chaintrue::grid::sweep {}

namespace chaintrue::grid::synthetic {}

namespace chaintrue::interp {
struct Rectangle;
}  // namespace chaintrue::interp

namespace chaintrue::model {
struct AppliedEffect;
struct Bed;
struct BedPoint;
struct BeltMachine;
enum class ControllerKind;
struct Machine;
struct MarkPoint;
struct SquareTask;
}  // namespace chaintrue::model

namespace chaintrue::model::effects {}

namespace chaintrue::report {
struct Arrow;
struct Cell;
struct Chart;
struct ChartRow;
struct DataTable;
enum class Detail;
struct Document;
struct Figure;
struct Item;
struct Light;
struct List;
struct Paragraph;
struct Row;
struct Section;
struct Table;
enum class Tone;
}  // namespace chaintrue::report

namespace chaintrue::cli {

/// Words of a command line: all of them, or those given for one option; any list of words.
using Words = std::vector<std::string>;

namespace diagnosis = grid::diagnosis;
namespace effects = model::effects;
namespace files = grid::files;
namespace synthetic = grid::synthetic;
namespace sweep = grid::sweep;

using grid::all_of;
using grid::any_of;
using grid::append_all;
using grid::as_double;
using grid::as_int;
using grid::as_size;
using grid::BeltsError;
using grid::BeltsFit;
using grid::Check;
using grid::CompensationMap;
using grid::contains;
using grid::count_where;
using grid::each_index;
using grid::ErrorSummary;
using grid::find_where;
using grid::having;
using grid::Hole;
using grid::HolesPlan;
using grid::HolesPlanRequest;
using grid::HolesWithBelts;
using grid::KnownPlotter;
using grid::MapContents;
using grid::mapped;
using grid::MapPoint;
using grid::max_element;
using grid::Measured;
using grid::MeasuredBelts;
using grid::MeasuredFile;
using grid::MeasuredGrid;
using grid::MeasuredHoles;
using grid::minmax_element;
using grid::none_of;
using grid::ProblemKind;
using grid::Provenance;
using grid::SourceFile;
using grid::StatedNoise;
using grid::WorkStep;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::NextMeasurement;
using grid::files::FileKind;
using grid::files::FittedAnchors;
using grid::files::InputError;
using grid::files::PendingFile;
using grid::files::ReadBelts;
using grid::files::refuse;
using grid::files::TapeOptions;
using grid::files::Warning;
using interp::Rectangle;
using model::AppliedEffect;
using model::Bed;
using model::BedPoint;
using model::BeltMachine;
using model::ControllerKind;
using model::Machine;
using model::MarkPoint;
using model::SquareTask;
using report::Arrow;
using report::Cell;
using report::Chart;
using report::ChartRow;
using report::DataTable;
using report::Detail;
using report::Document;
using report::Figure;
using report::Item;
using report::Light;
using report::List;
using report::Paragraph;
using report::Row;
using report::Section;
using report::Table;
using report::Tone;

}  // namespace chaintrue::cli
