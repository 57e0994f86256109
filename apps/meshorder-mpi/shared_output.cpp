// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "shared_output.hpp"

#include "io/stream/file_path.hpp"

#include <vector>

namespace meshorder::command {

SharedOutput::SharedOutput(const distributed::Communicator& communicator, OutputSet& outputs,
                           const FilePath& target, std::string_view start)
    : communicator_(communicator) {
  path_ = communicator
              .broadcast(communicator.at_root([&] {
                file_.emplace(FilePath(target, outputs));
                file_->write(start);
                file_->close();
                return std::vector<std::string>{file_->temporary().string()};
              }))
              .front();
}

void SharedOutput::commit() {
  communicator_.at_root([&] { file_->commit(); });
}

}  // namespace meshorder::command
