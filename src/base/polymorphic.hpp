// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

namespace meshorder {

/// Base of abstract classes; has a virtual destructor and cannot be copied or moved.
class Polymorphic {
 public:
  Polymorphic(const Polymorphic&) = delete;
  Polymorphic(Polymorphic&&) = delete;
  Polymorphic& operator=(const Polymorphic&) = delete;
  Polymorphic& operator=(Polymorphic&&) = delete;
  virtual ~Polymorphic() = default;

 protected:
  Polymorphic() = default;
};

}  // namespace meshorder
