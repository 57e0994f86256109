// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/exodus/netcdf.hpp"

#include "base/memory.hpp"
#include "io/exact_values.hpp"
#include "io/exodus/netcdf_library.hpp"
#include "io/stream/descriptor.hpp"
#include "io/stream/read_limits.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <memory>
#include <numeric>
#include <system_error>
#include <type_traits>
#include <utility>

namespace meshorder::exodus {

const NcType kChar = NC_CHAR;
const NcType kInt = NC_INT;
const NcType kInt64 = NC_INT64;
const NcType kFloat = NC_FLOAT;
const NcType kDouble = NC_DOUBLE;

namespace {

constexpr const char* kNameInMemory = "mesh";   // netCDF might read another name as a URL
constexpr std::uint64_t kMostExpansion = 1032;  // largest ratio that deflate can reach
constexpr std::size_t kBuffer = std::size_t{1} << 18;

/// Types of netCDF, in the order of the alternatives of Values.
constexpr std::array<NcType, 10> kTypesOfValues{NC_DOUBLE, NC_FLOAT, NC_BYTE, NC_UBYTE, NC_SHORT,
                                                NC_USHORT, NC_INT,   NC_UINT, NC_INT64, NC_UINT64};

/// Returns the alternative of Values for a type; the alternative of texts if the type is not numeric.
std::size_t alternative_of(NcType type) {
  return static_cast<std::size_t>(std::find(kTypesOfValues.begin(), kTypesOfValues.end(), type) -
                                  kTypesOfValues.begin());
}

std::size_t product(const std::vector<std::size_t>& lengths) {
  return std::accumulate(lengths.begin(), lengths.end(), std::size_t{1}, std::multiplies<>());
}

}  // namespace

bool is_whole(NcType type) { return are_integers(values_of_type(alternative_of(type))); }

std::size_t size_of(NcType type) {
  return type == NC_CHAR ? 1 : static_cast<std::size_t>(size_of_type(alternative_of(type)));
}

bool can_hold(NcType type, const Values& values) {
  return with_numbers(values_of_type(alternative_of(type)),
                      [&]<class Number>(const std::vector<Number>&) { return are_exact<Number>(values); });
}

Attribute text_attribute(std::string name, std::string text) {
  const std::size_t count = text.size();
  return {std::move(name), kChar, count, std::move(text)};
}

Storage plain_storage(bool large) { return {large ? NC_FORMAT_CDF5 : NC_FORMAT_64BIT_OFFSET}; }

// ---- reading

NcInput::NcInput(const FilePath& path) : name_(path.string()) {
  constexpr std::size_t kStart = 8;
  std::error_code code;
  const bool on_disk = path.store() == nullptr && std::filesystem::is_regular_file(path.path(), code) &&
                       without_gz(path.path()) == path.path();
  if (on_disk) {
    file_.emplace(path.open());
    count_file(path, file_->size());
  } else {
    memory_ = path.read();
  }
  size_ = on_disk ? file_->size() : memory_.size();
  const auto first = [&](std::size_t bytes) {
    if (!on_disk) return memory_.substr(0, bytes);
    std::string result(std::min<std::uint64_t>(bytes, size_), '\0');
    result.resize(file_->read_at(0, result));
    return result;
  };
  const std::string start = first(kStart);
  if (start.empty()) fail("is empty", "give a file");
  if (start.starts_with("CDF")) {
    check_classic_header(name_, first, size_);
  } else if (start.starts_with("\x89HDF\r\n\x1a\n")) {
    require_whole_hdf5(on_disk ? file_->path_for_libraries() : "", memory_, name_);
  } else {
    throw InputError(Location{name_, 0, 0}, "is not a netCDF file", "an Exodus file begins with CDF or HDF");
  }
  if (on_disk) {
    std::size_t buffer = kBuffer;
    check(nc__open(file_->path_for_libraries().c_str(), NC_NOWRITE, &buffer, &id_), "");
  } else {
    check(nc_open_mem(kNameInMemory, NC_NOWRITE, memory_.size(), memory_.data(), &id_), "");
  }
  try {
    inquire();
  } catch (...) {
    nc_close(id_);
    throw;
  }
}

NcInput::~NcInput() { nc_close(id_); }

void NcInput::fail(const std::string& what, const std::string& remedy) const {
  throw InputError(name_, what, remedy);
}

void NcInput::check(int status, const std::string& what) const {
  if (status == NC_NOERR) return;
  fail(fmt::format("{}netCDF says: {}", what.empty() ? "" : what + ": ", nc_strerror(status)));
}

void NcInput::inquire() {
  int dimension_count = 0;
  int variable_count = 0;
  check(nc_inq(id_, &dimension_count, &variable_count, nullptr, nullptr), "");
  int unlimited_count = 0;
  check(nc_inq_unlimdims(id_, &unlimited_count, nullptr), "");
  std::vector<int> unlimited(static_cast<std::size_t>(unlimited_count));
  check(nc_inq_unlimdims(id_, &unlimited_count, unlimited.data()), "");

  std::array<char, NC_MAX_NAME + 1> name{};
  std::vector<int> ids(static_cast<std::size_t>(dimension_count));
  check(nc_inq_dimids(id_, &dimension_count, ids.data(), 0), "");
  std::map<int, int> place_of;
  for (const int id : ids) {
    std::size_t length = 0;
    check(nc_inq_dim(id_, id, name.data(), &length), "");
    place_of.emplace(id, static_cast<int>(dimensions_.size()));
    dimensions_.push_back(
        {name.data(), length, std::find(unlimited.begin(), unlimited.end(), id) != unlimited.end()});
  }
  for (int id = 0; id < variable_count; ++id) {
    Variable variable{.id = id, .name = {}, .type = 0, .dimensions = {}};
    int rank = 0;
    check(nc_inq_var(id_, id, name.data(), &variable.type, &rank, nullptr, nullptr), "");
    variable.dimensions.resize(static_cast<std::size_t>(rank));
    check(nc_inq_vardimid(id_, id, variable.dimensions.data()), "");
    variable.name = name.data();
    for (int& dimension : variable.dimensions) dimension = place_of.at(dimension);
    check_chunks(variable);
    by_name_.emplace(variable.name, variables_.size());
    variables_.push_back(std::move(variable));
  }
}

void NcInput::check_chunks(const Variable& variable) const {
  int storage = NC_CONTIGUOUS;
  std::vector<std::size_t> lengths(variable.dimensions.size());
  if (nc_inq_var_chunking(id_, variable.id, &storage, lengths.data()) != NC_NOERR || storage != NC_CHUNKED)
    return;
  // memory for two copies: the stored bytes and the values read
  std::uint64_t size = 2 * std::max<std::size_t>(1, size_of(variable.type));
  for (const std::size_t length : lengths) size = bytes_for(size, length);
  const std::string fault = refused_for_a_while(size, "a chunk of " + variable.name);
  if (!fault.empty()) fail(fault, kClaimRemedy);
}

const Variable* NcInput::find(const std::string& name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : &variables_[found->second];
}

std::size_t NcInput::length(const std::string& name) const {
  const auto found = std::find_if(dimensions_.begin(), dimensions_.end(),
                                  [&](const Dimension& dimension) { return dimension.name == name; });
  return found == dimensions_.end() ? 0 : found->length;
}

std::size_t NcInput::count(const std::string& dimension) const {
  const std::size_t found = length(dimension);
  if (found > size_) fail(fmt::format("{} is {}, but the file has {} bytes", dimension, found, size_));
  return found;
}

std::vector<std::size_t> NcInput::shape(const Variable& variable) const {
  std::vector<std::size_t> result;
  result.reserve(variable.dimensions.size());
  for (const int place : variable.dimensions)
    result.push_back(dimensions_[static_cast<std::size_t>(place)].length);
  return result;
}

std::size_t NcInput::size(const Variable& variable) const {
  std::uint64_t bytes = std::max<std::size_t>(1, size_of(variable.type));
  const std::vector<std::size_t> lengths = shape(variable);
  if (std::find(lengths.begin(), lengths.end(), std::size_t{0}) != lengths.end()) return 0;
  const std::uint64_t most = size_ > std::numeric_limits<std::uint64_t>::max() / kMostExpansion
                                 ? std::numeric_limits<std::uint64_t>::max()
                                 : size_ * kMostExpansion;
  for (const std::size_t length : lengths) {
    if (length > most / bytes)
      fail(fmt::format("{} claims more values than a file of {} bytes can hold", variable.name, size_));
    bytes *= length;
  }
  return product(lengths);
}

std::size_t NcInput::claimed(std::string_view what, std::size_t count, std::size_t bytes_each) const {
  const std::string fault = refused_claim(bytes_for(count, bytes_each), what);
  if (!fault.empty()) fail(fault, kClaimRemedy);
  return count;
}

std::vector<Attribute> NcInput::attributes(const Variable* variable, std::vector<std::string>& lost) const {
  const int of = variable == nullptr ? NC_GLOBAL : variable->id;
  int count = 0;
  check(nc_inq_varnatts(id_, of, &count), "");
  std::vector<Attribute> result;
  std::array<char, NC_MAX_NAME + 1> name{};
  for (int i = 0; i < count; ++i) {
    check(nc_inq_attname(id_, of, i, name.data()), "an attribute");
    Attribute attribute{name.data(), 0, 0, {}};
    check(nc_inq_att(id_, of, name.data(), &attribute.type, &attribute.count), attribute.name);
    if (attribute.type == NC_STRING && attribute.count == 1) {
      char* text = nullptr;
      check(nc_get_att_string(id_, of, name.data(), &text), attribute.name);
      result.push_back(text_attribute(attribute.name, text == nullptr ? "" : text));
      nc_free_string(1, &text);
      continue;
    }
    const std::size_t width = size_of(attribute.type);
    if (width == 0) {
      lost.push_back((variable == nullptr ? "" : variable->name + ":") + attribute.name);
      continue;
    }
    if (attribute.count > size_ / width) fail("the attribute " + attribute.name + " is larger than the file");
    attribute.bytes.resize(attribute.count * width);
    check(nc_get_att(id_, of, name.data(), attribute.bytes.data()), attribute.name);
    result.push_back(std::move(attribute));
  }
  return result;
}

std::string NcInput::text(const Variable& variable, const std::string& attribute) const {
  std::vector<std::string> ignored;
  for (const Attribute& candidate : attributes(&variable, ignored)) {
    if (candidate.name == attribute && candidate.type == kChar)
      return candidate.bytes.substr(0, candidate.bytes.find('\0'));
  }
  return {};
}

void NcInput::read(const Variable& variable, const std::vector<std::size_t>& starts,
                   const std::vector<std::size_t>& counts, std::int32_t* values) const {
  if (!is_whole(variable.type))
    fail(variable.name + " does not hold whole numbers", "numbers of nodes are whole");
  if (product(counts) == 0) return;
  const int status = nc_get_vara_int(id_, variable.id, starts.data(), counts.data(), values);
  if (status == NC_ERANGE)
    fail(variable.name + " has a number beyond 32 bits", "2,147,483,647 is the largest");
  check(status, variable.name);
}

std::vector<std::int64_t> NcInput::integers(const Variable& variable) const {
  const std::vector<std::size_t> lengths = shape(variable);
  return integers(variable, std::vector<std::size_t>(lengths.size(), 0), lengths);
}

std::vector<std::int64_t> NcInput::integers(const Variable& variable, const std::vector<std::size_t>& starts,
                                            const std::vector<std::size_t>& counts) const {
  if (!is_whole(variable.type)) fail(variable.name + " does not hold whole numbers");
  static_assert(sizeof(long long) == sizeof(std::int64_t));
  (void)size(variable);  // throws if the file is too small for its values
  std::vector<long long> values(claimed(variable.name, product(counts), 2 * sizeof(long long)));
  if (values.empty()) return {};
  check(nc_get_vara_longlong(id_, variable.id, starts.data(), counts.data(), values.data()), variable.name);
  return {values.begin(), values.end()};
}

std::vector<double> NcInput::reals(const Variable& variable, const std::vector<std::size_t>& starts,
                                   const std::vector<std::size_t>& counts) const {
  if (size_of(variable.type) == 0 || variable.type == kChar) fail(variable.name + " does not hold numbers");
  (void)size(variable);  // throws if the file is too small for its values
  std::vector<double> values(claimed(variable.name, product(counts), sizeof(double)));
  if (values.empty()) return values;
  check(nc_get_vara_double(id_, variable.id, starts.data(), counts.data(), values.data()), variable.name);
  return values;
}

std::string NcInput::bytes(const Variable& variable) const {
  std::string result(claimed(variable.name, size(variable), size_of(variable.type)) * size_of(variable.type),
                     '\0');
  if (!result.empty()) check(nc_get_var(id_, variable.id, result.data()), variable.name);
  return result;
}

std::vector<std::string> NcInput::texts(const Variable& variable) const {
  const std::vector<std::size_t> lengths = shape(variable);
  if (variable.type != kChar || lengths.size() != 2) fail(variable.name + " is not a table of characters");
  const std::string all = bytes(variable);
  (void)claimed(variable.name, lengths[0], sizeof(std::string));
  std::vector<std::string> result;
  for (std::size_t row = 0; row < lengths[0] && !all.empty(); ++row) {
    std::string text = all.substr(row * lengths[1], lengths[1]);
    text.resize(std::min(text.find('\0'), text.size()));
    text.erase(text.find_last_not_of(' ') + 1);
    result.push_back(std::move(text));
  }
  result.resize(lengths[0]);
  return result;
}

Values NcInput::values(const Variable& variable, const std::vector<std::size_t>& starts,
                       const std::vector<std::size_t>& counts) const {
  (void)size(variable);  // throws if the file is too small for its values
  Values result = values_of_type(alternative_of(variable.type));
  if (are_texts(result)) fail(variable.name + " does not hold numbers");
  with_numbers(result, [&]<class Number>(std::vector<Number>& numbers) {
    numbers.resize(claimed(variable.name, product(counts), sizeof(Number)));
    if (numbers.empty()) return;
    check(nc_get_vara(id_, variable.id, starts.data(), counts.data(), numbers.data()), variable.name);
  });
  return result;
}

Storage NcInput::storage() const {
  Storage result{0};
  check(nc_inq_format(id_, &result.kind), "");
  if (result.kind != NC_FORMAT_NETCDF4 && result.kind != NC_FORMAT_NETCDF4_CLASSIC) return result;
  for (const Variable& variable : variables_) {
    int shuffle = 0;
    int deflate = 0;
    int level = 0;
    if (variable.dimensions.empty()) continue;
    if (nc_inq_var_deflate(id_, variable.id, &shuffle, &deflate, &level) != NC_NOERR || deflate == 0)
      continue;
    result.deflate = std::max(result.deflate, level);
    result.shuffle = result.shuffle || shuffle != 0;
  }
  return result;
}

// ---- writing

namespace {

int creation_mode(int kind) {
  switch (kind) {
    case NC_FORMAT_64BIT_OFFSET:
      return NC_64BIT_OFFSET;
    case NC_FORMAT_CDF5:
      return NC_64BIT_DATA;
    case NC_FORMAT_NETCDF4:
      return NC_NETCDF4;
    case NC_FORMAT_NETCDF4_CLASSIC:
      return NC_NETCDF4 | NC_CLASSIC_MODEL;
    default:
      return 0;
  }
}

}  // namespace

NcOutput::NcOutput(const FilePath& path, const Storage& storage)
    : name_(path.string()), out_(path), is_in_memory_(path.store() != nullptr), storage_(storage) {
  if (is_in_memory_) {
    // initial size 0: a file never becomes smaller than its initial size
    check(nc_create_mem(kNameInMemory, NC_CLOBBER | creation_mode(storage.kind), 0, &id_), "");
    // fill mode stays on: otherwise the bytes between variables, which the library skips, would be arbitrary
  } else {
    out_->close();
    create(out_->temporary());
  }
}

NcOutput::NcOutput(const UnfinishedFile& file, const Storage& storage)
    : name_(file.name), is_in_memory_(false), storage_(storage) {
  create(file.path);
}

/// Makes the file on disk.
void NcOutput::create(const std::filesystem::path& path) {
  std::size_t buffer = kBuffer;
  check(nc__create(path.c_str(), NC_CLOBBER | creation_mode(storage_.kind), 0, &buffer, &id_), "");
  int old = 0;
  nc_set_fill(id_, NC_NOFILL, &old);
}

NcOutput::~NcOutput() {
  if (id_ >= 0) nc_abort(id_);
}

void NcOutput::check(int status, const std::string& what) const {
  if (status == NC_NOERR) return;
  const std::string of = what.empty() ? "" : what + " ";
  if (status > 0) throw_system_fault(name_, of + "cannot be written", status);
  throw InputError(
      name_, fmt::format("{}cannot be written: {}", of, nc_strerror(status)),
      status == NC_EHDFERR ? "is the disk full?" : "another format, such as .vtu, may hold the mesh");
}

void NcOutput::put_attribute(int variable, const Attribute& attribute, const std::string& of) const {
  if (attribute.name == "_NCProperties") return;  // netCDF writes this attribute itself
  if (attribute.type == kChar) {
    check(nc_put_att_text(id_, variable, attribute.name.c_str(), attribute.count, attribute.bytes.data()),
          of);
  } else {
    check(nc_put_att(id_, variable, attribute.name.c_str(), attribute.type, attribute.count,
                     attribute.bytes.data()),
          of);
  }
}

void NcOutput::attribute(const Attribute& attribute) { put_attribute(NC_GLOBAL, attribute, attribute.name); }

bool NcOutput::dimension(const Dimension& dimension) {
  const auto known = dimensions_.find(dimension.name);
  if (known != dimensions_.end()) return known->second.second == (dimension.unlimited ? 0 : dimension.length);
  int id = 0;
  const std::size_t length = dimension.unlimited ? NC_UNLIMITED : dimension.length;
  check(nc_def_dim(id_, dimension.name.c_str(), length, &id), dimension.name);
  dimensions_.emplace(dimension.name, std::pair{id, dimension.unlimited ? 0 : dimension.length});
  return true;
}

NcSink NcOutput::variable(const std::string& name, NcType type, const std::vector<std::string>& dimensions,
                          const std::vector<Attribute>& attributes) {
  std::vector<int> ids;
  ids.reserve(dimensions.size());
  for (const std::string& dimension : dimensions) ids.push_back(dimensions_.at(dimension).first);
  int id = 0;
  check(nc_def_var(id_, name.c_str(), type, static_cast<int>(ids.size()), ids.data(), &id), name);
  if (storage_.deflate > 0 && !ids.empty() && type != kChar)
    check(nc_def_var_deflate(id_, id, storage_.shuffle ? 1 : 0, 1, storage_.deflate), name);
  for (const Attribute& attribute : attributes) put_attribute(id, attribute, name);
  declared_.insert(name);
  return {*this, name, id};
}

void NcOutput::finish() {
  check(nc_enddef(id_), "");
  for (const auto& put : puts_) put();
  if (!is_in_memory_) {
    const int status = nc_close(std::exchange(id_, -1));
    check(status, "");
  } else {
    NC_memio bytes{};
    const int status = nc_close_memio(std::exchange(id_, -1), &bytes);
    const std::unique_ptr<void, decltype(&std::free)> memory(bytes.memory, &std::free);
    check(status, "");
    out_->write({static_cast<const char*>(bytes.memory), bytes.size});
  }
  if (out_) out_->commit();
}

template <class Number>
void NcSink::part(const std::vector<std::size_t>& starts, const std::vector<std::size_t>& counts,
                  const std::vector<Number>& values) const {
  if (values.empty()) return;
  const auto put = [&](const auto& function, const auto& numbers) {
    file_->check(function(file_->id_, variable_, starts.data(), counts.data(), numbers.data()), name_);
  };
  if constexpr (std::is_same_v<Number, double>) {
    put(nc_put_vara_double, values);
  } else if constexpr (std::is_same_v<Number, float>) {
    put(nc_put_vara_float, values);
  } else if constexpr (std::is_same_v<Number, std::int32_t>) {
    put(nc_put_vara_int, values);
  } else if constexpr (std::is_signed_v<Number>) {
    put(nc_put_vara_longlong, std::vector<long long>(values.begin(), values.end()));
  } else {
    put(nc_put_vara_ulonglong, std::vector<unsigned long long>(values.begin(), values.end()));
  }
}

using Places = const std::vector<std::size_t>&;
template void NcSink::part(Places, Places, const std::vector<double>&) const;
template void NcSink::part(Places, Places, const std::vector<float>&) const;
template void NcSink::part(Places, Places, const std::vector<std::int32_t>&) const;
template void NcSink::part(Places, Places, const std::vector<std::int64_t>&) const;
template void NcSink::part(Places, Places, const std::vector<std::uint64_t>&) const;

void NcSink::bytes(const std::vector<std::size_t>& counts, const std::string& values) const {
  if (values.empty()) return;
  const std::vector<std::size_t> starts(counts.size(), 0);
  file_->check(nc_put_vara(file_->id_, variable_, starts.data(), counts.data(), values.data()), name_);
}

}  // namespace meshorder::exodus
