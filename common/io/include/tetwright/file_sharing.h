// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace tetwright {

class Hdf5Writer;

/// Files with the pieces of a mesh, to be written by several processes that see the same folder.
struct PiecesToWrite {
  std::size_t count;
  std::function<void(std::size_t piece)> here;  ///< writes a piece in this process
  /// Bytes from which write_ordered_piece() writes it in another one. May be called while another thread
  /// calls `here`.
  std::function<std::string(std::size_t piece)> order;
};

/// How several processes write a mesh in parts, see write_tet_mesh(). Their exceptions are rethrown. This
/// process writes alone what has no function.
struct FileSharing {
  /// Has each piece written once, and returns when all are.
  std::function<void(const PiecesToWrite&)> pieces = {};
  /// Writes an HDF5 file to a temporary file, which exists.
  /// \param path of the file, for messages
  /// \param content adds the contents; called in this process alone
  std::function<void(const std::string& temporary, const std::string& path,
                     const std::function<void(Hdf5Writer&)>& content)>
      hdf5 = {};
};

/// Writes a piece from the bytes of PiecesToWrite::order.
/// \throws OutputError if the file cannot be written
void write_ordered_piece(std::string_view order);

}  // namespace tetwright
