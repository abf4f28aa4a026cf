// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Ownership of HDF5 objects. Only for the sources that read and write HDF5.

#ifndef FLOCKLIFT_SIMULATE_CORE_HDF5_HANDLE_H_
#define FLOCKLIFT_SIMULATE_CORE_HDF5_HANDLE_H_

#include <hdf5.h>

#include <utility>

namespace flocklift::internal {

// Closes an identifier with the function that fits it, e.g. Hdf5Handle(H5Fopen(...), H5Fclose).
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (IsOpen() && close_ != nullptr) close_(id_);
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }

  hid_t get() const { return id_; }
  bool IsOpen() const { return id_ >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

// While one of these lives, HDF5 does not print its errors: we tell them in our words.
class SilentHdf5 {
 public:
  SilentHdf5() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~SilentHdf5() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  SilentHdf5(const SilentHdf5&) = delete;
  SilentHdf5& operator=(const SilentHdf5&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_HDF5_HANDLE_H_
