// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/holes_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/files/csv_table.hpp"
#include "grid/files/holes_checks.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/machine_record.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;

constexpr Range kCoordinate{"mm", -20000.0, 20000.0};
constexpr Range kDistance{"mm", 0.1, 20000.0};
constexpr Range kSigma{"mm", 0.001, 100.0};

/// The file as it stands, before the machine is fetched and the ends of distances are looked up.
struct StatedHoles {
  std::string name;
  std::optional<model::Machine> machine;
  std::string machine_file;
  Tape tape;
  double hole_sigma_mm = MeasuredHoles{}.hole_sigma_mm;
  double noise_dof = MeasuredHoles{}.noise_dof;
  SheetSize sheet;
  std::vector<Hole> holes;
  std::vector<bool> is_hole_spoilt;
  std::vector<StatedDistance> distances;
};

const Record<Tape>& tape_record() {
  static const auto record =
      Record<Tape>("the tape")
          .optional("sigma_mm", &Tape::sigma_mm, number(kSigma))
          .optional("hook_offset_mm", &Tape::hook_offset_mm, number({"mm", -1000.0, 1000.0}))
          .optional("hook_sigma_mm", &Tape::hook_sigma_mm, number({"mm", 0.0, 100.0}));
  return record;
}

const Record<SheetSize>& sheet_record() {
  static const auto record =
      Record<SheetSize>("the sheet")
          .optional("width_mm", &SheetSize::width_mm, number({"mm", 100.0, 20000.0}))
          .optional("height_mm", &SheetSize::height_mm, number({"mm", 100.0, 20000.0}))
          .optional("size_sigma_mm", &SheetSize::size_sigma_mm, number({"mm", 0.0, 100.0}));
  return record;
}

const Record<Hole>& hole_record() {
  static const auto record = [] {
    Record<Hole> hole("a hole");
    hole.sparse("name", &Hole::name, text());
    const auto coordinate = [&hole](const char* key, double model::BedPoint::*member) {
      hole.custom(
          key,
          true,
          kCoordinate.expected(),
          [member](const Cursor& at, Hole& h) {
            if (const auto value = at.number(kCoordinate)) h.commanded.*member = *value;
          },
          [member](const Hole& h) { return std::optional<Json>(h.commanded.*member); });
    };
    coordinate("x_mm", &model::BedPoint::x_mm);
    coordinate("y_mm", &model::BedPoint::y_mm);
    return hole;
  }();
  return record;
}

/// A hole by its name or by its number.
Record<StatedDistance>& end_of(Record<StatedDistance>& record,
                               const std::string& key,
                               std::string StatedDistance::*member) {
  constexpr int kMost = 100000;
  return record.custom(
      key,
      true,
      "a hole's name or number",
      [member](const Cursor& at, StatedDistance& distance) {
        if (at.json().is_number()) {
          if (const auto value = at.integer(0, kMost)) distance.*member = fmt::format("{}", *value);
        } else if (const auto word = at.text()) {
          distance.*member = *word;
        }
      },
      [member](const StatedDistance& distance) { return std::optional<Json>(distance.*member); });
}

const Record<StatedDistance>& distance_record() {
  static const auto record = [] {
    Record<StatedDistance> distance("a distance");
    end_of(distance, "from", &StatedDistance::from);
    end_of(distance, "to", &StatedDistance::to);
    distance.required("distance_mm", &StatedDistance::distance_mm, number(kDistance))
        .optional("sigma_mm", &StatedDistance::sigma_mm, number(kSigma));
    return distance;
  }();
  return record;
}

/// Reads a list of records and notes which were wrong.
template <class T>
void read_list(const Cursor& at,
               const Record<T>& record,
               std::vector<T>& values,
               const std::function<void(T&, bool)>& note) {
  if (!at.json().is_array()) return at.expect("a list");
  for (std::size_t i = 0; i < at.json().size(); ++i) {
    const std::size_t before = at.problems().list().size();
    T value = record.read(at.element(i)).value_or(T{});
    note(value, at.problems().list().size() > before);
    values.push_back(std::move(value));
  }
}

template <class T>
std::function<std::optional<Json>(const StatedHoles&)> list_writer(
    const Record<T>& record, std::vector<T> StatedHoles::*member) {
  return [value = list(object(record)), member](const StatedHoles& stated) {
    return std::optional<Json>(value.write(stated.*member));
  };
}

const Record<StatedHoles>& holes_record() {
  static const auto record =
      Record<StatedHoles>("a set of holes", "chaintrue_holes")
          .optional("name", &StatedHoles::name, text())
          .optional("machine", &StatedHoles::machine, object(machine_record()))
          .sparse("machine_file", &StatedHoles::machine_file, text())
          .optional("tape", &StatedHoles::tape, object(tape_record()))
          .optional("hole_sigma_mm", &StatedHoles::hole_sigma_mm, number({"mm", 0.0, 100.0}))
          .optional("noise_dof", &StatedHoles::noise_dof, number({"", 1.0, 1e9}))
          .optional("sheet", &StatedHoles::sheet, object(sheet_record()))
          .custom(
              "holes",
              true,
              "a list of holes",
              [](const Cursor& at, StatedHoles& stated) {
                read_list<Hole>(at, hole_record(), stated.holes, [&stated](Hole&, bool spoilt) {
                  stated.is_hole_spoilt.push_back(spoilt);
                });
              },
              list_writer(hole_record(), &StatedHoles::holes))
          .custom(
              "distances",
              true,
              "a list of distances",
              [](const Cursor& at, StatedHoles& stated) {
                read_list<StatedDistance>(
                    at,
                    distance_record(),
                    stated.distances,
                    [](StatedDistance& distance, bool spoilt) { distance.is_spoilt = spoilt; });
              },
              list_writer(distance_record(), &StatedHoles::distances))
          .check([](const Cursor& at, StatedHoles& stated) {
            if (stated.machine && !stated.machine_file.empty()) {
              at.child("machine_file").expect("either \"machine\" or \"machine_file\", not both");
            }
          });
  return record;
}

void fetch_machine(StatedHoles& stated, const HolesOptions& options, Problems& problems) {
  if (options.machine) {
    stated.machine = options.machine;
  } else if (!stated.machine_file.empty() && !stated.machine) {
    const fs::path folder = fs::path(problems.file()).parent_path();
    try {
      ReadMachine read = read_machine_with_warnings(folder / stated.machine_file);
      stated.machine = std::move(read.machine);
      problems.add_warnings(read.warnings);
    } catch (const InputError& error) {
      problems.add_all(error);
    }
  }
}

/// What JSON and CSV have in common once the fields are read.
ReadHoles finish(StatedHoles stated,
                 const HolesPlaces& places,
                 const HolesOptions& options,
                 Problems& problems) {
  fetch_machine(stated, options, problems);
  ReadHoles read;
  MeasuredHoles& set = read.holes;
  set.name = std::move(stated.name);
  set.machine = std::move(stated.machine);
  set.tape = stated.tape;
  set.tape.sigma_mm = options.tape_sigma_mm.value_or(set.tape.sigma_mm);
  set.tape.hook_offset_mm = options.hook_offset_mm.value_or(set.tape.hook_offset_mm);
  if (options.hook_sigma_mm) set.tape.hook_sigma_mm = options.hook_sigma_mm;
  set.hole_sigma_mm = options.hole_sigma_mm.value_or(stated.hole_sigma_mm);
  set.noise_dof = stated.noise_dof;
  set.sheet = stated.sheet;
  set.holes = std::move(stated.holes);
  check_names(set.holes, places, problems);
  set.distances = resolved_distances(stated.distances, set.holes, places, problems);
  if (!problems.any()) check_holes_together(set, options.fewest_distances, places, problems);
  problems.throw_if_any();
  read.warnings = problems.warnings();
  return read;
}

ReadHoles parse_json_holes(const std::string& text,
                           const HolesOptions& options,
                           Problems& problems) {
  const Json json = parse_json(text, problems);
  auto stated = holes_record().read(Cursor(json, problems), true);
  if (!stated) problems.throw_if_any();
  const HolesPlaces places{"/holes",
                           "/distances",
                           [](std::size_t index) { return fmt::format("/holes/{}", index); },
                           [](std::size_t index, std::string_view field) {
                             return field.empty() ? fmt::format("/distances/{}", index)
                                                  : fmt::format("/distances/{}/{}", index, field);
                           }};
  return finish(std::move(stated.value()), places, options, problems);
}

/// One of the two tables of a CSV: the cells of its lines, by column.
struct TextTable {
  CsvCell header;
  std::vector<std::vector<CsvCell>> rows;
};

constexpr std::string_view kHoleHeader[] = {"hole", "x_mm", "y_mm"};
constexpr std::string_view kDistanceHeader[] = {"from", "to", "distance_mm", "sigma_mm"};

bool begins_with(const CsvRow& row, std::string_view word) {
  return !row.empty() && row.front().text == word;
}

/// Reports a header line that is not the one expected.
template <std::size_t n>
void check_header(const CsvRow& row,
                  const std::string_view (&names)[n],
                  std::size_t required,
                  Problems& problems) {
  std::vector<std::string> found;
  for (const CsvCell& cell : row) found.push_back(cell.text);
  while (!found.empty() && found.back().empty()) found.pop_back();
  bool fits = found.size() >= required && found.size() <= n;
  for (std::size_t i = 0; fits && i < found.size(); ++i) fits = found[i] == names[i];
  if (fits) return;
  problems.add(row.front().place(),
               joined(found),
               fmt::format("the columns {}", fmt::join(std::begin(names), std::end(names), ",")));
}

/// Cells beyond the row's end read as empty, at the row's first cell.
CsvCell cell_of(const CsvRow& row, std::size_t column) {
  if (column < row.size()) return row[column];
  CsvCell absent = row.front();
  absent.text.clear();
  return absent;
}

double required_number(const CsvCell& cell,
                       std::string_view name,
                       const Range& range,
                       Problems& problems) {
  if (cell.text.empty()) {
    problems.add(cell.place(), "", fmt::format("{} ({})", range.expected(), name));
    return 0.0;
  }
  return checked_number(cell.text, cell.place(), name, range, problems).value_or(0.0);
}

void read_hole_row(const CsvRow& row, StatedHoles& stated, Problems& problems) {
  const std::size_t before = problems.list().size();
  Hole hole;
  hole.name = cell_of(row, 0).text;
  hole.commanded = {required_number(cell_of(row, 1), "x_mm", kCoordinate, problems),
                    required_number(cell_of(row, 2), "y_mm", kCoordinate, problems)};
  stated.holes.push_back(hole);
  stated.is_hole_spoilt.push_back(problems.list().size() > before);
}

void read_distance_row(const CsvRow& row, StatedHoles& stated, Problems& problems) {
  const std::size_t before = problems.list().size();
  StatedDistance distance;
  distance.from = cell_of(row, 0).text;
  distance.to = cell_of(row, 1).text;
  distance.distance_mm = required_number(cell_of(row, 2), "distance_mm", kDistance, problems);
  const CsvCell sigma = cell_of(row, 3);
  if (!sigma.text.empty()) {
    distance.sigma_mm = checked_number(sigma.text, sigma.place(), "sigma_mm", kSigma, problems);
  }
  distance.is_spoilt = problems.list().size() > before;
  stated.distances.push_back(distance);
}

ReadHoles parse_csv_holes(const std::string& text,
                          const HolesOptions& options,
                          Problems& problems) {
  const std::vector<CsvRow> rows = split_csv(text, separator_of(text), problems);
  StatedHoles stated;
  std::vector<CsvCell> hole_cells;
  std::vector<CsvRow> distance_rows;
  enum class Table { none, holes, distances } table = Table::none;
  bool any_distances = false;
  for (const CsvRow& row : rows) {
    if (row.empty()) continue;
    if (begins_with(row, "hole")) {
      table = Table::holes;
      check_header(row, kHoleHeader, 3, problems);
    } else if (begins_with(row, "from")) {
      table = Table::distances;
      any_distances = true;
      check_header(row, kDistanceHeader, 3, problems);
    } else if (table == Table::holes) {
      hole_cells.push_back(row.front());
      read_hole_row(row, stated, problems);
    } else if (table == Table::distances) {
      distance_rows.push_back(row);
      read_distance_row(row, stated, problems);
    } else {
      problems.add(row.front().place(),
                   row.front().text,
                   "a header line first: hole,x_mm,y_mm for the holes, or "
                   "from,to,distance_mm,sigma_mm for the distances");
      break;
    }
  }
  if (!problems.any() && (stated.holes.empty() || !any_distances)) {
    problems.add("",
                 stated.holes.empty() ? "no holes" : "no distances",
                 "two tables: lines below hole,x_mm,y_mm, and lines below "
                 "from,to,distance_mm,sigma_mm");
  }
  problems.throw_if_any();
  const HolesPlaces places{"the holes",
                           "the distances",
                           [&hole_cells](std::size_t index) { return hole_cells[index].place(); },
                           [&distance_rows](std::size_t index, std::string_view field) {
                             for (std::size_t c = 0; c < std::size(kDistanceHeader); ++c) {
                               if (kDistanceHeader[c] == field)
                                 return cell_of(distance_rows[index], c).place();
                             }
                             return distance_rows[index].front().place();
                           }};
  return finish(std::move(stated), places, options, problems);
}

std::string_view without_lead(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark)
    text.remove_prefix(kByteOrderMark.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

bool is_json(std::string_view text) {
  const std::string_view rest = without_lead(text);
  return !rest.empty() && (rest.front() == '{' || rest.front() == '[');
}

}  // namespace

bool looks_like_holes(std::string_view text) {
  if (is_json(text)) return text.find("\"chaintrue_holes\"") != std::string_view::npos;
  const std::vector<std::string> header = csv_header(text);
  return !header.empty() && (header.front() == "hole" || header.front() == "from");
}

ReadHoles parse_holes(const std::string& text,
                      const std::string& file,
                      const HolesOptions& options) {
  Problems problems(file);
  return is_json(text) ? parse_json_holes(text, options, problems)
                       : parse_csv_holes(text, options, problems);
}

ReadHoles read_holes(const fs::path& path, const HolesOptions& options) {
  return parse_holes(read_whole_file(path), name_in_messages(path), options);
}

std::string write_holes(const MeasuredHoles& set) {
  StatedHoles stated;
  stated.name = set.name;
  stated.machine = set.machine;
  stated.tape = set.tape;
  stated.hole_sigma_mm = set.hole_sigma_mm;
  stated.noise_dof = set.noise_dof;
  stated.sheet = set.sheet;
  stated.holes = set.holes;
  for (const HoleDistance& distance : set.distances) {
    stated.distances.push_back(
        {set.holes.at(distance.from).name,
         distance.edge ? std::string(name(*distance.edge)) : set.holes.at(distance.to).name,
         distance.distance_mm,
         distance.sigma_mm});
  }
  return write_document(holes_record(), stated);
}

}  // namespace chaintrue::grid::files
