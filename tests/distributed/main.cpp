// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/communicator.hpp"

#include <gtest/gtest.h>

/// Runs all tests on all ranks. Only the root prints; other ranks print failures only.
int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const meshorder::distributed::Session session(argc, argv);
  const bool is_root = meshorder::distributed::Communicator().is_root();
  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  class FailuresOnly : public testing::EmptyTestEventListener {
    void OnTestPartResult(const testing::TestPartResult& result) override {
      if (result.failed()) {
        std::cerr << result.file_name() << ":" << result.line_number() << ": " << result.message() << "\n";
      }
    }
  };
  if (!is_root) {
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailuresOnly);
  }
  return RUN_ALL_TESTS();
}
