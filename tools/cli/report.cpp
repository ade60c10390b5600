// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue report: a map, a diagnosis or anchors as one HTML page that needs no network.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "grid/files/sources.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/anchors_document.hpp"
#include "tools/cli/certificate.hpp"
#include "tools/cli/diagnosis_document.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/map_document.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct ReportCommand {
  std::string input;
  std::string output;
  bool certificate = false;
  std::string date;
};

/// A page of the file, and the next command.
struct Reported {
  Document page;
  std::vector<std::string> next;
};

Reported of_map(const InputFile& file, bool as_certificate, std::string_view source) {
  const CompensationMap map = load_map(file);
  return Reported{as_certificate ? certificate(map, source) : map_document(map, source),
                  map.machine() == nullptr
                      ? std::vector<std::string>{"query", file.path, "--help"}
                      : std::vector<std::string>{"plan", "--check", file.path, "-o", "check.csv"}};
}

Reported of_diagnosis(const InputFile& file, std::string_view source) {
  const Diagnosis found = load_diagnosis(file);
  if (found.drawing) return {diagnosis_document(found, source), {"fit", "--help"}};
  return {
      diagnosis_document(found, source),
      found.causes.empty()
          ? std::vector<std::string>{"export", found.belts ? "maslow4" : "groundcontrol", file.path}
          : std::vector<std::string>{"effects",
                                     std::string(found.causes.front().cause.effect->id)}};
}

Reported of_anchors(const InputFile& file, std::string_view source) {
  const files::FittedAnchors found = load_anchors(file);
  return {anchors_document({found.fit, found.holes ? &*found.holes : nullptr}, found.name, source),
          {"export", "maslow4", file.path}};
}

Facts fact_of(FileKind kind) {
  if (kind == FileKind::map) return facts::map;
  return kind == FileKind::anchors ? facts::anchors : facts::diagnosis;
}

/// The name of a page's source: the file, or standard input.
std::string source_of(const InputFile& file) {
  if (file.path != "-") return std::filesystem::path(file.path).filename().string();
  if (file.kind == FileKind::map) return "a map";
  return file.kind == FileKind::anchors ? "anchors" : "a diagnosis";
}

int run_report(Verb verb, const ReportCommand& command) {
  const InputFile file = open_input(command.input);
  require_kind(file, {FileKind::map, FileKind::diagnosis, FileKind::anchors});
  verb.refuse_idle_options(fact_of(file.kind));
  const std::string source = source_of(file);
  Reported made = file.kind == FileKind::map         ? of_map(file, command.certificate, source)
                  : file.kind == FileKind::diagnosis ? of_diagnosis(file, source)
                                                     : of_anchors(file, source);
  if (!command.certificate)
    add_made_by(files::made_by_of(file.text, file.name), made.page.sections);
  // No date is printed, so the same map gives the same page. A certificate has a line to write the
  // date on.
  const std::string date =
      command.date.empty() && command.certificate ? "date: ______________" : command.date;
  if (!date.empty()) {
    std::string& subtitle = made.page.subtitle;
    subtitle += fmt::format("{}{}", subtitle.empty() ? "" : ", ", date);
  }
  write_output(command.output, report::render_html(made.page));
  if (command.output == "-") return kDone;
  fmt::print(stderr, "The report is {}: open it in any browser.\n", command.output);
  say_next(made.next);
  return kDone;
}

}  // namespace

void add_report(Verb app) {
  auto command = std::make_shared<ReportCommand>();
  Verb verb = app.add_verb(
      "report",
      "Write a map, a diagnosis or the anchors of four belts as a web page that needs no network");
  add_input(verb,
            "file",
            command->input,
            "A chaintrue_map, chaintrue_diagnosis or chaintrue_anchors file; - is standard input")
      .required();
  add_output(
      verb, "-o,--output", command->output, {Origin::page}, "The HTML file; - is standard output")
      .required();
  verb.add_flag("--certificate", command->certificate, "One page of a map, to print")
      .acts_on(facts::map, "to be left out, because only a map has a certificate");
  verb.add_option("--date", command->date, "A date to print below the title, as in 2026-11-22");
  verb.footer(
      "Examples:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue report map.json -o report.html\n"
      "  build/chaintrue diagnose fixtures/grids/seven_by_four.json -o diagnosis.json\n"
      "  build/chaintrue report diagnosis.json -o diagnosis.html");
  verb.runs(command, run_report);
}

}  // namespace chaintrue::cli
