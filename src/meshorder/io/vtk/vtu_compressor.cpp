// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/io/vtk/vtu_compressor.hpp>

#include <vtkCallbackCommand.h>
#include <vtkDataCompressor.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkZLibDataCompressor.h>

namespace meshorder {

struct VtuCompressor::Implementation {
  vtkSmartPointer<vtkDataCompressor> compressor;
};

VtuCompressor::VtuCompressor(VtuEncoding::Compressor kind)
    : implementation_(std::make_unique<Implementation>()) {
  auto& compressor = implementation_->compressor;
  if (kind == VtuEncoding::Compressor::zlib) compressor = vtkSmartPointer<vtkZLibDataCompressor>::New();
  if (kind == VtuEncoding::Compressor::lz4) compressor = vtkSmartPointer<vtkLZ4DataCompressor>::New();
  if (kind == VtuEncoding::Compressor::lzma) compressor = vtkSmartPointer<vtkLZMADataCompressor>::New();
  // an observed object does not print its errors; they show in what it returns
  const vtkNew<vtkCallbackCommand> silence;
  silence->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  compressor->AddObserver(vtkCommand::ErrorEvent, silence);
  compressor->AddObserver(vtkCommand::WarningEvent, silence);
}

VtuCompressor::~VtuCompressor() = default;

std::uint64_t VtuCompressor::greatest_ratio(VtuEncoding::Compressor kind) {
  switch (kind) {
    case VtuEncoding::Compressor::zlib:
      return 1100;
    case VtuEncoding::Compressor::lz4:
      return 300;
    case VtuEncoding::Compressor::lzma:
      return 20000;
    case VtuEncoding::Compressor::none:
      break;
  }
  return 1;
}

std::string VtuCompressor::compress(std::span<const char> bytes) const {
  vtkDataCompressor& compressor = *implementation_->compressor;
  std::string result(compressor.GetMaximumCompressionSpace(bytes.size()), '\0');
  result.resize(compressor.Compress(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                                    reinterpret_cast<unsigned char*>(result.data()), result.size()));
  if (result.empty()) throw InvalidArgument("VTK's compressor failed");
  return result;
}

bool VtuCompressor::uncompress(std::span<const char> bytes, std::span<char> target) const {
  if (bytes.empty() || target.empty()) return target.empty();
  return implementation_->compressor->Uncompress(
             reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
             reinterpret_cast<unsigned char*>(target.data()), target.size()) == target.size();
}

}  // namespace meshorder
