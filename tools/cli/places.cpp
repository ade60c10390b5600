// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/places.hpp"

#include <fmt/format.h>
#include <memory>
#include <unistd.h>

#include <fstream>
#include <optional>
#include <utility>

#include "grid/containers.hpp"
#include "grid/files/file_identity.hpp"
#include "tools/cli/progress.hpp"

namespace chaintrue::cli {
namespace {

namespace fs = std::filesystem;

/// An option that names files; the names are known after parsing.
struct Place {
  Verb verb;
  std::string names;  ///< "-o,--output"
  std::function<Words()> paths;
  std::vector<Origin> kinds;  ///< of an output; none for an input
};

std::function<Words()> path_of(const std::string& option) {
  return [&option] { return Words(option.empty() ? 0 : 1, option); };
}

/// For all verbs of the current command line.
std::vector<Place>& places() {
  static std::vector<Place> all;
  return all;
}

bool is_standard_output(const fs::path& path) {
  return path == "-" || path == "/dev/stdout" || path == "/dev/fd/1" || path == "/proc/self/fd/1";
}

std::optional<files::FileIdentity> identity_of_output(const fs::path& path) {
  return is_standard_output(path) ? files::identity_of_descriptor(STDOUT_FILENO)
                                  : files::identity_of(path);
}

std::optional<files::FileIdentity> identity_of_input(const fs::path& path) {
  return path == "-" ? files::identity_of_descriptor(STDIN_FILENO) : files::identity_of(path);
}

/// The identity of an output: the file, or its future name.
std::string place_of(const fs::path& path) {
  if (is_standard_output(path)) return "-";
  std::error_code error;
  if (fs::is_character_file(path, error)) return "";
  if (const auto identity = files::identity_of(path))
    return fmt::format("{}:{}", identity->device, identity->number);
  return fs::weakly_canonical(fs::absolute(path, error), error).string();
}

std::string beginning_of(const fs::path& path) {
  // The longest file that is read beyond its beginning to recognise it.
  constexpr std::size_t kMost = std::size_t{64} << 20U;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  char buffer[1 << 16];
  while (text.size() < kMost && (file.read(buffer, sizeof buffer) || file.gcount() > 0))
    text.append(buffer, static_cast<std::size_t>(file.gcount()));
  return text;
}

class PlaceCheck {
 public:
  explicit PlaceCheck(const std::vector<Place>& chosen) {
    for (const Place& place : chosen) {
      if (!place.kinds.empty()) continue;
      for (const std::string& path : place.paths()) {
        if (const auto identity = identity_of_input(path)) inputs_.push_back(*identity);
      }
    }
    const auto read = files::files_read();
    grid::append_all(inputs_, read);
  }

  void look_at(const std::string& path, const Place& place) {
    const std::string taken = place_of(path);
    if (!taken.empty() && grid::contains(taken_, taken))
      return add(path,
                 "a name given twice",
                 "a different file for each output",
                 ProblemKind::output_repeated);
    taken_.push_back(taken);
    const auto identity = identity_of_output(path);
    if (identity && grid::contains(inputs_, *identity))
      return add(path,
                 "a file that is read here",
                 "another name, because an input file is never replaced",
                 ProblemKind::output_is_input);
    if (is_standard_output(path)) return;
    look_at_folder(path);
    if (!identity || place.verb.is_given("--force")) return;
    const std::string old = beginning_of(path);
    if (old.empty()) return;
    const Origin origin = files::origin_of(old);
    if (grid::contains(place.kinds, origin)) return;
    add(path,
        origin == Origin::foreign   ? "a file that chaintrue did not make"
        : origin == Origin::changed ? "a file that somebody wrote or changed"
                                    : "a file of another kind",
        "another name, or --force to replace it",
        ProblemKind::output_not_ours);
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

  void add(std::string path,
           std::string found,
           std::string expected,
           ProblemKind kind = ProblemKind::output_place) {
    problems_.push_back({std::move(path), "", std::move(found), std::move(expected), {}, kind});
  }

  std::vector<files::FileIdentity> inputs_;
  std::vector<std::string> taken_;
  std::vector<files::InputProblem> problems_;
};

std::vector<Place> chosen_places() {
  std::vector<Place> chosen;
  for (const Place& place : places()) {
    if (place.verb.is_chosen()) chosen.push_back(place);
  }
  return chosen;
}

const Place* output_named(const std::vector<Place>& chosen, const std::string& path) {
  for (const Place& place : chosen) {
    if (!place.kinds.empty() && grid::contains(place.paths(), path)) return &place;
  }
  return nullptr;
}

/// The outputs by file.
Outputs looked_at(const Outputs& outputs) {
  end_progress();
  const std::vector<Place> chosen = chosen_places();
  PlaceCheck check(chosen);
  Outputs result;
  for (const files::OutputFile& output : outputs) {
    if (output.path.empty()) continue;
    // Standard output needs no option.
    static const Place kAnswers;
    const Place* place =
        is_standard_output(output.path) ? &kAnswers : output_named(chosen, output.path.string());
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

void add_force(Verb verb) {
  if (verb.has_option("--force")) return;
  verb.add_flag("--force",
                "Overwrite files that chaintrue did not write, or that were changed since");
}

}  // namespace

Option add_input(Verb verb, const std::string& names, std::string& path, const std::string& help) {
  places().push_back({verb.with_name(), names, path_of(path), {}});
  return verb.add_option(names, path, help);
}

Option add_input(Verb verb, const std::string& names, Words& paths, const std::string& help) {
  places().push_back({verb.with_name(), names, [&paths] { return paths; }, {}});
  return verb.add_option(names, paths, help);
}

Option add_output(Verb verb,
                  const std::string& names,
                  std::string& path,
                  std::vector<Origin> kinds,
                  const std::string& help) {
  places().push_back({verb.with_name(), names, path_of(path), std::move(kinds)});
  Option option = verb.add_option(names, path, help);
  option.refuses([](const std::string& text) -> std::string {
    if (text.empty()) return "an empty name, expected the name of a file";
    // The word after an option without a value: --svg= --force.
    if (text.size() > 1 && text.front() == '-')
      return text + ", expected the name of a file; ./" + text + " where it is one";
    return "";
  });
  add_force(verb);
  return option;
}

PlaceUse use_of(Verb verb, const std::string& option) {
  const std::string path = verb.path();
  for (const Place& place : places()) {
    const std::string names = "," + place.names + ",";
    if (place.verb.path() != path || names.find("," + option + ",") == std::string::npos) continue;
    return place.kinds.empty() ? PlaceUse::input : PlaceUse::output;
  }
  return PlaceUse::nothing;
}

Option add_output_folder(Verb verb,
                         const std::string& names,
                         std::string& path,
                         const std::string& help) {
  Option option = verb.add_option(names, path, help);
  add_force(verb);
  return option;
}

void check_folder(Verb verb, const std::string& folder, const std::vector<FolderFile>& contents) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  PlaceCheck check(chosen_places());
  for (const FolderFile& file : contents)
    check.look_at((fs::path(folder) / file.name).string(), {verb, "", {}, {file.kind}});
  check.throw_if_any();
}

void write_folder(Verb verb, const std::string& folder, const std::vector<FolderFile>& contents) {
  if (folder.empty() || folder.front() == '-')
    refuse("the folder",
           folder.empty() ? "an empty name" : folder,
           "the name of a folder; it will hold many files",
           ProblemKind::output_place);
  std::error_code error;
  const bool is_new = fs::create_directories(folder, error);
  if (error)
    refuse(folder,
           error.message(),
           "a folder that can be created or written to",
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

void forget_places() { places().clear(); }

void check_places() {
  const std::vector<Place> chosen = chosen_places();
  PlaceCheck check(chosen);
  for (const Place& place : chosen) {
    if (place.kinds.empty()) continue;
    for (const std::string& path : place.paths()) check.look_at(path, place);
  }
  check.throw_if_any();
}

std::string page_alongside(const std::string& path) {
  return fs::path(path).replace_extension(".html").string();
}

void write_output(const std::string& path, const std::string& text) {
  write_outputs({{path, text}});
}

void write_outputs(const Outputs& outputs) { files::write_whole_files(looked_at(outputs)); }

void take_place(files::PendingFile& pending, const std::string& path, const Outputs& others) {
  Outputs all = {{path, ""}};
  grid::append_all(all, others);
  all = looked_at(all);
  std::vector<std::unique_ptr<files::PendingFile>> alongside;
  std::vector<files::PendingFile*> together = {&pending};
  for (std::size_t i = 1; i < all.size(); ++i) {
    together.push_back(
        alongside.emplace_back(std::make_unique<files::PendingFile>(all[i].path)).get());
    together.back()->write(all[i].text);
  }
  take_places(together);
}

}  // namespace chaintrue::cli
