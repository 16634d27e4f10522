// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tetwright {

/// Ends the processes of all ranks with the status of an OutputError, since this one cannot write `path`:
/// others may already wait for it where only its death reaches them.
///
/// \param temporary is removed; the rank that does so prints the message. Empty: this rank does
/// \param why end of the message
[[noreturn]] void end_all_ranks(const std::string& temporary, const std::string& path,
                                const std::string& why);

}  // namespace tetwright
