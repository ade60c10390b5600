// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/provenance_record.hpp"

#include "grid/files/sources.hpp"

namespace chaintrue::grid::files {
namespace {

Record<SourceFile> source_file_record() {
  return Record<SourceFile>("a file that was read")
      .required("name", "Its name, without folders.", &SourceFile::name)
      .required("sha256",
                "SHA-256 of its bytes, 64 hexadecimal digits, as sha256sum prints it.",
                &SourceFile::sha256);
}

}  // namespace

const Record<Provenance>& provenance_record() {
  static const auto record =
      Record<Provenance>("where a result comes from")
          .required("version", "Version of chaintrue.", &Provenance::version)
          .required("verb", "Verb of the command, or function, that made it.", &Provenance::verb)
          .required("options",
                    "Options as given, with files without their folders and without those that "
                    "name an output.",
                    &Provenance::options,
                    list(text()))
          .required("inputs",
                    "The files that were read, in order.",
                    &Provenance::inputs,
                    list(source_file_record()));
  return record;
}

Json with_made_by(Json document, const std::optional<Provenance>& made_by) {
  if (made_by) document["made_by"] = provenance_record().write(*made_by);
  return document;
}

std::optional<Provenance> made_by_of(const std::string& text, const std::string& file) {
  Problems problems(file);
  const Json document = parse_json(text, problems);
  if (!document.is_object() || !document.contains("made_by")) return std::nullopt;
  return provenance_record().read(Cursor(document, problems).child("made_by"));
}

}  // namespace chaintrue::grid::files
