#include "tools/prepare/notes.h"

#include "common/message_text.h"

namespace tetwright {

std::vector<std::string> notes_of(const PrepareReport& run) {
  std::vector<std::string> notes;
  std::string line, file;
  for (const InputFinding& f : run.findings) {
    line += line.empty() ? "" : "; ";
    if (f.file != file) line += f.file + ": ";
    file = f.file;
    line += std::to_string(f.finding.count) + " " + f.finding.what + " (" + f.finding.done + ")";
  }
  if (!line.empty()) notes.push_back(line);
  for (const RunNote& note : further_notes(run)) notes.push_back(note.text);
  return notes;
}

std::vector<RunNote> further_notes(const PrepareReport& run) {
  std::vector<RunNote> notes;
  for (const FeatureReport& f : run.features)
    if (f.found.dropped > 0)
      notes.push_back(
          {"'" + f.name + "' has " + std::to_string(f.found.dropped) +
               " patches between sharp edges smaller than eight faces of a cell (their edges are not kept; a "
               "higher resolution keeps them)",
           {}});
  if (!run.mesher) return notes;
  if (run.mesher->isolated_vertices > 0)
    notes.push_back(
        {std::to_string(run.mesher->isolated_vertices) +
             " parts or cavities of a single lattice point (left out; a higher resolution keeps them)",
         {}});
  for (const std::string& name : run.mesher->unknown)
    notes.push_back(
        {"'" + name +
             "' was not compared with its input: its surface is open, intersects itself or meets another, "
             "and cells of this size do not show it",
         {}});
  for (const ThinPartReport& t : run.mesher->thin_parts)
    notes.push_back({(t.name.empty() ? "a gap" : "'" + t.name + "'") + " is thinner than " +
                         (t.refined ? "the smallest cells can hold" : "two cells") + " at " +
                         std::to_string(t.places) + " places, the first at " + place_text(t.first) +
                         ": parts may tear or join there; a higher resolution keeps them",
                     t.first});
  return notes;
}

}  // namespace tetwright
