// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/places.hpp"

#include <unistd.h>
#include <memory>

#include <fstream>
#include <utility>

#include <CLI/CLI.hpp>

#include "tools/cli/talk.hpp"

namespace chaintrue::cli {
namespace {

namespace fs = std::filesystem;

std::function<Words()> path_of(const std::string& option) {
  return [&option] { return Words(option.empty() ? 0 : 1, option); };
}

bool is_standard_output(const fs::path& path) {
  return path == "-" || path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
}

/// The place of an output: the file, or its future name; empty for a device.
fs::path place_of_output(const fs::path& path) {
  if (is_standard_output(path)) return "-";
  std::error_code error;
  if (fs::is_character_file(path, error)) return {};
  return fs::weakly_canonical(fs::absolute(path, error), error);
}

bool is_regular(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// One regular file under any name: g.json, ./g.json, a link to it.
bool is_among(const std::vector<fs::path>& files, const fs::path& path) {
  std::error_code error;
  return is_regular(path) &&
         any_of(files, [&](const fs::path& other) { return fs::equivalent(path, other, error); });
}

std::string beginning_of(const fs::path& path) {
  // The longest file that is read beyond its beginning to recognise it.
  constexpr std::size_t kMost = std::size_t{64} << 20U;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  char buffer[1 << 16];
  while (text.size() < kMost && (file.read(buffer, sizeof buffer) || file.gcount() > 0))
    text.append(buffer, as_size(file.gcount()));
  return text;
}

class PlaceCheck {
 public:
  PlaceCheck() : inputs_(files::files_read()) {
    for (const Place& place : declared().places) {
      if (!place.verb.is_chosen()) continue;
      for (const std::string& path : place.paths()) {
        if (!place.kinds.empty()) {
          outputs_.emplace_back(path, &place);
        } else {
          inputs_.emplace_back(path == "-" ? "/dev/stdin" : path);
        }
      }
    }
  }

  /// Null if no option of the verb has this output.
  const Place* output_named(const std::string& path) const {
    for (const auto& [named, place] : outputs_) {
      if (named == path) return place;
    }
    return nullptr;
  }

  void look_at_all() {
    for (const auto& [path, place] : outputs_) look_at(path, *place);
  }

  void look_at(const std::string& path, const Place& place) {
    const fs::path taken = place_of_output(path);
    const bool is_printed = taken == "-";
    if (!taken.empty() && (contains(taken_, taken) || is_among(taken_, taken)))
      return add(path, "a name given twice", "a different file for each output",
                 ProblemKind::output_repeated);
    taken_.push_back(taken);
    if (is_among(inputs_, is_printed ? "/dev/stdout" : path))
      return add(path, "a file that is read here",
                 "another name, because an input file is never replaced",
                 ProblemKind::output_is_input);
    if (is_printed) return;
    look_at_folder(path);
    if (!is_regular(path) || place.verb.is_given("--force")) return;
    const std::string old = beginning_of(path);
    if (old.empty()) return;
    const Origin origin = files::origin_of(old);
    if (contains(place.kinds, origin)) return;
    add(path,
        origin == Origin::foreign   ? "a file that chaintrue did not make"
        : origin == Origin::changed ? "a file that somebody wrote or changed"
                                    : "a file of another kind",
        "another name, or --force to replace it", ProblemKind::output_not_ours);
  }

  void throw_if_any() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  void look_at_folder(const fs::path& path) {
    std::error_code error;
    if (fs::is_directory(path, error))
      return add(path.string(), "a directory", "the name of a file");
    if (error == std::errc::filename_too_long || error == std::errc::too_many_symbolic_link_levels)
      return add(path.string(), error.message(), "the name of a file");
    if (fs::exists(path, error) || fs::is_symlink(path, error)) return;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error)) {
      add(path.string(), "a folder that does not exist", "an existing folder, or none");
    } else if (::access(folder.c_str(), W_OK | X_OK) != 0) {
      add(path.string(), "a folder that may not be written to", "another folder");
    }
  }

  void add(std::string path, std::string found, std::string expected,
           ProblemKind kind = ProblemKind::output_place) {
    problems_.push_back({std::move(path), "", std::move(found), std::move(expected), {}, kind});
  }

  std::vector<std::pair<std::string, const Place*>> outputs_;
  std::vector<fs::path> inputs_;
  std::vector<fs::path> taken_;
  std::vector<files::InputProblem> problems_;
};

/// The outputs by file.
Outputs looked_at(const Outputs& outputs) {
  end_progress();
  PlaceCheck check;
  Outputs result;
  for (const files::OutputFile& output : outputs) {
    if (output.path.empty()) continue;
    // Standard output needs no option.
    static const Place kAnswers;
    const Place* place =
        is_standard_output(output.path) ? &kAnswers : check.output_named(output.path.string());
    if (place == nullptr)
      throw std::logic_error("an output that no option named: " + output.path.string());
    std::string text = output.text;
    for (const Origin kind : place->kinds) text = files::signed_text(text, kind);
    check.look_at(output.path.string(), *place);
    result.push_back({output.path, std::move(text)});
  }
  check.throw_if_any();
  return result;
}

/// The word after an option without a value is not its name, as in --svg= --force.
std::string fault_of(const std::string& name) {
  if (name.empty()) return "an empty name, expected the name of a file";
  if (name.size() > 1 && name.front() == '-')
    return name + ", expected the name of a file; ./" + name + " where it is one";
  return "";
}

void add_force(Verb verb) {
  if (verb.has_option("--force")) return;
  verb.app().add_flag("--force")->description(
      "Overwrite files that chaintrue did not write, or that were changed since");
}

Value placed(const Value& value, std::function<Words()> paths, std::vector<Origin> kinds = {}) {
  return value.with([paths = std::move(paths), kinds = std::move(kinds)](Verb verb, auto& names,
                                                                         CLI::Option& option) {
    declared().places.push_back({verb.with_name(), names, paths, kinds});
    if (kinds.empty()) return;
    add_force(verb);
    option.check(CLI::Validator(fault_of, ""));
  });
}

}  // namespace

Value reads(std::string& path) { return placed(path, path_of(path)); }

Value reads(Words& paths) {
  return placed(paths, [&paths] { return paths; });
}

Value writes(std::string& path, std::vector<Origin> kinds) {
  return placed(path, path_of(path), std::move(kinds));
}

Value writes_into(std::string& folder) {
  return Value(folder).with([](Verb verb, auto&, auto&) { add_force(verb); });
}

const Place* place_of(const std::string& option) {
  for (const Place& place : declared().places) {
    const std::string names = "," + place.names + ",";
    if (place.verb.is_chosen() && names.find("," + option + ",") != std::string::npos)
      return &place;
  }
  return nullptr;
}

void check_folder(Verb verb, const std::string& folder, const std::vector<FolderFile>& contents) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  PlaceCheck check;
  for (const FolderFile& file : contents)
    check.look_at((fs::path(folder) / file.name).string(), {verb, "", {}, {file.kind}});
  check.throw_if_any();
}

void write_folder(Verb verb, const std::string& folder, const std::vector<FolderFile>& contents) {
  if (folder.empty() || folder.front() == '-')
    refuse("the folder", folder.empty() ? "an empty name" : folder,
           "the name of a folder; it will hold many files", ProblemKind::output_place);
  std::error_code error;
  const bool is_new = fs::create_directories(folder, error);
  if (error)
    refuse(folder, error.message(), "a folder that can be created or written to",
           ProblemKind::output_place);
  try {
    check_folder(verb, folder, contents);
    Outputs outputs;
    for (const FolderFile& file : contents)
      outputs.push_back({fs::path(folder) / file.name, files::signed_text(file.text, file.kind)});
    files::write_whole_files(outputs);
  } catch (...) {
    if (is_new) fs::remove(folder, error);
    throw;
  }
}

void check_places() {
  PlaceCheck check;
  check.look_at_all();
  check.throw_if_any();
}

Words report_words(const std::string& path) {
  return {"report", path, "-o", fs::path(path).replace_extension(".html").string()};
}

void write_output(const std::string& path, const std::string& text) {
  write_outputs({{path, text}});
}

void write_outputs(const Outputs& outputs) { files::write_whole_files(looked_at(outputs)); }

void take_place(PendingFile& pending, const std::string& path, const Outputs& others) {
  Outputs all = {{path, ""}};
  append_all(all, others);
  all = looked_at(all);
  std::vector<std::unique_ptr<PendingFile>> alongside;
  std::vector<PendingFile*> together = {&pending};
  for (std::size_t i = 1; i < all.size(); ++i) {
    together.push_back(alongside.emplace_back(std::make_unique<PendingFile>(all[i].path)).get());
    together.back()->write(all[i].text);
  }
  take_places(together);
}

}  // namespace chaintrue::cli
