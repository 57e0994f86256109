// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/hdf5/session.hpp"

#include "io/hdf5/mutex.hpp"

namespace meshorder::hdf5 {

Session::Session() : lock_(library_mutex()) {
  H5Eget_auto2(H5E_DEFAULT, &handler_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Session::~Session() { H5Eset_auto2(H5E_DEFAULT, handler_, data_); }

std::string last_cause() {
  std::string cause;
  const auto take = [](unsigned /*depth*/, const H5E_error2_t* error, void* into) -> herr_t {
    if (error->desc != nullptr) *static_cast<std::string*>(into) = error->desc;
    return 0;
  };
  // from the function that was called to the one that failed
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, take, &cause);
  return cause;
}

}  // namespace meshorder::hdf5
