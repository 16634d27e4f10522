// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tetwright {

/// Contents of a file that its reader ignores, to be reported to the user.
struct Dropped {
  std::string what;       ///< plural, for example "quads" or "groups (\"wheel\", \"door\")"
  std::size_t count = 0;  ///< at least 1
  /// True: nothing is lost, since it follows from the data read. Writers derive it anew.
  bool restored = false;

  bool operator==(const Dropped&) const = default;
};

/// Counts of items by kind, in the order in which the kinds first appeared.
class KindCounts {
 public:
  /// `kind` is a plural.
  void add(const std::string& kind, std::size_t n = 1);
  bool empty() const { return counts_.empty(); }
  /// "12 hexahedra and 3 pyramids"
  std::string text() const;
  /// Appends one entry for each kind.
  void append_to(std::vector<Dropped>& dropped) const;

 private:
  std::vector<Dropped> counts_;
};

/// Message that rejects volume cells other than linear tets: their kinds and numbers, and how to convert
/// them.
/// \param first location of the first of them, for example "element 7"
std::string unsupported_cells(const KindCounts& cells, const std::string& first);

/// Formats the first few names for a message: "a", "b" and 3 more.
std::string quoted_list(const std::vector<std::string>& names);

/// Appends an entry whose `what` ends with the names in brackets and whose count is their number; nothing if
/// there are none.
void append_dropped_names(std::vector<Dropped>& dropped, const std::string& what,
                          const std::vector<std::string>& names);

}  // namespace tetwright
