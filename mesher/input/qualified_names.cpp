// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/qualified_names.h"

#include <cstddef>
#include <set>

#include "common/message_text.h"

namespace tetwright {

namespace {

void add_finding(const std::string& what, const NamesOfBody& body, std::vector<Diagnostic>& findings) {
  std::size_t count = 0;
  std::string first;
  for (const auto& [own, used] : body.names) {
    if (used == own) continue;
    if (count++ == 0) first = in_quotes(own) + " -> " + in_quotes(used);
  }
  if (count == 0) return;
  const std::string done =
      std::string("changed, as others have ") + (count > 1 ? "them, too; the first: " : "it, too: ") + first;
  findings.push_back({.code = DiagnosticCode::names_qualified,
                      .file = body.file,
                      .what = what,
                      .count = count,
                      .done = done});
}

}  // namespace

void qualify_names(const std::string& what, std::vector<NamesOfBody>& bodies, UniqueNames& taken,
                   std::vector<Diagnostic>& findings) {
  std::map<std::string, std::size_t> bodies_with;
  for (const NamesOfBody& body : bodies)
    for (const auto& [own, used] : body.names) ++bodies_with[own];
  std::set<std::string> shared;
  for (const auto& [own, count] : bodies_with)
    if (count > 1 || taken.has(own))
      shared.insert(own);
    else
      (void)taken.add(own);
  for (NamesOfBody& body : bodies) {
    for (auto& [own, used] : body.names) {
      if (!shared.contains(own))
        used = own;
      else
        used = taken.add(body.body.empty() ? own : body.body + ":" + own);
    }
    add_finding(what, body, findings);
  }
}

}  // namespace tetwright
