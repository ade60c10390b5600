// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Files, machine and messages of `chaintrue gcode`.
#include "tools/cli/gcode_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "grid/files/anchors_file.hpp"
#include "grid/files/file_identity.hpp"
#include "grid/files/input_error.hpp"
#include "grid/files/parse_double.hpp"
#include "grid/files/whole_file.hpp"
#include "model/belts/belt_controller.hpp"
#include "tools/cli/belts_input.hpp"
#include "tools/cli/machine_input.hpp"
#include "tools/cli/map_input.hpp"
#include "tools/cli/progress.hpp"
#include "tools/gcode/belt_target.hpp"
#include "tools/gcode/file_hash.hpp"

namespace chaintrue::cli {
namespace {

using grid::files::InputError;
using grid::files::InputProblem;

struct KindName {
  std::string_view name;
  model::ControllerKind kind;
};

constexpr KindName kKinds[] = {
    {"maslow_classic", model::ControllerKind::maslow_classic},
    {"holey", model::ControllerKind::holey},
    {"fluidnc_wallplotter", model::ControllerKind::fluidnc_wallplotter},
    {"ideal", model::ControllerKind::ideal},
};

constexpr std::string_view kFourBeltsName = "maslow4";

bool number(std::string_view text, double& value) {
  const auto [end, error] =
      grid::files::parse_double(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

int exit_code(gcode::ProblemName name) {
  return gcode::kind(name) == gcode::ProblemKind::bad_input ? kBadInput : kNotSupportedOrOutside;
}

}  // namespace

gcode::Dialect GcodeOptions::dialect() const {
  gcode::Dialect dialect;
  dialect.skip_deletable_blocks = skip_deletable;
  dialect.tools_have_no_diameter = tools_have_no_diameter;
  dialect.step_budget = step_budget;
  return dialect;
}

model::BedPoint GcodeOptions::home_mm() const {
  const std::string_view text = home;
  const std::size_t comma = text.find(',');
  model::BedPoint point;
  if (comma == std::string_view::npos || !number(text.substr(0, comma), point.x_mm) ||
      !number(text.substr(comma + 1), point.y_mm)) {
    throw InputError(
        {{"--home", "", home, "two numbers in mm with a comma between, such as 120,-40"}});
  }
  return point;
}

const gcode::Firmware* stated_firmware(std::string_view name) {
  if (name == kFourBeltsName) return &gcode::firmware_of_four_belts();
  const auto kind = controller_kind(name);
  return kind ? &gcode::firmware(*kind) : nullptr;
}

std::optional<model::ControllerKind> controller_kind(std::string_view name) {
  for (const KindName& kind : kKinds) {
    if (kind.name == name) return kind.kind;
  }
  return std::nullopt;
}

GcodeMachine::GcodeMachine(const GcodeOptions& options) {
  const std::string text = grid::files::read_whole_file(options.map);
  gcode::FileHash hash;
  hash.add(text);
  map_hash_ = hash.text();
  grid::files::looks_like_anchors(text) ? take_belts(options, text) : take_map(options, text);
}

void GcodeMachine::take_belts(const GcodeOptions& options, const std::string& text) {
  const std::string file = grid::files::name_in_messages(options.map);
  const grid::files::FittedAnchors found = parse_anchors_input(text, file);
  OptionProblems problems;
  if (!options.controller.empty() && options.controller != kFourBeltsName) {
    problems.add("--controller",
                 options.controller,
                 "\"maslow4\", or to be left out: anchors of four belts are of a Maslow 4");
  }
  const grid::HolesBesideBelts* holes = found.holes ? &*found.holes : nullptr;
  if (holes == nullptr && !found.fit.coordinates.front().stated_mm) {
    problems.add("--map",
                 options.map,
                 "anchors fitted to a file that states those in force: where commands count from "
                 "follows from them (import maslow4 --settings maslow.yaml)");
  }
  problems.throw_if_any();
  grid::BeltMap map(found.fit, holes);
  const model::BeltMachine believed =
      options.machine.empty() ? map.in_force() : read_belt_machine_input(options.machine);
  if (!found.fit.scale) {
    fmt::print(stderr,
               "The scale is not known: parts come out as true as a turn of the encoder is {:g} mm "
               "of belt. One long taped distance, or holes, tells it.\n",
               found.fit.machine.belt_turn_mm);
  }
  target_ = std::make_unique<gcode::BeltTarget>(std::move(map));
  kinematics_ = std::make_unique<const model::BeltController>(believed);
  corrector_ =
      std::make_unique<gcode::Corrector>(*target_, *kinematics_, gcode::firmware_of_four_belts());
}

void GcodeMachine::take_map(const GcodeOptions& options, const std::string& text) {
  if (options.controller == kFourBeltsName) {
    throw InputError({{options.map,
                       "/file_type",
                       "",
                       "\"chaintrue_anchors\", as chaintrue fit makes of belts: a Maslow 4 goes by "
                       "these in place of a map"}});
  }
  map_ = std::make_unique<grid::CompensationMap>(
      parse_map_input(text, grid::files::name_in_messages(options.map)));
  target_ = std::make_unique<gcode::CompensationTarget>(
      *map_, options.frame == "bed" ? gcode::ProgramFrame::bed : gcode::ProgramFrame::marks);
  if (!options.machine.empty()) {
    machine_ = read_machine_input(options.machine);
  } else if (const auto stated = gcode::stated_machine(*map_)) {
    machine_ = *stated;
  } else {
    throw InputError({{options.map,
                       "",
                       "",
                       "a map that knows its machine; this one does not, so say with --machine "
                       "what the controller believes"}});
  }
  if (const auto kind = controller_kind(options.controller)) machine_.controller.kind = *kind;
  half_play_mm_ = gcode::half_play_mm(machine_);
  kinematics_ = model::make_controller_kinematics(machine_);
  corrector_ = std::make_unique<gcode::Corrector>(
      *target_, *kinematics_, gcode::firmware(machine_.controller.kind));
}

void check_limits(const GcodeOptions& options, OptionProblems& problems) {
  const double least_mm = gcode::least_tolerance_mm(options.decimals);
  if (options.tolerance_mm > least_mm) return;
  problems.add("--tolerance-mm",
               fmt::format("{}", options.tolerance_mm),
               fmt::format("more than {:.2g} mm, which rounding to {} decimals takes; more "
                           "--decimals round less",
                           least_mm,
                           options.decimals));
}

gcode::CompensateOptions compensate_options(const GcodeOptions& options,
                                            const GcodeMachine& machine) {
  gcode::CompensateOptions result;
  result.tolerance_mm = options.tolerance_mm;
  result.decimals = options.decimals;
  result.home = options.home_mm();
  result.largest_correction_mm = options.largest_correction_mm;
  result.steepest_correction = options.steepest_correction;
  result.keep_rapids_whole = options.keep_rapids_whole;
  result.home_is_zero = options.home_is_zero;
  result.clamp_box = gcode::clamp_box(machine.machine());
  result.half_play_mm = machine.half_play_mm();
  result.map_hash = machine.map_hash();
  return result;
}

GcodeText::GcodeText(const std::string& path) : path_(path) {
  // A pipe can be read once only.
  if (path == "-" || !grid::files::identity_of(path)) text_ = grid::files::read_whole_file(path);
}

gcode::LineSource GcodeText::open() const {
  if (text_) return gcode::LineSource::from_text(*text_);
  auto source = gcode::LineSource::from_file(path_);
  if (!source) throw InputError({{path_, "", "", "a file that can be read"}});
  return std::move(*source);
}

gcode::LineSource GcodeText::open(const grid::WorkStep& step) const {
  gcode::LineSource source = open();
  std::error_code unknown;
  const std::uintmax_t size = text_ ? text_->size() : std::filesystem::file_size(path_, unknown);
  shown_progress()(step);
  // Loops go back; what was read of the file stays read.
  source.on_line([total = unknown ? 0.0 : static_cast<double>(size),
                  furthest = std::uint64_t{0}](std::uint64_t offset) mutable {
    furthest = std::max(furthest, offset);
    progress_is(static_cast<double>(furthest), total);
  });
  return source;
}

std::string GcodeText::hash() const {
  gcode::FileHash hash;
  if (text_) {
    hash.add(*text_);
    return hash.text();
  }
  std::ifstream file(path_, std::ios::binary);
  std::array<char, 65536> bytes{};
  while (file.read(bytes.data(), bytes.size()) || file.gcount() > 0) {
    hash.add({bytes.data(), static_cast<std::size_t>(file.gcount())});
  }
  return hash.text();
}

std::string compensated_name(const std::string& program) {
  const std::filesystem::path path(program);
  return std::filesystem::path(path)
      .replace_extension(".true" + path.extension().string())
      .string();
}

int report(const std::string& file, const gcode::Problem& problem) {
  end_progress();
  fmt::print(stderr, "{}: {}\n", grid::files::name_in_messages(file), problem.message());
  return exit_code(problem.name);
}

int report(const std::string& file, const gcode::Findings& findings) {
  end_progress();
  for (const gcode::Note& note : findings.notes) {
    fmt::print(stderr,
               "{}: line {}: note: {}\n",
               grid::files::name_in_messages(file),
               note.line,
               note.sentence);
  }
  if (findings.note_count > findings.notes.size()) {
    fmt::print(stderr, "... and {} more notes\n", findings.note_count - findings.notes.size());
  }
  int code = kDone;
  for (const gcode::Problem& problem : findings.problems) {
    const int own = report(file, problem);
    if (code == kDone) code = own;
  }
  if (findings.problem_count > findings.problems.size()) {
    fmt::print(
        stderr, "... and {} more lines\n", findings.problem_count - findings.problems.size());
  }
  return code;
}

gcode::LineSource written_so_far(grid::files::PendingFile& file) {
  const std::string place = file.flushed();
  if (place.empty()) return gcode::LineSource::from_text(file.held());
  auto source = gcode::LineSource::from_file(place);
  if (!source) throw InputError({{place, "", "", "room for the whole file"}});
  return std::move(*source);
}

}  // namespace chaintrue::cli
