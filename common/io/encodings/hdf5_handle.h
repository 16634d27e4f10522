// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <utility>

namespace tetwright {

/// An HDF5 object, closed on destruction.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close_by)(hid_t)) : id_(id), close_(close_by) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t id() const { return id_; }
  bool good() const { return id_ >= 0; }
  /// Closes it now; its data may be written only then.
  /// \return negative on failure
  herr_t close() { return close_(release()); }
  /// The object, which is no longer closed on destruction.
  hid_t release() { return std::exchange(id_, -1); }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Stops the library from printing its error stack. Each thread has its own stack.
inline void quiet_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

}  // namespace tetwright
