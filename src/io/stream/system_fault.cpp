// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/system_fault.hpp"

#include <meshorder/error.hpp>

#include <cerrno>
#include <system_error>

namespace meshorder {

SystemFault system_fault(int error) {
  switch (error) {
    case ENOSPC:
      return {"the disk is full", "free some space or choose another folder"};
    case EDQUOT:
      return {"the quota of the disk is used up", "free some space or choose another folder"};
    case EFBIG:
      return {"it would exceed the limit on the size of files", "raise the limit (ulimit -f)"};
    case EIO:
      return {"the device reports an input/output error", "check the disk or choose another folder"};
    case EROFS:
      return {"the file system is read-only", "choose another folder"};
    case EACCES:
    case EPERM:
      return {"permission denied", "check the permissions of the file and its folder"};
    case ENAMETOOLONG:
      return {"its name is too long", "choose a shorter name"};
    case ELOOP:
      return {"its symbolic links lead in a circle", "remove the link"};
    case EPIPE:
      return {"the reader of the pipe has gone", "keep the reader open until all is written"};
    case EMFILE:
    case ENFILE:
      return {"too many files are open", "raise the limit (ulimit -n)"};
    default:
      return {std::generic_category().message(error), "check the file and its folder"};
  }
}

void throw_system_fault(const std::string& file, const std::string& what, int error) {
  const SystemFault fault = system_fault(error);
  throw InputError(file, what + ": " + fault.reason, fault.remedy);
}

}  // namespace meshorder
