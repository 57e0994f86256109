// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/host.hpp"

#include "base/text.hpp"

#include <sys/utsname.h>

#include <charconv>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string_view>

namespace meshorder {
namespace fs = std::filesystem;

namespace {

/// Returns the keys and values of the first processor in the text of Linux's /proc/cpuinfo.
std::map<std::string, std::string> facts_of_first_processor(std::istream& cpuinfo) {
  std::map<std::string, std::string> facts;
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.empty() && !facts.empty()) break;  // the next processor
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos)
      facts.emplace(trimmed(std::string_view(line).substr(0, colon)),
                    trimmed(std::string_view(line).substr(colon + 1)));
  }
  return facts;
}

/// Returns the folder in an environment variable; empty if the variable is unset or relative (the XDG
/// standard calls relative paths invalid).
fs::path folder_in(const char* variable) {
  const char* const value = std::getenv(variable);
  fs::path folder = value != nullptr ? value : "";
  return folder.is_absolute() ? folder : fs::path();
}

}  // namespace

std::string processor_name(std::istream& cpuinfo, const std::string& architecture) {
  std::map<std::string, std::string> first_values = facts_of_first_processor(cpuinfo);
  if (!first_values["model name"].empty()) return first_values["model name"];
  std::string result = architecture + " processor";
  const std::string maker = first_values["CPU implementer"];
  const std::string part = first_values["CPU part"];
  if (!maker.empty() && !part.empty()) result += ", implementer " + maker + ", part " + part;
  return result;
}

std::string processor_of_this_machine() {
  utsname system{};
  uname(&system);
  std::ifstream cpuinfo("/proc/cpuinfo");
  return processor_name(cpuinfo, system.machine);
}

ProcessorFamily processor_family(std::istream& cpuinfo) {
  std::map<std::string, std::string> facts = facts_of_first_processor(cpuinfo);
  const auto number = [&](const char* name) {
    int value = -1;
    const std::string& text = facts[name];
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
  };
  return {facts["vendor_id"], number("cpu family"), number("model")};
}

ProcessorFamily family_of_this_machine() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  return processor_family(cpuinfo);
}

bool is_zen4(const ProcessorFamily& family) {
  return family.maker == "AuthenticAMD" && family.family == 0x19 &&
         ((family.model >= 0x10 && family.model <= 0x1f) || (family.model >= 0x60 && family.model <= 0xaf));
}

fs::path user_cache_folder() {
  const char* const own = std::getenv("MESHORDER_CACHE");
  if (own != nullptr && *own != '\0') return fs::absolute(own);
  if (const fs::path folder = folder_in("XDG_CACHE_HOME"); !folder.empty()) return folder / "meshorder";
  if (const fs::path home = folder_in("HOME"); !home.empty()) return home / ".cache/meshorder";
  return {};
}

}  // namespace meshorder
