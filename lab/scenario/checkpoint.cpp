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
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), &value, sizeof(Number));
    bytes_.append(raw.data(), raw.size());
  }
  void count(std::size_t size) { number(static_cast<std::uint64_t>(size)); }
  void text(std::string_view value) {
    count(value.size());
    bytes_ += value;
  }
  void bytes(std::string_view value) { bytes_ += value; }
  void point(const Point& value) {
    for (const double x : value) number(x);
  }
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

Index read_count(Scanner& file, std::string_view what, std::int64_t min_bytes) {
  return file.checked_count(file.binary<std::int64_t>(what), what, min_bytes);
}

Point read_point(Scanner& file) {
  Point point{};
  for (double& x : point) x = file.binary<double>("a coordinate");
  return point;
}

std::string read_text(Scanner& file) {
  const Index size = read_count(file, "the length of a text", 1);
  return std::string(file.binary_block(size, "a text"));
}

void pack(const Balance& balance, Packer& out) {
  for (const double energy : {balance.kinetic, balance.elastic, balance.potential}) out.number(energy);
  out.point(balance.momentum);
  out.point(balance.angular_momentum);
}

Balance read_balance(Scanner& file) {
  Balance balance;
  for (double* const energy : {&balance.kinetic, &balance.elastic, &balance.potential})
    *energy = file.binary<double>("an energy");
  balance.momentum = read_point(file);
  balance.angular_momentum = read_point(file);
  return balance;
}

/// Calls `work` on all numbers of a step, in the order of the file.
template <class Step, class Work>
void visit_numbers(Step& step, Work work) {
  auto& report = step.report;
  work(report.newton_iterations);
  work(report.cg_iterations);
  work(report.admm_iterations);
  work(report.contact_iterations);
  work(report.contacts);
  work(report.vertices_in_itself);
  work(report.newton_residual);
  work(report.residual);
  work(report.penetration);
  auto& seconds = report.seconds;
  for (auto* const part :
       {&seconds.total, &seconds.assembly, &seconds.solve, &seconds.local, &seconds.global,
        &seconds.collision, &seconds.triangulation, &seconds.order, &seconds.motion, &report.time_step})
    work(*part);
  work(step.shape_distance);
}
constexpr std::int64_t kMinStepBytes = 6 * 4 + 14 * 8;

void pack(const MotionRecord& record, Packer& out) {
  out.count(record.steps.size());
  for (const StepRecord& step : record.steps) {
    visit_numbers(step, [&](const auto& number) { out.number(number); });
  }
  out.count(record.balances.size());
  for (const Balance& balance : record.balances) pack(balance, out);
  out.count(record.warnings.size());
  for (const WarningRecord& warning : record.warnings) {
    out.text(warning.first);
    out.number(warning.first_step);
    out.number(warning.count);
  }
}

MotionRecord read_record(Scanner& file) {
  MotionRecord record;
  record.steps.resize(read_count(file, "the number of steps", kMinStepBytes));
  for (StepRecord& step : record.steps) {
    visit_numbers(step, [&](auto& number) {
      number = file.binary<std::remove_reference_t<decltype(number)>>("a number of a step");
    });
  }
  record.balances.resize(read_count(file, "the number of energies", 72));
  for (Balance& balance : record.balances) balance = read_balance(file);
  record.warnings.resize(read_count(file, "the number of warnings", 16));
  for (WarningRecord& warning : record.warnings) {
    warning.first = read_text(file);
    warning.first_step = file.binary<Index>("the step of a warning");
    warning.count = file.binary<Index>("the count of a warning");
  }
  return record;
}

MotionState read_state(Scanner& file) {
  MotionState state;
  state.step = file.binary<Index>("the number of steps");
  state.time = file.binary<double>("the time");
  state.positions.resize(read_count(file, "the number of vertices", 48));
  state.velocities.resize(state.positions.size());
  for (Point& point : state.positions) point = read_point(file);
  for (Point& velocity : state.velocities) velocity = read_point(file);
  state.memory.resize(read_count(file, "the numbers kept", 8));
  for (double& number : state.memory) number = file.binary<double>("a number kept");
  return state;
}

/// Checks the header and leaves the scanner after it.
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
  out.bytes(kMagic);
  out.number(kOrderMark);
  out.number(kCheckpointVersion);
  out.number(std::uint64_t{0});  // the length, filled in by finish
  out.number(checkpoint.fingerprint.mesh);
  out.number(checkpoint.fingerprint.order);
  out.number(checkpoint.fingerprint.parameters);
  const MotionState& state = checkpoint.state;
  out.number(state.step);
  out.number(state.time);
  out.count(state.positions.size());
  for (const Point& point : state.positions) out.point(point);
  for (const Point& velocity : state.velocities) out.point(velocity);
  out.count(state.memory.size());
  for (const double number : state.memory) out.number(number);
  pack(checkpoint.record, out);
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
  result.state = read_state(file);
  result.record = read_record(file);
  return result;
}

}  // namespace meshorder
