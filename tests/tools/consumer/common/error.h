// SPDX-License-Identifier: Apache-2.0
#pragma once

// A header of the consumer's whose path is also that of one within Tetwright.
namespace consumer {
struct Error {
  int status = 0;
};
}  // namespace consumer
