// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/hdf5/handle.hpp"

#include "io/hdf5/session.hpp"

namespace meshorder::hdf5 {

Handle::~Handle() { (void)close(); }

herr_t Handle::close() {
  if (id_ < 0) return 0;
  const Session session;
  return close_(std::exchange(id_, -1));
}

}  // namespace meshorder::hdf5
