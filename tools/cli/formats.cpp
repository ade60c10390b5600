// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue formats: the reference page and the JSON Schema of each file format.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "grid/files/format_pages.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;
namespace fs = std::filesystem;

struct FormatsCommand {
  std::string name;
  bool schema = false;
  std::string all;
};

int write_all(const fs::path& folder) {
  std::vector<files::OutputFile> outputs;
  for (const std::string& name : files::described_formats()) {
    outputs.push_back({(folder / (name + ".md")).string(), files::write_format_page(name)});
    outputs.push_back(
        {(folder / (name + ".schema.json")).string(), files::write_format_schema(name)});
  }
  fs::create_directories(folder);
  files::write_whole_files(outputs);
  return kDone;
}

int run_formats(const FormatsCommand& command) {
  if (!command.all.empty()) return write_all(command.all);
  if (command.name.empty()) {
    for (const std::string& name : files::described_formats()) fmt::print("{}\n", name);
    say_next({"formats", files::described_formats().front()});
    return kDone;
  }
  fmt::print("{}",
             command.schema ? files::write_format_schema(command.name)
                            : files::write_format_page(command.name));
  if (!command.schema) say_next({"formats", command.name, "--schema"});
  return kDone;
}

}  // namespace

void add_formats(Verb app, Run& run) {
  auto command = std::make_shared<FormatsCommand>();
  Verb verb = app.add_verb(
      "formats", "Every key of a file format, with unit, range and default; or its JSON Schema");
  verb.add_option("name", command->name, "Which; without it they are listed")
      .one_of(files::described_formats());
  verb.add_flag("--schema", command->schema, "The JSON Schema, for editors");
  verb.add_option(
      "--all", command->all, "Write pages and schemas of all formats into this folder, anew");
  verb.footer(
      "Example:\n"
      "  build/chaintrue formats machine\n"
      "  build/chaintrue formats grid --schema");
  verb.when_chosen([command, &run] { run = [command] { return run_formats(*command); }; });
}

}  // namespace chaintrue::cli
