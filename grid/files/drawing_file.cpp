// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/drawing_file.hpp"

#include "grid/containers.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"

namespace chaintrue::grid::files {
namespace {

using observation::DrawnMeasure;

/// Crosses by their names.
struct MeasureInFile {
  DrawnMeasure::Kind kind = DrawnMeasure::Kind::length;
  std::string from;
  std::string to;
  std::string middle;
  std::optional<double> value_mm;
  double sigma_mm = kRulerSigmaMm;
};

struct DrawingInFile : TestDrawing {
  std::vector<MeasureInFile> lines;
};

auto cross_record() {
  RECORD(DrawnCross, "a drawn cross")
  REQUIRED(name, "Its name on the sheet.")
  FIELD(place, &DrawnCross::commanded, "Commanded x, to the right of the middle between the pins.",
        "Commanded y, up from the pins, so negative below them.", kPlaceMm);
}

void check_middle(const Cursor& at, MeasureInFile& measure) {
  if (!at.clean()) return;
  const bool is_bow = measure.kind == DrawnMeasure::Kind::bow;
  if (is_bow && measure.middle.empty())
    at.child("middle").missing("the cross at which the bow was measured");
  if (!is_bow && !measure.middle.empty())
    at.child("middle").expect("to be left out, because a length has only two ends");
}

RECORD_OF(MeasureInFile, "a measure on a drawing")
REQUIRED(kind, "A length between two crosses, or the bow of a line.",
         in_order<DrawnMeasure::Kind>({"length", "bow"}))
REQUIRED(from, "The first cross.")
REQUIRED(to, "The last cross.")
SPARSE(middle, "For a bow: the cross on the line at which it was measured.")
NULLABLE(value_mm,
         "The reading; null: not measured. A bow is positive if the line is on the left, "
         "looking from its first cross to its last.",
         kPlaceMm)
OPTIONAL(sigma_mm, "Noise of the reading, 1 sigma.", {"mm", 0.01, 50.0})
    .check(check_middle) END_RECORD;

const DrawnCross* cross_of(const TestDrawing& drawing, const std::string& name) {
  return find_where(drawing.crosses, having(&DrawnCross::name, name));
}

void check_drawing(const Cursor& at, DrawingInFile& drawing) {
  if (!at.clean()) return;
  for (const auto i : each_index(drawing.crosses)) {
    if (cross_of(drawing, drawing.crosses[i].name) != &drawing.crosses[i])
      at.child("crosses").element(i).child("name").expect("a name that no other cross has");
  }
  for (const auto i : each_index(drawing.lines)) {
    const Cursor place = at.child("measures");
    const Cursor measure = place.element(i);
    const MeasureInFile& own = drawing.lines[i];
    const auto check = [&](const char* key, const std::string& name) {
      if (!cross_of(drawing, name)) measure.child(key).expect("the name of one of the crosses");
    };
    check("from", own.from);
    check("to", own.to);
    if (!own.middle.empty()) check("middle", own.middle);
    if (own.to == own.from || own.middle == own.from || own.middle == own.to)
      measure.expect("crosses that differ");
  }
}

}  // namespace

FILE_RECORD(drawing, DrawingInFile, "a test drawing", kDrawingFormat)
SPARSE(name, "Name of the drawing.")
FIELD(
    computed, "set", "The plotter with the settings in force when the page was drawn.", true,
    object(set_plotter_record()),
    [](Own& drawing, const SetPlotter& set) { static_cast<SetPlotter&>(drawing) = set; },
    [](const Own& drawing) { return static_cast<const SetPlotter&>(drawing); })
REQUIRED(crosses, "The crosses of the page.", list(cross_record(), 3))
NAMED(required, "measures", lines, "Readings of ruler and string.")
    .check(check_drawing) END_FILE_RECORD;

namespace {

DrawingInFile in_file(const TestDrawing& drawing, bool is_blank) {
  DrawingInFile file{drawing, {}};
  const auto name = [&](std::size_t cross) { return drawing.crosses.at(cross).name; };
  for (const DrawnMeasure& own : drawing.measures) {
    MeasureInFile measure{own.kind, name(own.from), name(own.to), {}, own.value_mm, own.sigma_mm};
    if (own.kind == DrawnMeasure::Kind::bow) measure.middle = name(own.middle);
    if (is_blank) measure.value_mm.reset();
    file.lines.push_back(std::move(measure));
  }
  return file;
}

}  // namespace

TestDrawing parse_drawing(const std::string& text, const std::string& file) {
  const DrawingInFile read = read_document(drawing_record(), text, file);
  TestDrawing drawing = read;
  const auto index = [&](const std::string& name) {
    return as_size(cross_of(read, name) - read.crosses.data());
  };
  for (const MeasureInFile& own : read.lines) {
    if (!own.value_mm) continue;
    const std::size_t middle = own.middle.empty() ? 0 : index(own.middle);
    drawing.measures.push_back(
        {own.kind, index(own.from), index(own.to), middle, *own.value_mm, own.sigma_mm});
  }
  return drawing;
}

std::string write_drawing(const TestDrawing& drawing) {
  return write_document(drawing_record(), in_file(drawing, false));
}

std::string write_blank_drawing(const TestDrawing& drawing) {
  return write_document(drawing_record(), in_file(drawing, true));
}

}  // namespace chaintrue::grid::files
