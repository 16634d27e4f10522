// SPDX-License-Identifier: Apache-2.0
#pragma once

// A header of the consumer whose path equals that of a header of Tetwright.
namespace consumer {
struct Error {
  int status = 0;
};
}  // namespace consumer
