// SPDX-License-Identifier: MIT
#pragma once
#include <hdf5.h>

#include <utility>

namespace delf {

/// An HDF5 identifier, closed by the destructor. A negative one stands for a failed call.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() { close(); }

  explicit operator bool() const noexcept { return id_ >= 0; }
  operator hid_t() const noexcept { return id_; }
  /// True if closing went well: for a file, if its last bytes reached the disk.
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }
  /// Leaves it open for good.
  void abandon() noexcept { id_ = -1; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// HDF5 prints no error stack of its own, and tidies nothing up at exit: after a full disk it would never end.
inline void quiet_hdf5() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace delf
