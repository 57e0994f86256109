// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "shared_output.hpp"

#include "io/stream/file_path.hpp"

#include <vector>

namespace meshorder::command {

SharedOutput::SharedOutput(const distributed::Communicator& communicator, OutputSet& outputs,
                           const std::string& name, std::string_view start)
    : communicator_(communicator) {
  const std::string path = communicator.at_root([&] {
    file_.emplace(FilePath(name, outputs));
    file_->write(start);
    file_->close();
    return file_->temporary().string();
  });
  const std::vector<char> characters = communicator.broadcast(std::vector<char>(path.begin(), path.end()));
  path_.assign(characters.begin(), characters.end());
}

void SharedOutput::commit() {
  communicator_.at_root([&] { file_->commit(); });
}

}  // namespace meshorder::command
