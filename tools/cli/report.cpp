// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue report: a map, a diagnosis or anchors as one HTML page that needs no network.
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "grid/files/diagnosis_file.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/input_error.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/belts_input.hpp"
#include "tools/cli/anchors_document.hpp"
#include "tools/cli/certificate.hpp"
#include "tools/cli/diagnosis_document.hpp"
#include "tools/cli/map_input.hpp"
#include "tools/cli/map_document.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct ReportCommand {
  std::string input;
  std::string output;
  bool certificate = false;
  std::string date;
};

/// A kind of file that has a page; `called` stands for one that came through a pipe.
struct Reportable {
  std::string_view file_type;
  std::string_view called;
  report::Document (*page)(const std::string& text, const std::string& file, std::string_view source);
  /// Null where there is none.
  report::Document (*certificate)(const std::string& text,
                              const std::string& file,
                              std::string_view source);
  std::vector<std::string> (*next)(const std::string& text,
                                   const std::string& file,
                                   const std::string& path);
};

report::Document page_of_map(const std::string& text,
                         const std::string& file,
                         std::string_view source) {
  return map_document(parse_map_input(text, file), source);
}

report::Document certificate_of_map(const std::string& text,
                                const std::string& file,
                                std::string_view source) {
  return certificate(parse_map_input(text, file), source);
}

report::Document page_of_diagnosis(const std::string& text,
                               const std::string& file,
                               std::string_view source) {
  std::vector<files::Warning> warnings;
  const grid::diagnosis::Diagnosis found = files::parse_diagnosis(text, file, &warnings);
  print_warnings(warnings);
  return diagnosis_document(found, source);
}

report::Document page_of_anchors(const std::string& text,
                             const std::string& file,
                             std::string_view source) {
  const files::FittedAnchors found = parse_anchors_input(text, file);
  return anchors_document(
      {found.fit, found.holes ? &*found.holes : nullptr}, found.name, source);
}

std::vector<std::string> next_of_map(const std::string& text,
                                     const std::string& file,
                                     const std::string& path) {
  if (parse_map_input(text, file).machine() == nullptr) return {"query", path, "--help"};
  return {"plan", "--check", path, "-o", "check.csv"};
}

std::vector<std::string> next_of_diagnosis(const std::string& text,
                                           const std::string& file,
                                           const std::string& path) {
  const grid::diagnosis::Diagnosis found = files::parse_diagnosis(text, file);
  if (!found.causes.empty()) return {"effects", std::string(found.causes.front().cause.effect->id)};
  return {"export", "groundcontrol", path};
}

std::vector<std::string> next_of_anchors(const std::string&,
                                         const std::string&,
                                         const std::string& path) {
  return {"export", "maslow4", path};
}

constexpr std::array kReportables = {
    Reportable{"chaintrue_map", "a map", page_of_map, certificate_of_map, next_of_map},
    Reportable{"chaintrue_diagnosis", "a diagnosis", page_of_diagnosis, nullptr, next_of_diagnosis},
    Reportable{"chaintrue_anchors", "anchors", page_of_anchors, nullptr, next_of_anchors},
};

const Reportable& reportable(const std::string& text, const std::string& file) {
  const std::string type = files::file_type_of(text, file);
  std::string known;
  for (const Reportable& kind : kReportables) {
    if (kind.file_type == type) return kind;
    known += fmt::format("{}\"{}\"", known.empty() ? "" : " or ", kind.file_type);
  }
  throw files::InputError(
      {{file, "/file_type", type.empty() ? "" : fmt::format("\"{}\"", type), known}});
}

int run_report(const ReportCommand& command) {
  const std::string text = files::read_whole_file(command.input);
  const std::string file = files::name_in_messages(command.input);
  const Reportable& kind = reportable(text, file);
  const std::string source = command.input == "-"
                                 ? std::string(kind.called)
                                 : std::filesystem::path(command.input).filename().string();
  if (command.certificate && kind.certificate == nullptr) {
    throw files::InputError({{file,
                              "/file_type",
                              fmt::format("\"{}\"", kind.file_type),
                              "\"chaintrue_map\": only a map has a certificate"}});
  }
  const auto page = command.certificate ? kind.certificate : kind.page;
  report::Document made = page(text, file, source);
  // The clock is not asked: the same map gives the same page.
  if (!command.date.empty())
    made.subtitle += fmt::format("{}{}", made.subtitle.empty() ? "" : ", ", command.date);
  write_output(command.output, report::render_html(made));
  if (command.output != "-")
    fmt::print(stderr, "The report is {}: open it in any browser.\n", command.output);
  if (command.output != "-") say_next(kind.next(text, file, command.input));
  return kDone;
}

}  // namespace

void add_report(Verb app, Run& run) {
  auto command = std::make_shared<ReportCommand>();
  Verb verb = app.add_verb(
      "report", "A map, a diagnosis or the anchors of four belts as a page for a browser, to be read without a network");
  add_input(verb,
            "file",
            command->input,
            "A chaintrue_map, chaintrue_diagnosis or chaintrue_anchors file; - is standard input")
      .required();
  add_output(
      verb, "-o,--output", command->output, {Origin::page}, "The HTML file; - is standard output")
      .required();
  verb.add_flag("--certificate", command->certificate, "One page of a map, to print");
  verb.add_option("--date", command->date, "A date to print below the title, as in 2026-11-22");
  verb.footer(
      "Examples:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue report map.json -o report.html\n"
      "  build/chaintrue diagnose fixtures/grids/seven_by_four.json -o diagnosis.json\n"
      "  build/chaintrue report diagnosis.json -o diagnosis.html");
  verb.when_chosen([command, &run] { run = [command] { return run_report(*command); }; });
}

}  // namespace chaintrue::cli
