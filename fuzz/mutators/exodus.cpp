// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Exodus II files: names, values and attributes are changed by libnetcdf, so that the file stays a valid
// netCDF file.
#include "fuzz/families/families.hpp"
#include "fuzz/families/scratch.hpp"
#include "fuzz/mutators/choice.hpp"
#include "io/exodus/netcdf.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <netcdf.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace meshorder::fuzz {
namespace {

constexpr std::size_t kMostValues = 1U << 16U;  // of a variable that is changed
constexpr std::array kNumbers{0.0,
                              -1.0,
                              std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN(),
                              2147483647.0,
                              2147483648.0};

struct Variable {
  int id = 0;
  std::string name;
  nc_type type = NC_NAT;
  std::vector<int> dimensions;
  std::size_t values = 0;
};

Variable variable_of(int file, int id) {
  std::array<char, NC_MAX_NAME + 1> name{};
  Variable variable;
  variable.id = id;
  int rank = 0;
  if (nc_inq_varndims(file, id, &rank) != NC_NOERR) return variable;  // the variable has no values to read
  variable.dimensions.resize(static_cast<std::size_t>(rank));
  (void)nc_inq_var(file, id, name.data(), &variable.type, nullptr, variable.dimensions.data(), nullptr);
  variable.name = name.data();
  variable.values = 1;
  for (const int dimension : variable.dimensions) {
    std::size_t length = 0;
    (void)nc_inq_dimlen(file, dimension, &length);
    variable.values = length > kMostValues ? kMostValues + 1 : variable.values * length;
    variable.values = std::min(variable.values, kMostValues + 1);
  }
  return variable;
}

/// Returns all values of a numeric variable; empty if the variable is not numeric.
std::vector<double> numbers_of(int file, const Variable& variable) {
  std::vector<double> values(variable.values);
  const bool is_read = !values.empty() && nc_get_var_double(file, variable.id, values.data()) == NC_NOERR;
  return is_read ? values : std::vector<double>();
}

void change_values(int file, const Variable& variable, Choice& choice) {
  if (variable.values == 0 || variable.values > kMostValues) return;
  if (variable.type == NC_CHAR) {
    std::string text(variable.values, '\0');
    if (nc_get_var_text(file, variable.id, text.data()) != NC_NOERR) return;
    text = mutated_bytes(std::move(text), variable.values);
    text.resize(variable.values);
    (void)nc_put_var_text(file, variable.id, text.data());
    return;
  }
  std::vector<double> values = numbers_of(file, variable);
  if (values.empty()) return;
  double& value = values[choice.below(values.size())];
  const double other = values[choice.below(values.size())];
  const std::array<double, 4> choices{value + 1, value - 1, other, kNumbers[choice.below(kNumbers.size())]};
  value = choices[choice.below(choices.size())];
  (void)nc_put_var_double(file, variable.id, values.data());
}

/// Gives `variable` the values of `other`, repeated from the first value on if they are too few.
void copy_values(int file, const Variable& variable, const Variable& other) {
  if (std::max(variable.values, other.values) > kMostValues) return;
  const std::vector<double> source = numbers_of(file, other);
  if (source.empty() || variable.values == 0) return;
  std::vector<double> values(variable.values);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = source[i % source.size()];
  (void)nc_put_var_double(file, variable.id, values.data());
}

/// Adds a copy of a variable under another name, with the dimensions of `shape`.
void add_copy(int file, const Variable& variable, const std::string& name, const Variable& shape) {
  int id = 0;
  (void)nc_redef(file);
  const int status = nc_def_var(file, name.c_str(), variable.type, static_cast<int>(shape.dimensions.size()),
                                shape.dimensions.data(), &id);
  (void)nc_enddef(file);
  if (status == NC_NOERR) copy_values(file, variable_of(file, id), variable);
}

/// Exchanges the names of two objects of one kind.
template <class Rename>
void exchange_names(int file, int one, const std::string& name, int other, const std::string& other_name,
                    Rename rename) {
  (void)nc_redef(file);
  (void)rename(file, one, "exchanged");
  (void)rename(file, other, name.c_str());
  (void)rename(file, one, other_name.c_str());
  (void)nc_enddef(file);
}

void exchange_dimensions(int file, Choice& choice) {
  int count = 0;
  (void)nc_inq_ndims(file, &count);
  const auto any = [&] { return static_cast<int>(choice.below(static_cast<std::size_t>(count))); };
  const auto name_of = [&](int id) {
    std::array<char, NC_MAX_NAME + 1> name{};
    (void)nc_inq_dimname(file, id, name.data());
    return std::string(name.data());
  };
  const int one = any();
  const int other = any();
  if (one != other) exchange_names(file, one, name_of(one), other, name_of(other), nc_rename_dim);
}

/// Removes an attribute of a variable or of the file, or changes the attribute's text.
void change_attribute(int file, int variable, Choice& choice) {
  int count = 0;
  (void)nc_inq_varnatts(file, variable, &count);
  if (count == 0) return;
  std::array<char, NC_MAX_NAME + 1> name{};
  const auto which = static_cast<int>(choice.below(static_cast<std::size_t>(count)));
  if (nc_inq_attname(file, variable, which, name.data()) != NC_NOERR) return;
  nc_type type = NC_NAT;
  std::size_t length = 0;
  (void)nc_inq_att(file, variable, name.data(), &type, &length);
  (void)nc_redef(file);
  if (type != NC_CHAR || choice.below(4) == 0) {
    (void)nc_del_att(file, variable, name.data());
  } else {
    std::string text(length, '\0');
    (void)nc_get_att_text(file, variable, name.data(), text.data());
    text = mutated_bytes(std::move(text), length + kTextRoom);
    (void)nc_put_att_text(file, variable, name.data(), text.size(), text.data());
  }
  (void)nc_enddef(file);
}

/// Changes an open file. A call of libnetcdf that fails changes nothing, which is a mutation, too.
void change(int file, Choice& choice) {
  int count = 0;
  (void)nc_inq_nvars(file, &count);
  if (count == 0) return;
  const auto any = [&] {
    return variable_of(file, static_cast<int>(choice.below(static_cast<std::size_t>(count))));
  };
  const Variable variable = any();
  const Variable other = any();
  switch (choice.below(8)) {
    case 0:
      if (variable.id != other.id)
        exchange_names(file, variable.id, variable.name, other.id, other.name, nc_rename_var);
      break;
    case 1:
      exchange_dimensions(file, choice);
      break;
    case 2:
      copy_values(file, variable, other);
      break;
    case 3:
      add_copy(file, variable, near_name(choice.below(2) == 0 ? variable.name : other.name, choice), other);
      break;
    case 4:
      (void)nc_redef(file);
      (void)nc_rename_var(file, variable.id, near_name(variable.name, choice).c_str());
      (void)nc_enddef(file);
      break;
    case 5:
      change_attribute(file, choice.below(3) == 0 ? NC_GLOBAL : variable.id, choice);
      break;
    default:
      change_values(file, variable, choice);
  }
}

}  // namespace

std::string mutate_exodus(std::string input, std::uint32_t seed) {
  Choice choice(seed);
  try {  // libnetcdf trusts what a damaged header says
    if (input.starts_with("CDF"))
      exodus::check_classic_header(
          "input", [&](std::size_t most) { return input.substr(0, most); }, input.size());
  } catch (const InputError&) {
    return {};
  }
  // on disk: libnetcdf leaks some files that it cannot open in memory
  const std::filesystem::path path = scratch_file("mutated.nc", input);
  int file = 0;
  if (nc_open(path.c_str(), NC_WRITE, &file) != NC_NOERR) return {};
  change(file, choice);
  return nc_close(file) == NC_NOERR ? test::content_of(path) : std::string();
}

}  // namespace meshorder::fuzz
