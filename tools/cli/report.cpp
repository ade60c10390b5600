// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue report: a map as one HTML page that needs no network.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "grid/files/map_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/map_report.hpp"
#include "tools/cli/verb.hpp"
#include "tools/report/map_report.hpp"

namespace chaintrue::cli {
namespace {

struct ReportCommand {
  std::string input;
  std::string output;
};

int run_report(const ReportCommand& command) {
  const grid::CompensationMap map = grid::files::read_map(command.input);
  const std::string source =
      command.input == "-" ? "a map" : std::filesystem::path(command.input).filename().string();
  grid::files::write_whole_file(command.output,
                                report::render(report::page_of(map_report(map, source))));
  if (command.output != "-")
    fmt::print(stderr, "The report is {}: open it in any browser.\n", command.output);
  return kDone;
}

}  // namespace

void add_report(CLI::App& app, Run& run) {
  auto command = std::make_shared<ReportCommand>();
  CLI::App* verb =
      app.add_subcommand("report", "A map as a page for a browser, to be read without a network");
  verb->add_option("map", command->input, "A chaintrue_map file; - is standard input")->required();
  verb->add_option("-o,--output", command->output, "The HTML file; - is standard output")
      ->required();
  verb->footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue report map.json -o report.html");
  verb->callback([command, &run] { run = [command] { return run_report(*command); }; });
}

}  // namespace chaintrue::cli
