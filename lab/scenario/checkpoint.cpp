// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// The file, in the machine's byte order: magic (16 bytes), byte order mark and version (4 each), size of the
// file (8); fingerprint, state and record; the CRC-32 of all bytes before it (4).
#include "lab/scenario/checkpoint.hpp"

#include "io/stream/output_file.hpp"
#include "io/stream/scanner.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstring>
#include <type_traits>

namespace meshorder {
namespace {

constexpr std::string_view kMagic = "meshorder state\n";
constexpr std::uint32_t kOrderMark = 0x01020304;
constexpr std::uint32_t kCheckpointVersion = 3;
constexpr std::size_t kLengthAt = kMagic.size() + 2 * sizeof(std::uint32_t);
constexpr std::size_t kHeader = kLengthAt + sizeof(std::uint64_t);

std::uint32_t checksum_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Collects the bytes of the file.
class Packer {
 public:
  template <class Number>
  void number(Number value, std::string_view /*what*/ = {}) {
    static_assert(std::is_arithmetic_v<Number>);
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), &value, sizeof(Number));
    bytes_.append(raw.data(), raw.size());
  }
  template <class List>
  void count(const List& list, std::string_view /*what*/, std::int64_t /*min_bytes*/) {
    number(static_cast<std::uint64_t>(list.size()));
  }
  void block(std::string_view value, std::string_view /*what*/ = {}) { bytes_ += value; }

  /// Fills in the length, appends the checksum and returns the bytes.
  std::string finish() {
    const std::uint64_t length = bytes_.size() + sizeof(std::uint32_t);
    std::memcpy(bytes_.data() + kLengthAt, &length, sizeof length);
    number(checksum_of(bytes_));
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

/// Reads what a Packer wrote. `what` names the value in errors.
class Unpacker {
 public:
  explicit Unpacker(Scanner& file) : file_(file) {}
  template <class Number>
  void number(Number& value, std::string_view what) {
    value = file_.binary<Number>(what);
  }
  /// Reads the size of a list whose entries take `min_bytes` or more.
  template <class List>
  void count(List& list, std::string_view what, std::int64_t min_bytes) {
    list.resize(file_.checked_count(file_.binary<std::int64_t>(what), what, min_bytes));
  }
  void block(std::string& value, std::string_view what) {
    value = file_.binary_block(static_cast<std::int64_t>(value.size()), what);
  }

 private:
  Scanner& file_;
};

template <class File, class Vector>
void visit_point(File& file, Vector& point) {
  for (auto& x : point) file.number(x, "a coordinate");
}

template <class File, class State>
void visit_state(File& file, State& state) {
  file.number(state.step, "the number of steps");
  file.number(state.time, "the time");
  file.count(state.positions, "the number of vertices", 2 * sizeof(Point));
  if constexpr (!std::is_const_v<State>) state.velocities.resize(state.positions.size());
  for (auto& point : state.positions) visit_point(file, point);
  for (auto& velocity : state.velocities) visit_point(file, velocity);
  file.count(state.memory, "the numbers kept", sizeof(double));
  for (auto& number : state.memory) file.number(number, "a number kept");
}

template <class File, class Step>
void visit_step(File& file, Step& step) {
  constexpr std::string_view kWhat = "a number of a step";
  auto& report = step.report;
  for (auto* const number : {&report.newton_iterations, &report.cg_iterations, &report.admm_iterations,
                             &report.contact_iterations, &report.contacts, &report.vertices_in_itself})
    file.number(*number, kWhat);
  auto& seconds = report.seconds;
  for (auto* const number :
       {&report.newton_residual, &report.residual, &report.penetration, &seconds.total, &seconds.assembly,
        &seconds.solve, &seconds.local, &seconds.global, &seconds.collision, &seconds.triangulation,
        &seconds.order, &seconds.motion, &report.time_step, &step.shape_distance})
    file.number(*number, kWhat);
}

template <class File, class Record>
void visit_record(File& file, Record& record) {
  constexpr std::int64_t kMinStepBytes = 6 * 4 + 14 * 8;
  file.count(record.steps, "the number of steps", kMinStepBytes);
  for (auto& step : record.steps) visit_step(file, step);
  file.count(record.balances, "the number of energies", 3 * sizeof(double) + 2 * sizeof(Point));
  for (auto& balance : record.balances) {
    for (auto* const energy : {&balance.kinetic, &balance.elastic, &balance.potential})
      file.number(*energy, "an energy");
    visit_point(file, balance.momentum);
    visit_point(file, balance.angular_momentum);
  }
  file.count(record.warnings, "the number of warnings", 16);
  for (auto& warning : record.warnings) {
    file.count(warning.first, "the length of a text", 1);
    file.block(warning.first, "a text");
    file.number(warning.first_step, "the step of a warning");
    file.number(warning.count, "the count of a warning");
  }
}

/// Checks the header and the checksum; leaves the scanner after the header.
void read_header(Scanner& file) {
  if (!file.all().starts_with(kMagic))
    file.fail_at_byte("is not a checkpoint", "give a file that simulate --checkpoint wrote");
  (void)file.binary_block(static_cast<std::int64_t>(kMagic.size()), "the magic");
  if (file.binary<std::uint32_t>("the byte order") != kOrderMark)
    file.fail_at_byte("comes from a machine with the other byte order",
                      "continue on the kind of machine that wrote it");
  const auto version = file.binary<std::uint32_t>("the version");
  if (version != kCheckpointVersion)
    file.fail_at_byte(fmt::format("has version {}", version),
                      fmt::format("this program reads {}", kCheckpointVersion));
  const auto length = file.binary<std::uint64_t>("the length");
  const std::string_view all = file.all();
  if (all.size() < length) {
    file.seek(static_cast<std::int64_t>(all.size()));
    file.fail_at_byte(fmt::format("ends here, but should have {} bytes", length), "it was cut short");
  }
  if (all.size() > length) {
    file.seek(static_cast<std::int64_t>(length));
    file.fail_at_byte("continues after its end", "it was changed");
  }
  if (length < kHeader + sizeof(std::uint32_t)) file.fail_at_byte("is too short", "it was changed");
  const std::size_t end = all.size() - sizeof(std::uint32_t);
  std::uint32_t expected = 0;
  std::memcpy(&expected, all.data() + end, sizeof expected);
  if (checksum_of(all.substr(0, end)) != expected) {
    file.seek(static_cast<std::int64_t>(end));
    file.fail_at_byte("its checksum does not match its content", "it was changed or damaged");
  }
}

}  // namespace

void write_checkpoint(const Checkpoint& checkpoint, const std::filesystem::path& path) {
  Packer out;
  out.block(kMagic);
  out.number(kOrderMark);
  out.number(kCheckpointVersion);
  out.number(std::uint64_t{0});  // the length, filled in by finish
  out.number(checkpoint.fingerprint.mesh);
  out.number(checkpoint.fingerprint.order);
  out.number(checkpoint.fingerprint.parameters);
  visit_state(out, checkpoint.state);
  visit_record(out, checkpoint.record);
  OutputFile file(path);
  file.write(out.finish());
  file.commit();
}

Checkpoint read_checkpoint(const FilePath& path, const Fingerprint& expected) {
  Scanner file(path);
  read_header(file);
  Checkpoint result;
  for (std::uint64_t* const sum :
       {&result.fingerprint.mesh, &result.fingerprint.order, &result.fingerprint.parameters})
    *sum = file.binary<std::uint64_t>("a fingerprint");
  const auto refuse = [&](const char* what, const char* remedy) {
    file.seek(static_cast<std::int64_t>(kHeader));
    file.fail_at_byte(what, remedy);
  };
  if (result.fingerprint.mesh != expected.mesh)
    refuse("is of another mesh or size", "give the scenario and --mesh that it was written with");
  if (result.fingerprint.order != expected.order)
    refuse("is of another order",
           "give the --vertices, --elements and --order-every that it was written with");
  if (result.fingerprint.parameters != expected.parameters)
    refuse("is of another scenario", "give the scenario, --preconditioner and --precision of its run");
  Unpacker in(file);
  visit_state(in, result.state);
  visit_record(in, result.record);
  return result;
}

}  // namespace meshorder
