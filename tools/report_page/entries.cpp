#include "tools/report_page/entries.h"

#include "tools/report.h"

namespace tetwright {

namespace {

PageEntry entry_of(const InputFinding& f) {
  PageEntry entry{f.file + ": " + std::to_string(f.finding.count) + " " + f.finding.what, f.finding.done, {}};
  if (f.finding.place) entry.places.push_back(*f.finding.place);
  return entry;
}

void add_check(const CheckReport& check, PageEntries& entries) {
  for (const MeshFinding& f : check.findings)
    (is_warning(f.fault) ? entries.found : entries.short_of).push_back({mesh_finding_line(f), "", f.positions});
  if (check.topology_differences)
    for (const std::string& difference : *check.topology_differences)
      entries.short_of.push_back({"topology differs: " + difference, "", {}});
}

}  // namespace

PageEntries page_entries(const RunReport& run, const CheckReport* check) {
  PageEntries entries;
  for (const Shortfall& s : run.shortfall) entries.short_of.push_back({s.message, "", s.places});
  for (const InputFinding& f : run.findings) entries.found.push_back(entry_of(f));
  for (const RunNote& note : further_notes(run))
    entries.found.push_back({note.text, "", note.place ? std::vector<Vec3>{*note.place} : std::vector<Vec3>{}});
  if (check) add_check(*check, entries);
  return entries;
}

}  // namespace tetwright
