// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Types of the libraries that the command uses without their namespace.
#pragma once

#include "grid/files/input_error.hpp"

namespace chaintrue::grid {
struct BeltsError;
struct BeltsFit;
class CompensationMap;
struct HolesPlanRequest;
struct MapContents;
struct MeasuredBelts;
struct MeasuredGrid;
struct MeasuredHoles;
enum class ProblemKind;
struct StatedNoise;
}  // namespace chaintrue::grid

namespace chaintrue::grid::diagnosis {
struct Diagnosis;
struct NextMeasurement;
}  // namespace chaintrue::grid::diagnosis

namespace chaintrue::grid::files {
enum class FileKind;
}  // namespace chaintrue::grid::files

namespace chaintrue::grid::sweep {}

namespace chaintrue::grid::synthetic {}

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

namespace diagnosis = grid::diagnosis;
namespace files = grid::files;
namespace synthetic = grid::synthetic;
namespace sweep = grid::sweep;

using grid::BeltsError;
using grid::BeltsFit;
using grid::CompensationMap;
using grid::HolesPlanRequest;
using grid::MapContents;
using grid::MeasuredBelts;
using grid::MeasuredGrid;
using grid::MeasuredHoles;
using grid::ProblemKind;
using grid::StatedNoise;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::NextMeasurement;
using grid::files::FileKind;
using grid::files::InputError;
using grid::files::refuse;
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
